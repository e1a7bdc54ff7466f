// Reads the values under the pointer of whatever is in front in the 3D view.
#pragma once

#include <memory>

#include <QObject>

#include "app/gui/toolkit/scene_widget.h"
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

} // namespace patina
