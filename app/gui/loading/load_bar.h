// Progress of a load, with Cancel; hidden when nothing loads.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

namespace patina {

class LoadBar : public QWidget {
  Q_OBJECT
 public:
  explicit LoadBar(QWidget* parent = nullptr);
  // later = seen only if it is still on after half a second.
  void begin(const QString& words, const QString& name, bool later = false);
  bool showing(const QString& words) const { return on_ && name_ == words; }
  void report(double fraction, const QString& what);
  void showClosing();
  void end();

 signals:
  void cancelled();

 private:
  QLabel* words_;
  QProgressBar* bar_;
  QPushButton* cancel_;
  QString name_;
  bool on_ = false; // or waiting to be
  QTimer patience_;
};

} // namespace patina
