// The 3D view: draws a SceneView, and turns the mouse into tip targets or camera moves.
#pragma once

#include <memory>
#include <optional>

#include <QInputEvent>
#include <QPoint>

#include "app/gui/widgets/view_handles.h"
#include "app/gui/window/handling.h"
#include "core/types.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Where a pointer that paints is.
struct Pointed {
  std::optional<Vec3> surface; // under it; absent: beside the object
  bool down = false;
  double pressure = 1; // of a pen, in [0, 1]
  double t = 0;        // [s], of the window system
};

// Feeling, the left button moves the tip in the plane that faces the viewer, the wheel moves it in
// depth and a double click asks to set it onto the surface; Shift + left, middle, right and Ctrl +
// wheel move the camera. Navigating, the left button and the wheel move the camera too. Painting,
// the left button, or a pen, is on the surface under it, and the wheel zooms; pressing is the same,
// and the wheel is the force's; picking, and with Alt when feeling or painting, it asks what is
// there. On the cube in the corner a click looks from the side that was clicked, a drag turns.
class SceneWidget : public QVTKOpenGLNativeWidget {
  Q_OBJECT
 public:
  explicit SceneWidget(QWidget* parent = nullptr);

  SceneView& view() { return view_; }
  FramePacer& frames() { return frames_; }
  void setHandling(Handling handling);
  // What a double click looks for the surface in; nullptr = no contact yet, the mouse navigates.
  void setField(std::shared_ptr<const SurfaceField> field);
  void setTarget(const Vec3& target) { target_ = target; }
  const Vec3& target() const { return target_; }

  // Surfaces are seen and picked behind it only; nullopt: whole.
  void setClip(const std::optional<ClipPlane>& plane);
  // The surface under the pointer, while it is over the view and moves no camera.
  std::optional<Vec3> underPointer();

  // A resting place for the tip: over the surface in the middle of the picture, towards the viewer.
  Vec3 restingPlace();

 signals:
  void tipMoved(const patina::Vec3& target);
  void placeAsked(const patina::Vec3& surface);
  void forceTurned(double notches);
  void clipMoved(const patina::ClipPlane& plane); // by its handle
  void escaped();                                 // while something was painted
  // When painting or pressing, while the button is down and when it goes.
  void pointed(const patina::Pointed& where);
  void pickAsked(const patina::Vec3& surface);

 protected:
  bool event(QEvent* event) override;

 private:
  bool feels() const { return handling_ == Handling::feel && field_ != nullptr; }
  bool paints() const {
    return (handling_ == Handling::paint || handling_ == Handling::press) && field_ != nullptr;
  }
  std::optional<Vec3> surfaceAt(const QPoint& pixel);
  void brush(const QPoint& pixel, bool down, double pressure, const QInputEvent& event);
  bool pick(const QMouseEvent& event); // false: it is no picking
  bool pen(QTabletEvent& event);
  void release(const QMouseEvent& event);
  void press(QMouseEvent& event);
  void drag(QMouseEvent& event);
  void wheel(QWheelEvent& event);

  void showPointer(); // as what is under it asks for

  enum class Drag { none, tip, orbit, pan, zoom, brush, handle };
  SceneView view_;
  std::shared_ptr<const SurfaceField> field_;
  Handling handling_ = Handling::feel;
  Drag drag_ = Drag::none;
  QPoint last_;
  std::optional<QPoint> pointer_; // over the view
  Vec3 target_ = Vec3::Zero();
  FramePacer frames_;
  ViewHandles handles_;
};

} // namespace patina
