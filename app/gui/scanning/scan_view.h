// The path of a scan in 3D: left drag turns, middle shifts, right or wheel zooms, a click on the
// path goes to its time, a double click fits it.
#pragma once

#include <QMouseEvent>
#include <QVTKOpenGLNativeWidget.h>

#include "visualization/view/scan_picture.h"

namespace patina {

class ScanView : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  explicit ScanView(QWidget* parent = nullptr);
  ~ScanView() override;

  ScanPicture& picture() { return picture_; }
  void refresh();                 // draws if something has changed
  void lookAtAll(const Vec3& up); // once it has its size

 signals:
  void timePicked(double t);

 protected:
  bool event(QEvent* event) override;

 private:
  void move(const QMouseEvent& event);
  void pick(const QPoint& place);

  ScanPicture picture_;
  QPoint pressed_, last_;
  std::optional<Vec3> up_; // that is asked for
};

} // namespace patina
