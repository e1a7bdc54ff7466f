// The path of a scan in 3D. Left drag turns, middle drag shifts, right drag or wheel zooms. A click
// on the path goes to its time, a double click fits the view.
#pragma once

#include <functional>
#include <optional>

#include <QMouseEvent>
#include <QVTKOpenGLNativeWidget.h>

#include "visualization/values/camera.h"
#include "visualization/view/scan_picture.h"

namespace patina {

class ScanView : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  explicit ScanView(QWidget* parent = nullptr);
  ~ScanView() override;

  ScanPicture& picture() { return picture_; }
  void refresh();
  // Looks at the picture like that as soon as the widget has a size.
  void look(std::function<void()> at) { look_ = std::move(at); }
  void resetCamera(const Vec3& up) {
    look([this, up] { picture_.resetCamera(up); });
  }
  Ray sightAt(const QPoint& pixel) {
    return rayThrough(camera(), inHeights(pixel).x(), inHeights(pixel).y());
  }

 signals:
  void timePicked(double t);

 protected:
  static constexpr double kPickReach = 12; // Radius of a click [px].

  bool event(QEvent* event) override;
  virtual void press(const QMouseEvent&) {}
  virtual void move(const QMouseEvent& event, double dx,
                    double dy); // Movement in heights, y upwards.
  virtual void release(const QMouseEvent& event);
  virtual void leave() {}
  virtual void fit() {
    picture_.fit();
    refresh();
  }
  bool isClick(const QMouseEvent& event) const; // The button was released where it was pressed.
  vtkCamera& camera() { return *picture_.renderer().GetActiveCamera(); }
  QPointF inHeights(const QPoint& pixel) const; // Measured from the middle, y upwards.

 private:
  std::optional<DrawnSample> sampleAt(const QPoint& pixel) const;
  void showUnderPointer(const QPoint& pixel);
  void sendTip(const QString& words);

  ScanPicture picture_;
  QPoint pressed_, last_;
  std::function<void()> look_;
};

} // namespace patina
