// The objects of the scene: which there are, where each is, and whether depth is to their union.
#pragma once

#include <array>
#include <vector>

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QListWidget>
#include <QToolButton>

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

  void setValues(const Scene& scene); // sends no signal; the chosen object stays chosen by name
  const ObjectChoice& values() const { return choice_; }
  void setProblem(const QString& line); // why the last edit does not count; empty = none

 signals:
  void edited(); // slow to compile: the window does it behind the picture
  void addAsked();

 private:
  int chosen() const;
  void showPose();
  void readPose(std::size_t number); // the others keep digits that are not shown
  void removeChosen();
  void addPoseRows(QGridLayout* grid);

  ObjectChoice choice_;
  QListWidget* list_;
  QWidget* pose_;
  std::array<QDoubleSpinBox*, 6> numbers_{}; // x y z [mm], then angles [deg]
  QToolButton* remove_;
  QCheckBox* redistance_;
  QLabel* problem_;
};

} // namespace patina
