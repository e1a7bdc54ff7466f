// A path that is drawn on a mesh by the left button, in a picture of a scan.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QMouseEvent>
#include <QObject>

#include "app/gui/scanning/scan_view.h"
#include "geometry/tree/triangle_tree.h"
#include "scene/scene.h"

namespace patina {

class PathPen : public QObject {
  Q_OBJECT
 public:
  explicit PathPen(ScanView& view); // to which it belongs

  void setScene(const Scene& scene); // what is drawn on
  void setOn(bool on);               // else the button moves the camera
  bool isOn() const { return on_; }

 signals:
  void drawn(int object, const std::vector<patina::Vec3>& points); // of it, object frame
  void left();                                                     // Esc

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void touch(const QPoint& pixel);
  void showPath();

  struct Ground {
    std::shared_ptr<const TriangleMesh> mesh;
    Pose world_from_object = Pose::Identity();
    std::unique_ptr<TriangleTree> tree; // made when it is first drawn on
  };
  ScanView& view_;
  std::vector<Ground> grounds_;
  bool on_ = false, down_ = false;
  int object_ = -1;          // that the path lies on
  std::vector<Vec3> points_; // object frame
};

} // namespace patina
