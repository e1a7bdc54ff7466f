// The objects of the scene, their poses, and whether distances are those of the union.
#pragma once

#include <array>
#include <vector>

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QToolButton>

#include "app/gui/toolkit/card.h"
#include "scene/scene.h"

namespace patina {

// The part of a scene that this panel edits.
struct ObjectChoice {
  std::vector<SceneObject> objects;
  bool redistance = false;
};

class ObjectList : public QGroupBox {
  Q_OBJECT
 public:
  explicit ObjectList(QWidget* parent = nullptr);

  void setValues(const Scene& scene); // Sends no signal; the selection is kept by name.
  const ObjectChoice& values() const { return choice_; }
  // Why the last edit is not applied; empty: none.
  void setProblem(const QString& line) { say(problem_, line); }

 signals:
  void edited(); // Slow to compile: runs in the background.
  void addRequested();
  void pictureRequested(std::size_t object);
  void unitRequested(std::size_t object);

 private:
  int chosen() const { return list_->currentRow(); }
  void showPose();
  void readPose(std::size_t number); // Other values keep digits that are not shown.
  void removeChosen();
  void addPoseRows(QGridLayout* grid);

  ObjectChoice choice_;
  QListWidget* list_;
  QWidget* pose_;
  std::array<QDoubleSpinBox*, 6> numbers_{}; // x y z [mm], then angles [°].
  QToolButton* remove_;
  QCheckBox* redistance_;
  QLabel* problem_;
};

} // namespace patina
