// The brush of the current tool; hidden while the tool does not paint.
#pragma once

#include <QGroupBox>
#include <QVBoxLayout>
#include <QWidget>

#include "app/gui/painting/brush_presets.h"
#include "app/gui/toolkit/form.h"
#include "app/gui/toolkit/plot.h"
#include "scene/stroke.h"

namespace patina {

class BrushPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit BrushPanel(QWidget* parent = nullptr);

  void show(const Brush& brush, const BrushPresets& presets); // Sends no signal.

 signals:
  void edited(const patina::Brush& brush);
  void pressed(double newtons); // Force of the mouse [N].
  void toolRequested(patina::Tool tool);

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
  PlotWidget* curve_ = nullptr;
};

} // namespace patina
