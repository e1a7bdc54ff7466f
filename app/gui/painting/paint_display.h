// Chooses which paint is shown.
#pragma once

#include <vector>

#include <QComboBox>
#include <QWidget>

#include "app/gui/state/tool_choice.h"

namespace patina {

class PaintDisplay : public QWidget {
  Q_OBJECT
 public:
  explicit PaintDisplay(QWidget* parent = nullptr);

  void setAvailable(const std::vector<PaintQuantity>& quantities);
  // The display follows the tool unless the user has chosen.
  void setTool(const ToolChoice& choice) {
    tool_ = choice;
    decide();
  }
  void setOn(bool on) { // Off: no paint is shown, whichever is chosen.
    on_ = on;
    decide();
  }
  std::optional<PaintQuantity> shown() const { return shown_; }

 signals:
  void showRequested(std::optional<patina::PaintQuantity> quantity);

 private:
  bool has(PaintQuantity quantity) const;
  void decide();

  std::vector<PaintQuantity> available_;
  ToolChoice tool_;
  std::optional<PaintQuantity> shown_;
  bool on_ = true;
  QComboBox* combo_; // "As the tool", then the available ones.
};

} // namespace patina
