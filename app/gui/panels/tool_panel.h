// What the mouse does with a tool that does not paint.
#pragma once

#include <QGroupBox>
#include <QLabel>

#include "app/gui/painting/tool_choice.h"
#include "app/gui/panels/value_row.h"

namespace patina {

class ToolPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ToolPanel(QWidget* parent = nullptr);
  void setTool(const ToolChoice& choice);
  void setForce(double newtons); // of the tool that presses; sends no signal

 signals:
  void forceEdited(double newtons);

 private:
  QLabel* words_;
  ValueRow* force_;
};

} // namespace patina
