// Explains a tool that does not paint, with the force of the one that presses.
#pragma once

#include <QGroupBox>
#include <QLabel>

#include "app/gui/state/tool_choice.h"
#include "app/gui/toolkit/value_row.h"

namespace patina {

class ToolPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ToolPanel(QWidget* parent = nullptr);
  void setTool(const ToolChoice& choice);
  void setForce(double newtons) { // Force of the pressing tool [N]; sends no signal.
    force_->setValue(newtons);
  }

 signals:
  void forceEdited(double newtons);

 private:
  QLabel* words_;
  ValueRow* force_;
};

} // namespace patina
