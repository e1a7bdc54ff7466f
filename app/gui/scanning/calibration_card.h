// A camera from the open scan's pictures of a board, from a video or a live camera, a tip from the
// scan's poses: found, looked at, and then used.
#pragma once

#include <map>

#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "acquisition/calibration/calibrate_camera.h"
#include "app/gui/scanning/open_scan.h"

namespace patina {

class CalibrationCard : public QGroupBox {
  Q_OBJECT
 public:
  explicit CalibrationCard(OpenScan& scan, QWidget* parent = nullptr);
  bool busy() const { return job_.busy(); }
  void cancel();

 signals:
  void picturesAsked();
  void boardSeen(std::size_t frame, const patina::BoardView& view); // in a frame of the scan
  void useAsked(const QString& file, const QString& text); // of the scan that is open, if one is
  void progressed(double fraction);
  void changed();

 private:
  void findCamera();
  void findTip();
  void offer(const QString& words, const QString& file, const std::string& text);
  void bringIntoView(); // what is offered
  void refuse(const QString& problem);
  void refresh();
  QPushButton* button(const char* name, const QString& words, const QString& tip);

  OpenScan& scan_;
  Background job_;
  QLineEdit *board_, *source_;
  QPushButton *pictures_, *camera_, *tip_, *use_;
  QLabel* found_;
  QString file_, text_; // that is offered; empty: nothing is
};

} // namespace patina
