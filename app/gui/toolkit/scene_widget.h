// The 3D view: draws a SceneView, and turns mouse events into tip targets or camera motion.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include <QInputEvent>
#include <QPoint>
#include <QTimer>
#include <QVTKOpenGLNativeWidget.h>
#include <QWidget>

#include "app/gui/toolkit/interaction_mode.h"
#include "core/types.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Draws the 3D view soon after a camera motion, otherwise on ticks, at most once in 16 ms.
class FramePacer : public QObject {
 public:
  FramePacer(SceneView& view, QVTKOpenGLNativeWidget& widget);
  void cameraMoved(); // Draws soon, before the next tick.
  bool refresh();     // Draws if anything has changed since the last call; false: nothing has.
  // The picture is up to date and anti-aliased.
  bool settled() { return smooth_ && !refresh(); }

 private:
  SceneView& view_;
  QVTKOpenGLNativeWidget& widget_;
  double frame_seconds_ = 0; // Duration of the last frame with changes [s].
  double whole_seconds_ = 0; // The same for the last complete frame [s].
  bool smooth_ = false;      // The last frame was anti-aliased.
  std::chrono::steady_clock::time_point drawn_, moved_;
  QTimer soon_;
};

// Animates the camera to another side, in a fraction of a second.
class CameraTurn : public QObject {
 public:
  CameraTurn(SceneView& view, FramePacer& frames);
  void begin(const Vec3& direction); // Direction of the view; starts at once.
  void stop() { timer_.stop(); }

 private:
  void step();

  SceneView& view_;
  FramePacer& frames_;
  Eigen::Quaterniond from_, to_;
  std::chrono::steady_clock::time_point begun_;
  QTimer timer_;
};

// Returns the line of sight through a pixel of the widget that shows the view.
Ray viewRayAt(const QWidget& widget, SceneView& view, const QPoint& pixel);

// The handles of the 3D view: the cube, which rotates the camera, and those of clip plane and
// slice.
class ViewHandles {
 public:
  // The parameters must outlive it.
  ViewHandles(QWidget& widget, SceneView& view, FramePacer& frames);

  void setClip(const std::optional<ClipPlane>& plane);
  const std::optional<ClipPlane>& clip() const { return clip_; }
  void setSliceHandle(bool on);

  void hover(const std::optional<QPoint>& pixel);
  const HoveredPart& hot() const { return hot_; } // The part under the pointer, or held.
  bool any() const { return hot_.cube_side || hot_.clip; }
  bool hold(const QPoint& pixel); // False: no handle is there.
  // Rotates the camera by the cube, or returns the plane that the handle requests.
  std::optional<ClipPlane> drag(const QPoint& from, const QPoint& to);
  void release() { // After a click on the cube, the camera looks from that side.
    if (hot_.cube_side && !moved_) turn_.begin(*hot_.cube_side);
  }

 private:
  QWidget& widget_;
  SceneView& view_;
  FramePacer& frames_;
  CameraTurn turn_;
  std::optional<ClipPlane> heldPlane() const { return hot_.of_slice ? view_.slicePlane() : clip_; }

  std::optional<ClipPlane> clip_;
  bool slice_handle_ = false;
  HoveredPart hot_;
  QPoint held_from_;
  bool moved_ = false; // Moved since it was held.
};

// State of a pointer that paints or presses.
struct Pointed {
  std::optional<Vec3> surface; // Surface point under the pointer; nullopt: none.
  bool down = false;
  double pressure = 1; // Pressure of a pen, in [0, 1].
  double t = 0;        // Time of the window system [s].
};

