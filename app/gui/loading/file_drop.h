// Takes files that are dropped on a widget.
#pragma once

#include <QObject>
#include <QWidget>

namespace patina {

class FileDrop : public QObject {
  Q_OBJECT
 public:
  explicit FileDrop(QWidget& on); // to which it belongs

 signals:
  void dropped(const QString& path); // later: the program that it came from has gone on

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
};

} // namespace patina
