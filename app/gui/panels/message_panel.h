// What the window has said, the newest last: a list, and one line of it that can be put away.
#pragma once

#include <QListWidget>
#include <QTimer>
#include <QToolButton>

#include "app/gui/widgets/elided_label.h"

namespace patina {

struct Message {
  QString words;
  bool warns = false; // stays until it is put away
};

class MessagePanel : public QListWidget {
  Q_OBJECT
 public:
  explicit MessagePanel(QWidget* parent = nullptr);
  void add(const Message& message);

 protected:
  void changeEvent(QEvent* event) override;
};

class NoticeLine : public QWidget {
  Q_OBJECT
 public:
  explicit NoticeLine(QWidget* parent = nullptr);
  void show(const Message& message);

 signals:
  void opened(); // the person wants to read on

 protected:
  void mousePressEvent(QMouseEvent* event) override;

 private:
  ElidedLabel* words_;
  QTimer patience_;
};

} // namespace patina