// Mouse events by mode. Feel: left button moves the tip in the plane that faces the viewer, the
// wheel moves it in depth, a double click puts it onto the surface; Shift + left, middle, right and
// Ctrl + wheel move the camera. Navigate: the left button and the wheel also move the camera.
// Paint: the left button or a pen acts on the surface, the wheel zooms. Press: the same, but the
// wheel sets the force. Pick, and Alt when feeling or painting: copies the paint at a point.
// Measure and pin: a click sets a point; navigate: it selects what is there. On the cube in the
// corner, a click looks from its side and a drag rotates.
class SceneWidget : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  explicit SceneWidget(QWidget* parent = nullptr);

  SceneView& view() { return view_; }
  FramePacer& frames() { return frames_; }
  void setHandling(InteractionMode handling) {
    handling_ = handling;
    showPointer();
  }
  bool isNavigating() const { return handling_ == InteractionMode::navigate; }
  // Field of the surface for double clicks. nullptr: no contact yet, the mouse navigates.
  void setField(std::shared_ptr<const SurfaceField> field);
  void setTarget(const Vec3& target) { target_ = target; }
  const Vec3& target() const { return target_; }

  // The part in front of the plane is neither drawn nor picked; nullopt: no plane.
  void setClip(const std::optional<ClipPlane>& plane) { handles_.setClip(plane); }
  void setSliceHandle(bool on) { handles_.setSliceHandle(on); }
  // The next drag of the left button draws a line, on the slice where it is shown.
  void setDrawsLine(bool on) {
    draws_line_ = on;
    showPointer();
  }
  // Returns the surface point under the pointer, unless it is outside or moves the camera.
  std::optional<Vec3> underPointer();
  // Returns what is in front under the pointer under the same conditions.
  std::optional<Front> frontUnderPointer();
  std::optional<Front> frontAt(const QPoint& pixel);
  // Returns the visible vertex of the mesh nearest to a pixel, within a few pixels.
  std::optional<Vec3> vertexNear(const QPoint& pixel);

  // Returns a point above the surface in the centre of the picture, towards the viewer.
  Vec3 restingPlace();

 signals:
  void tipMoved(const patina::Vec3& target);
  void placeRequested(const patina::Vec3& surface);
  void forceTurned(double notches);
  void clipMoved(const patina::ClipPlane& plane);
  void sliceMoved(const patina::ClipPlane& plane);
  // While a line is drawn, and when it is complete.
  void lineDrawn(const patina::Vec3& from, const patina::Vec3& to, bool complete);
  void escaped(); // During a stroke.
  // Sent while painting or pressing: while the button is down, and on release.
  void pointed(const patina::Pointed& where);
  void pickRequested(const patina::Vec3& surface);
  void clicked(const QPoint& pixel); // While measuring, pinning or navigating.

 protected:
  bool event(QEvent* event) override;

 private:
  bool marks() const { // Clicks set points, drags move the camera.
    return handling_ == InteractionMode::measure || handling_ == InteractionMode::pin;
  }
  bool feels() const { return handling_ == InteractionMode::feel && field_ != nullptr; }
  bool paints() const {
    return (handling_ == InteractionMode::paint || handling_ == InteractionMode::press) &&
           field_ != nullptr;
  }
  std::optional<Vec3> surfaceAt(const QPoint& pixel);
  std::optional<Vec3> lineEndAt(const QPoint& pixel); // On the slice, or else on the surface.
  void brush(const QPoint& pixel, bool down, double pressure, const QInputEvent& event);
  bool pick(const QMouseEvent& event); // Returns false if not picking.
  bool pen(QTabletEvent& event);
  void release(const QMouseEvent& event);
  void press(QMouseEvent& event);
  void drag(QMouseEvent& event);
  void wheel(QWheelEvent& event);

  void showPointer(); // Sets the pointer's shape.

  enum class Drag { none, tip, orbit, pan, zoom, brush, handle, line };
  SceneView view_;
  std::shared_ptr<const SurfaceField> field_;
  InteractionMode handling_ = InteractionMode::press;
  Drag drag_ = Drag::none;
  QPoint last_, pressed_at_;
  std::optional<QPoint> pointer_;
  bool draws_line_ = false;
  Vec3 line_from_ = Vec3::Zero(), line_to_ = Vec3::Zero();
  Vec3 target_ = Vec3::Zero();
  FramePacer frames_;
  ViewHandles handles_;
};

} // namespace patina
