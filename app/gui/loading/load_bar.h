// Shows the progress of a running task, with Cancel; hidden without one.
#pragma once

#include <QProgressBar>
#include <QPushButton>
#include <QTimer>

#include "app/gui/state/window_state.h"
#include "app/gui/toolkit/elided_label.h"

namespace patina {

class LoadBar : public QWidget {
  Q_OBJECT
 public:
  explicit LoadBar(QWidget* parent = nullptr);
  void setWork(const std::optional<TaskProgress>& work);

 signals:
  void cancelled();

 private:
  ElidedLabel* words_;
  QProgressBar* bar_;
  QPushButton* cancel_;
  QString title_;
  QTimer delay_;
};

} // namespace patina
