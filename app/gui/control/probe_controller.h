// Reads the values under the pointer of whatever is in front in the 3D view, and the tip's gap.
#pragma once

#include <memory>

#include <QObject>

#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/scene_widget.h"
#include "geometry/tree/triangle_tree.h"
#include "session/compile/probe.h"

namespace patina {

// "Slice · 1.000, −2.000, 30.000 mm · distance 0.5 mm · gradient 0, 0, 1 · cup · 500 N/m · …"
QString probeWords(const Scene& scene, Layer layer, const Probe& probe);

class ProbeController : public QObject {
  Q_OBJECT
 public:
  explicit ProbeController(SceneWidget& view, QObject* parent = nullptr); // The view outlives it.

  void setScene(std::shared_ptr<const CompiledScene> scene) { scene_ = std::move(scene); }
  void refresh(); // Called on each tick of the window.

 signals:
  void underPointer(const QString& words); // Empty: nothing.

 private:
  SceneWidget& view_;
  std::shared_ptr<const CompiledScene> scene_; // nullptr: none.
  QString words_;
  int refreshes_ = 0;
};

// Finds the surface point nearest to the free tip. Beyond the field's band it needs a tree of all
// triangles, which a background task makes for the first such tip.
class GapFinder : public QObject {
 public:
  explicit GapFinder(QObject* parent) : QObject(parent) {}

  void setScene(std::shared_ptr<const CompiledScene> scene); // nullptr: none.
  // nullopt: the tip touches or is pulled, is inside, or the tree is not made yet.
  std::optional<Vec3> nearestTo(const ToolSample& sample);

 private:
  std::shared_ptr<const CompiledScene> scene_;
  std::shared_ptr<const TriangleTree> tree_; // nullptr: not made for this mesh
  bool asked_ = false;                       // It was, even if that failed.
  std::int32_t last_face_ = -1;
  Background jobs_{this};
};

} // namespace patina
