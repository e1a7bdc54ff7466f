// What the surface feels like. A value that the scene does not have has no row; the menu adds it.
#pragma once

#include <QGroupBox>
#include <QLabel>
#include <QMenu>
#include <QVBoxLayout>

#include "app/gui/panels/form.h"
#include "app/gui/window/mode_switch.h"
#include "scene/scene.h"

namespace patina {

class HapticsPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit HapticsPanel(QWidget* parent = nullptr);

  void setValues(const HapticProperties& haptics); // sends no signal
  const HapticProperties& values() const { return haptics_; }
  // How far from the surface the open field can be felt [m].
  void setReach(double reach);
  void setProblem(const QString& line); // why the last edit does not count; empty = none

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
  void change(const std::function<void()>& rows); // which there are
  double mostMillimetres() const;

  HapticProperties haptics_;
  // What a mode had when it was left, for when it is chosen again.
  std::optional<double> last_offset_;
  std::optional<Magnet> last_magnet_;
  double reach_ = 5e-3;
  QVBoxLayout* layout_;
  Form* form_ = nullptr;
  QLabel* problem_;
};

} // namespace patina
