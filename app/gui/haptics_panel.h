// What the surface feels like. A value that the scene does not have has no row; the menu adds it.
#pragma once

#include <QGroupBox>
#include <QLabel>
#include <QMenu>
#include <QVBoxLayout>

#include "scene/scene.h"

namespace patina {

class HapticsPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit HapticsPanel(QWidget* parent = nullptr);

  void setValues(const HapticProperties& haptics); // sends no signal
  const HapticProperties& values() const { return haptics_; }
  void setProblem(const QString& line); // why the last edit does not count; empty = none

 signals:
  void edited(const patina::HapticProperties& haptics);

 private:
  void rebuild();
  void addRows();
  void addFrictionRows();
  void addMenu();
  void change();

  HapticProperties haptics_;
  QVBoxLayout* layout_;
  QWidget* rows_ = nullptr;
  QLabel* problem_;
};

} // namespace patina
