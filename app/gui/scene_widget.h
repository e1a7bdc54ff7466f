// The 3D view: draws a SceneView, and turns the mouse into tip targets or camera moves.
#pragma once

#include <chrono>

#include <QPoint>
#include <QVTKOpenGLNativeWidget.h>

#include "core/types.h"
#include "visualization/scene_view.h"

namespace patina {

// In feel mode the left button moves the tip in the plane that faces the viewer, the wheel moves it
// in depth and a double click sets it onto the surface; Shift + left, middle, right and Ctrl +
// wheel move the camera. In navigate mode the left button and the wheel move the camera too.
class SceneWidget : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  enum class Mode { feel, navigate };

  explicit SceneWidget(QWidget* parent = nullptr);
  ~SceneWidget() override;

  SceneView& view() { return view_; }
  void setMode(Mode mode);
  Mode mode() const { return mode_; }
  // What a double click looks for the surface in; nullptr = no contact yet, the mouse navigates.
  void setField(std::shared_ptr<const SurfaceField> field);
  void setTarget(const Vec3& target) { target_ = target; }
  const Vec3& target() const { return target_; }

  // Renders if anything changed since the last call; false if nothing did.
  bool refresh();
  // What is shown is up to date and smoothed.
  bool settled();
  // Seconds that the last frame took in which something had changed.
  double frameSeconds() const { return frame_seconds_; }

  // A resting place for the tip: over the surface in the middle of the picture, towards the viewer.
  Vec3 restingPlace();

 signals:
  void tipMoved(const patina::Vec3& target);
  void modeChanged();

 protected:
  bool event(QEvent* event) override;

 private:
  bool feels() const { return mode_ == Mode::feel && field_ != nullptr; }
  Vec2 fraction(const QPoint& pixel) const; // of the height, from the centre, right and up
  void press(QMouseEvent& event);
  void drag(QMouseEvent& event);
  void doubleClick(QMouseEvent& event);
  void wheel(QWheelEvent& event);
  void moveTip(const Vec3& target);

  enum class Drag { none, tip, orbit, pan, zoom };
  SceneView view_;
  std::shared_ptr<const SurfaceField> field_;
  Mode mode_ = Mode::feel;
  Drag drag_ = Drag::none;
  QPoint last_;
  Vec3 target_ = Vec3::Zero();
  double frame_seconds_ = 0;
  bool smooth_ = false; // the last frame was anti-aliased
  std::chrono::steady_clock::time_point drawn_;
};

} // namespace patina
