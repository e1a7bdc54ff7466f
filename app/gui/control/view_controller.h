// Shows a scene, a preview or nothing in the 3D view, with the layers that the user has chosen.
// A SpaceMouse may move its camera.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <QObject>
#include <vtkCamera.h>

#include "app/gui/control/scene_change.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/panels/color_panel.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/state/window_state.h"
#include "app/gui/toolkit/scene_widget.h"
#include "haptics/link/linked_device.h"
#include "session/open/surface_stability.h"
#include "usb/usb_transport.h"
#include "visualization/values/figure.h"

namespace patina {

// A SpaceMouse that moves the camera, independently of the haptic device.

// Moves the camera so that the scene follows the cap ("object mode"). For one thread.
class CameraHand {
 public:
  // Uses the SpaceMouse that is plugged in, also later, or an emulated one through `open`.
  CameraHand();
  explicit CameraHand(std::function<std::unique_ptr<UsbTransport>()> open);
  // Moves the camera by the deflection since the last call; false: none. Waits at most 0.5 ms.
  bool move(vtkCamera& camera);
  std::string problem() const; // Why it does not move, in one line; empty: it works.

 private:
  std::shared_ptr<LinkStatistics> notes_ = std::make_shared<LinkStatistics>();
  std::unique_ptr<Device> device_;
  std::optional<DeviceState> last_; // nullopt: it was unplugged.
};

class ViewController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    SceneWidget& view;
    DisplayPanel& display;
    PaintDisplay& paint;
    ColorPanel& colors;
    ObjectPanel& mesh;
  };
  ViewController(const Parts& parts, QObject* parent);

  SceneView& view() { return at_.view.view(); }
  Content content() const { return content_; }
  void clear() {
    showMesh(nullptr);
    content_ = Content::nothing;
  }
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void showScene(const SceneChange& change);
  void editDone();            // An edit that was requested is done, or refused.
  void setAligning(bool on) { // The desk Align is in front, whose error map has a scale.
    aligning_ = on;
    offerColors();
  }
  void showStability(const std::shared_ptr<const SurfaceStability>& stability); // nullptr: none.
  void refresh();       // Draws changes; called on each tick of the window.
  void exportPicture(); // Opens a dialog.
  void exportVideo();   // Asks for a recording and a file.
  void setCameraHand(std::unique_ptr<CameraHand> hand) { // nullptr: none.
    hand_ = std::move(hand);
    hand_problem_.clear();
  }

 signals:
  void notified(const patina::Message& message);
  void coloredChanged(); // The card Colours has another thing, or none.
  void editRequested(const std::function<void(patina::Scene&)>& edit); // Colours or slices.

 private:
  // Draws the view in another window; a dialog says what fails.
  void drawOutside(const std::function<void()>& draw);
  void saveFigure(const Figure& figure);
  void copyFigure(const Figure& figure);
  std::unique_ptr<SceneView> copyOfView(); // Lacks the tool.
  // The field that is drawn, plotted and probed: with baked relief. There must be a scene.
  const std::shared_ptr<const SurfaceField>& shownField() const { return scene_->paint.field; }
  void writeVideo(const QString& recording, const QString& path);
  void showMesh(std::shared_ptr<const TriangleMesh> mesh);
  void showPaint(const Scene& scene);
  void connectSlice();
  void showSlices();
  void edit(const std::function<void(Scene&)>& change);
  void showProfile(const Vec3& from, const Vec3& to, bool complete);
  void showHistogram();
  void takeLooks();
  void offerColors(); // Hands the selected thing to the card Colours.
  void show(const std::string& thing, bool on);
  void select(const QPoint& pixel); // The row of what is in front there.
  void clip(bool on);
  void turnClip(ClipTurn turn);
  void setClip(const std::optional<ClipPlane>& plane) {
    clip_ = plane;
    at_.view.setClip(plane);
  }

  Parts at_;
  Content content_ = Content::nothing;
  std::optional<ClipPlane> clip_;
  double iso_ = 0;                                    // [m]
  std::shared_ptr<const CompiledScene> scene_;        // nullptr: none.
  std::shared_ptr<const SurfaceStability> stability_; // nullptr: none.
  ColorScales scales_;
  int edits_pending_ = 0; // Colours and slices.
  bool aligning_ = false;
  std::unique_ptr<CameraHand> hand_;
  std::string hand_problem_; // The last problem that was reported.
};

} // namespace patina
