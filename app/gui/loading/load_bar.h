// Progress of what takes its time, with Cancel; hidden when nothing does.
#pragma once

#include <optional>

#include <QProgressBar>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

#include "app/gui/widgets/elided_label.h"
#include "app/gui/window/window_state.h"

namespace patina {

class LoadBar : public QWidget {
  Q_OBJECT
 public:
  explicit LoadBar(QWidget* parent = nullptr);
  void setWork(const std::optional<Work>& work);

 signals:
  void cancelled();

 private:
  ElidedLabel* words_;
  QProgressBar* bar_;
  QPushButton* cancel_;
  QString title_; // of the work that is seen, or will be
  QTimer patience_;
};

} // namespace patina
