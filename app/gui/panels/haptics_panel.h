// The haptic properties of the surface: a row for each value of the scene, and a menu for others.
#pragma once

#include <QGroupBox>
#include <QMenu>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/form.h"
#include "scene/haptic_properties.h"
#include "scene/scene.h"

namespace patina {

// Chooses the contact surface: the surface, its offset, or a magnetic surface. They exclude each
// other, because offset and magnet act in the same band (K12, K13).
enum class TouchMode { contact, offset, magnetic };

class HapticsPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit HapticsPanel(QWidget* parent = nullptr);

  void setValues(const HapticProperties& haptics) { // Sends no signal.
    haptics_ = haptics;
    rebuild();
  }
  const HapticProperties& values() const { return haptics_; }
  // Largest distance from the surface that the field covers [m].
  void setReach(double reach);
  // Why the last edit is not applied; empty: none.
  void setProblem(const QString& line) { say(problem_, line); }

 signals:
  void edited(const patina::HapticProperties& haptics);

 private:
  void rebuild();
  void addModeRows();
  void addFrictionRows();
  void addDampingRows();
  void addMenu();
  void setMode(TouchMode mode);
  void makeRemovable(ValueRow* row, const QString& tip, std::function<void()> remove);
  void change(const std::function<void()>& rows); // Changes which rows exist.
  double maxMillimetres() const;

  HapticProperties haptics_;
  // Last values of a mode, restored when it is chosen again.
  std::optional<double> last_offset_;
  std::optional<Magnet> last_magnet_;
  double reach_ = 5e-3;
  QVBoxLayout* layout_;
  Form* form_ = nullptr;
  QLabel* problem_;
};

} // namespace patina
