// The steps from a scan to a feel: what each does, what it found, and a button for the next.
#pragma once

#include <vector>

#include <QGroupBox>
#include <QLabel>
#include <QPushButton>

#include "demo/demo_report.h"

namespace patina {

class StepList : public QGroupBox {
  Q_OBJECT
 public:
  explicit StepList(QWidget* parent = nullptr);

  // demo: nullptr before it begins. running: a step is under way, and the demo is not read.
  void show(const Demo* demo, bool running);

 signals:
  void nextAsked();
  void allAsked(); // steps to the end
  void feelAsked();
  void lookAsked(const QString& scan); // at its frames

 private:
  void offerScans(const Demo* demo);

  struct Row {
    QLabel *mark, *words, *found;
  };
  std::vector<Row> rows_;
  std::size_t done_ = 0;
  QPushButton *next_, *all_, *feel_, *look_;
};

} // namespace patina
