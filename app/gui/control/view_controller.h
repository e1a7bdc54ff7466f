// What the 3D view shows: nothing, a preview or a scene, and of it the layers that are chosen.
#pragma once

#include <memory>

#include <QObject>

#include "app/gui/control/camera_hand.h"
#include "app/gui/control/scene_change.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/widgets/scene_widget.h"
#include "app/gui/window/window_state.h"
#include "session/build/surface_stability.h"

namespace patina {

class ViewController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    SceneWidget& view;
    DisplayPanel& display;
    PaintDisplay& paint;
    ObjectPanel& mesh;
  };
  ViewController(const Parts& parts, QObject* parent);

  SceneView& view() { return at_.view.view(); }
  Content content() const { return content_; }
  bool hasPaint() const { return has_paint_; }
  void clear();
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void showScene(const SceneChange& change);
  void showStability(const std::shared_ptr<const SurfaceStability>& stability); // null: none
  void refresh(); // draws what has changed; of every window tick
  void exportPicture();
  void setCameraHand(std::unique_ptr<CameraHand> hand); // null: none

 signals:
  void said(const patina::Message& message);

 private:
  void showMesh(std::shared_ptr<const TriangleMesh> mesh);
  void showPaint(const Scene& scene);
  void clip(bool on);
  void turnClip(ClipTurn turn);
  void setClip(const std::optional<ClipPlane>& plane);

  Parts at_;
  Content content_ = Content::nothing;
  bool has_paint_ = false;
  std::optional<ClipPlane> clip_;
  std::unique_ptr<CameraHand> hand_;
  std::string hand_problem_; // that was said
};

} // namespace patina
