// One of the four views of a path over a mesh: without perspective, from a side that stays. The
// handle moves the path, beside it a left drag shifts the picture, the wheel zooms.
#pragma once

#include <QMouseEvent>
#include <QVTKOpenGLNativeWidget.h>

#include "visualization/view/camera.h"
#include "visualization/view/scan_picture.h"

namespace patina {

class AlignView : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  AlignView(const char* name, ViewPreset from);

  ScanPicture& picture() { return picture_; }
  void setPicking(bool picks); // a click asks what is there; the handle rests
  void refresh();              // draws if something has changed
  void fit() { fits_ = true; }

 signals:
  void dragBegun();
  void dragged(const patina::Pose& motion); // since it began
  void dropped();
  void clicked(const patina::Ray& sight, double reach); // reach [m]

 protected:
  bool event(QEvent* event) override;

 private:
  Vec3 inPlane(const QPoint& pixel, const Vec3& through);
  std::optional<HandlePart> under(const QPoint& pixel);
  void press(const QMouseEvent& event);
  void move(const QMouseEvent& event);
  void release(const QMouseEvent& event);

  ScanPicture picture_;
  ViewPreset from_;
  bool fits_ = true, picks_ = false;
  std::optional<HandlePart> held_;
  HandleView held_in_; // as it was then
  Vec3 held_at_ = Vec3::Zero();
  QPoint pressed_, last_;
};

} // namespace patina
