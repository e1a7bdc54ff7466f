// The brush of the tool that paints; not there while nothing paints.
#pragma once

#include <QComboBox>
#include <QGroupBox>
#include <QVBoxLayout>

#include "app/gui/painting/brush_presets.h"
#include "app/gui/panels/value_row.h"

namespace patina {

class BrushPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit BrushPanel(QWidget* parent = nullptr);

  void show(const Brush& brush, const BrushPresets& presets); // sends no signal
  const Brush& brush() const { return brush_; }

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
  ValueRow* addRow(const char* name, const QString& caption, const QString& unit,
                   const RowRange& range, double value, const QString& tip = {});
  QComboBox* addCombo(const char* name, const QString& caption, const QStringList& words, int now);

  Brush brush_;
  QVBoxLayout* layout_;
  QWidget* rows_ = nullptr;
  QWidget* curve_ = nullptr;
};

} // namespace patina
