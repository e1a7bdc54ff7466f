// What the surface feels like. A value that the scene does not have has no row; the menu adds it.
#pragma once

#include <QGroupBox>
#include <QLabel>
#include <QMenu>
#include <QVBoxLayout>

#include "app/gui/panels/value_row.h"
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
  ValueRow* addRow(const char* name, const QString& caption, const QString& unit,
                   const RowRange& range, double value, const QString& tip = {});
  void addModeRows();
  void addFrictionRows();
  void addDampingRows();
  void addTipRow();
  void addContactRow();
  void addMenu();
  void setMode(TouchMode mode);
  template <typename Remove> void makeRemovable(ValueRow* row, const QString& tip, Remove remove);
  double mostMillimetres() const;
  void change();

  HapticProperties haptics_;
  // What a mode had when it was left, for when it is chosen again.
  std::optional<double> last_offset_;
  std::optional<Magnet> last_magnet_;
  double reach_ = 5e-3;
  QVBoxLayout* layout_;
  QWidget* rows_ = nullptr;
  QLabel* problem_;
};

} // namespace patina
