// The tools Measure and Pin: clicks in the 3D view become lengths, angles, radii, areas and pins.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QObject>

#include "app/gui/panels/measure_panel.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/state/tool_choice.h"
#include "app/gui/toolkit/scene_widget.h"
#include "session/edit/edit_thread.h"
#include "session/open/measure.h"

namespace patina {

class MeasureController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    SceneWidget& view;
    MeasurePanel& panel;
    EditThread& edits;
  };
  explicit MeasureController(const Parts& parts, QObject* parent = nullptr); // All outlive it.

  void setTool(const ToolChoice& choice);
  // nullptr: none. surface: it is another one, and what was measured no longer holds.
  void setScene(std::shared_ptr<const CompiledScene> scene, bool surface);

 signals:
  void notified(const patina::Message& message);

 private:
  void click(const QPoint& pixel);
  void pin(const Front& front);
  void measure(const MeasuredPoint& point);
  void finish(std::vector<MeasuredPoint> points);
  void stop(); // Results of running measurements are dropped.
  void clear();
  void removePin(int row);
  void exportPins();
  void changePins(std::function<void(std::vector<Pin>&)> change);
  void show();

  Parts at_;
  InteractionMode mode_ = InteractionMode::navigate;
  std::shared_ptr<const CompiledScene> scene_;
  std::vector<MeasuredPoint> points_; // Clicked so far.
  std::vector<Measurement> done_;
  int running_ = 0; // measurements
};

} // namespace patina
