// What can be held in the 3D view beside the object: the cube in the corner, which turns the
// camera, and the clip plane's handle.
#pragma once

#include <optional>

#include <QPoint>
#include <QWidget>

#include "app/gui/widgets/camera_turn.h"
#include "visualization/view/scene_view.h"

namespace patina {

// The line of sight through a pixel of the widget that shows the view.
Ray sightAt(const QWidget& widget, SceneView& view, const QPoint& pixel);

class ViewHandles {
 public:
  ViewHandles(QWidget& widget, SceneView& view, FramePacer& frames); // which outlive it

  void setClip(const std::optional<ClipPlane>& plane);
  const std::optional<ClipPlane>& clip() const { return clip_; }

  void hover(const std::optional<QPoint>& pixel);
  const HotPart& hot() const { return hot_; } // under the pointer, or held
  bool any() const { return hot_.cube_side || hot_.clip; }
  bool hold(const QPoint& pixel); // false: nothing is there
  // The cube turns the camera; the handle asks for another plane, which is nobody's yet.
  std::optional<ClipPlane> drag(const QPoint& from, const QPoint& to);
  void release(); // a click on the cube looks from there

 private:
  QWidget& widget_;
  SceneView& view_;
  FramePacer& frames_;
  CameraTurn turn_;
  std::optional<ClipPlane> clip_;
  HotPart hot_;
  QPoint held_from_;
  bool moved_ = false; // since it was held
};

} // namespace patina
