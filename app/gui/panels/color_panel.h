// Range, colour map, opacity and numbers of a drawn thing.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QSpinBox>

#include "app/gui/toolkit/value_row.h"
#include "scene/color_scale.h"

namespace patina {

class ColorPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ColorPanel(QWidget* parent = nullptr);

  // Name of a drawn thing; one without colours counts as none.
  void setThing(const std::string& thing);
  void setScales(const ColorScales& scales);             // Sends no signal.
  const std::string& thing() const { return thing_; }    // Empty: none.
  void setRange(const std::optional<ValueRange>& range); // Range in the picture, not while typed.

 signals:
  void edited(const std::string& thing, const patina::ColorScale& scale);

 private:
  void showScale();
  void change(const std::function<void(ColorScale&)>& set);
  void setNumbers(const ValueRange& range, int decimals);

  std::string thing_;
  ColorScales scales_;
  double per_si_ = 1;
  int decimals_ = 3;
  QComboBox *map_, *range_;
  QCheckBox *reversed_, *log_, *symmetric_;
  QSpinBox *bands_, *digits_;
  QDoubleSpinBox *low_, *high_, *percentile_;
  ValueRow* opacity_;
  QWidget *map_card_, *numbers_;
};

} // namespace patina
