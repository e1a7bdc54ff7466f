// The messages of the window, the newest last: a list, and a line with the newest one.
#pragma once

#include <functional>

#include <QListWidget>
#include <QTimer>
#include <QToolButton>

#include "app/gui/toolkit/elided_label.h"

namespace patina {

struct Message {
  QString words;
  bool warns = false; // Stays until it is dismissed.
  QString file = {};  // A click opens it; empty: none.
  // The action that the message proposes, on a button; without words: none.
  struct Action {
    QString words;
    std::function<void()> act;
  };
  Action action = {};
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
  void opened(); // Requests the list of all messages.

 protected:
  void mousePressEvent(QMouseEvent*) override { emit opened(); }

 private:
  ElidedLabel* words_;
  QToolButton* open_;
  std::function<void()> act_;
  QTimer delay_;
};

} // namespace patina
