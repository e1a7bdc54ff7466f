// The brush of the tool that paints; not there while nothing paints.
#pragma once

#include <QGroupBox>
#include <QVBoxLayout>

#include "app/gui/painting/brush_curve.h"
#include "app/gui/painting/brush_presets.h"
#include "app/gui/panels/form.h"

namespace patina {

class BrushPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit BrushPanel(QWidget* parent = nullptr);

  void show(const Brush& brush, const BrushPresets& presets); // sends no signal

 signals:
  void edited(const patina::Brush& brush);
  void pressed(double newtons); // how hard the mouse presses
  void toolAsked(patina::Tool tool);

 private:
  void rebuild(const BrushPresets& presets);
  void addValue(double extent);
  void addColor();
  void addChannels(MaterialChannel channel);
  void addErased();
  void addSize(const BrushPresets& presets);
  void addShape();
  void addChoices();
  void addLayers(const BrushPresets& presets);
  void change();

  Brush brush_;
  QVBoxLayout* layout_;
  Form* form_ = nullptr;
  BrushCurve* curve_ = nullptr; // of the form
};

} // namespace patina
