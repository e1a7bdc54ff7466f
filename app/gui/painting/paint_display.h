// Which of the paint is shown, and over which range. Not there while nothing is painted.
#pragma once

#include <vector>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QWidget>

#include "app/gui/painting/tool_choice.h"

namespace patina {

class PaintDisplay : public QWidget {
  Q_OBJECT
 public:
  explicit PaintDisplay(QWidget* parent = nullptr);

  void setAvailable(const std::vector<PaintQuantity>& quantities);
  // What it follows unless a person has chosen.
  void setTool(const ToolChoice& choice);
  std::optional<PaintQuantity> shown() const { return shown_; }
  void setRange(const ValueRange& range); // as the picture has it; sends no signal

 signals:
  void showAsked(std::optional<patina::PaintQuantity> quantity);
  void lockAsked(patina::PaintQuantity quantity, std::optional<patina::ValueRange> range);

 private:
  bool has(PaintQuantity quantity) const;
  void decide();
  void sendLock();

  std::vector<PaintQuantity> available_;
  ToolChoice tool_;
  std::optional<PaintQuantity> shown_;
  bool locked_[kPaintQuantities] = {};
  double per_si_ = 1;
  QComboBox* combo_; // as the tool, nothing, then what is available
  QWidget* range_row_;
  QCheckBox* lock_;
  QDoubleSpinBox* low_;
  QDoubleSpinBox* high_;
};

} // namespace patina
