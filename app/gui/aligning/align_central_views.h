// Central views of the desk Align: a path over its mesh from four sides, or what is missing.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include <QStackedWidget>

#include "app/gui/aligning/alignment.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/picture_view.h"
#include "app/gui/toolkit/plot.h"
#include "visualization/layers/path_layer.h"

namespace patina {

// Three point pairs, clicked alternately on path and mesh, and the pose that aligns them.
class PointPicking {
 public:
  explicit PointPicking(const Alignment& alignment) : alignment_(alignment) {}

  void set(bool on); // Starts again without points, or ends.
  bool on() const { return on_; }
  // Adds the requested point if it is within reach [m] of the sight and not close to others.
  void pick(const Ray& sight, double reach);
  QString words() const; // The next point to click; empty: none.
  std::vector<DrawnMark> marks() const;
  std::optional<Pose> pose() const; // mesh_from_path; nullopt: points are missing.

 private:
  const Alignment& alignment_;
  std::vector<Vec3> on_path_, on_mesh_;
  bool on_ = false;
};

// Computes the error map and the cost profile around the path's pose in the background. Plots the
// rms distance around the pose, and at every step of the history.
class CostProfileJob : public QObject {
  Q_OBJECT
 public:
  explicit CostProfileJob(const Alignment& alignment);

  QWidget* panel() const { return panel_; }
  // One value for each vertex of the mesh [m]; empty: not known at this pose.
  const std::vector<float>& error() const { return error_; }
  void start(); // Starts at the present pose.
  void reset(); // Discards results, because the pose has changed.

 signals:
  void errorChanged();

 private:
  void show(const CostProfile& profile);
  PlotAxes stepAxes() const;

  const Alignment& alignment_;
  Background job_{this};
  QWidget* panel_ = new QWidget;
  PlotWidget* plot_ = new PlotWidget;
  QWidget* map_card_ = new QWidget;
  PictureView* map_ = new PictureView;
  QLabel* map_words_ = quietLabel({});
  std::vector<float> error_;
};

// One of the four views of a path over a mesh, in parallel projection from a fixed side. A drag of
// the handle moves the path, any other left drag shifts the picture, the wheel zooms.
class AlignView : public ScanView {
  Q_OBJECT
 public:
  AlignView(const char* name, ViewPreset from);

  void setPicking(bool picks); // A click picks a point, and the handle is disabled.
  void fit() override;

 signals:
  void dragStarted();
  void dragged(const patina::Pose& motion); // Motion since the drag started.
  void dropped();
  void clicked(const patina::Ray& sight, double reach); // reach: radius of the click [m].
  // The pointer moves without a button; nullopt: it has left.
  void pointed(const std::optional<patina::Ray>& sight, double reach);

 protected:
  void press(const QMouseEvent& event) override;
  void move(const QMouseEvent& event, double dx, double dy) override;
  void release(const QMouseEvent& event) override;
  void leave() override;

 private:
  Vec3 inPlane(const QPoint& pixel, const Vec3& through) {
    return pointInViewPlane(camera(), inHeights(pixel).x(), inHeights(pixel).y(), through);
  }
  std::optional<HandlePart> under(const QPoint& pixel);
  double reach() { return 2 * camera().GetParallelScale() / std::max(1, height()) * kPickReach; }

  ViewPreset from_;
  bool picks_ = false;
  std::optional<HandlePart> held_;
  HandleView drag_view_; // Geometry of the handle at the start of the drag.
  Vec3 drag_origin_ = Vec3::Zero();
};

class AlignCentralViews : public QStackedWidget {
  Q_OBJECT
 public:
  AlignCentralViews();

  // Offers to open this mesh file from the path's folder while no scene is open. Empty: none.
  void offerMesh(const std::filesystem::path& file);
  void showMissing(bool has_path); // has_path: only the mesh is missing; otherwise both are.
  void showMesh(const std::shared_ptr<const TriangleMesh>& mesh);
  void setPicking(bool picks);
  void draw(DrawnPath path, const std::vector<DrawnMark>& marks, const std::optional<Vec3>& handle);
  void setMeshValues(const std::vector<float>& values) { // see ScanPicture
    for (AlignView* view : views_) view->picture().setMeshValues(values);
  }
  std::optional<ValueRange> valueRange() const { // Range of the colours [mm].
    return views_.empty() ? std::nullopt : views_[0]->picture().valueRange();
  }
  void fit() {
    for (AlignView* view : views_) view->fit();
  }
  void refresh() { // Called on each tick of the window.
    for (AlignView* view : views_) view->refresh();
  }

 signals:
  void meshRequested(const QString& file);
  void dragStarted(); // The same as the signals of each view.
  void dragged(const patina::Pose& motion);
  void dropped();
  void clicked(const patina::Ray& sight, double reach);
  void pointed(const std::optional<patina::Ray>& sight, double reach);
  void escaped();

 private:
  void makeViews();

  QLabel* empty_ = new QLabel;
  QPushButton* offer_ = new QPushButton;
  std::filesystem::path offered_;
  bool has_path_ = false;
  std::vector<AlignView*> views_; // Made with the first path.
};

} // namespace patina
