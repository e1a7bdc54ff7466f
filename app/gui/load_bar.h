// Progress of a load, with Cancel; hidden when nothing loads.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QWidget>

namespace patina {

class LoadBar : public QWidget {
  Q_OBJECT
 public:
  explicit LoadBar(QWidget* parent = nullptr);
  void begin(const QString& name);
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
};

} // namespace patina
