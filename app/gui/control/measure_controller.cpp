#include "app/gui/control/measure_controller.h"

#include <utility>

#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/file.h"
#include "session/compile/probe_table.h"

namespace patina {
namespace {

std::size_t pointsOf(MeasureKind kind) {
  return kind == MeasureKind::distance ? 2 : kind == MeasureKind::angle ? 3 : 1;
}

Measurement measured(const CompiledScene& scene, MeasureKind kind,
                     const std::vector<MeasuredPoint>& at, double radius,
                     const Progress& progress) {
  switch (kind) {
  case MeasureKind::distance:
    return measureDistance(scene, at[0], at[1], progress);
  case MeasureKind::angle:
    return measureAngle(at[0], at[1], at[2]);
  case MeasureKind::sphere:
    return measureSphere(scene, at[0], radius);
  case MeasureKind::cylinder:
    return measureCylinder(scene, at[0], radius);
  case MeasureKind::area:
    break;
  }
  return measurePaint(scene, at[0]);
}

std::string labelOf(const Measurement& measurement) {
  return measurement.words.substr(0, measurement.words.find(','));
}

} // namespace

MeasureController::MeasureController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts) {
  connect(&at_.view, &SceneWidget::clicked, this, &MeasureController::click);
  connect(&at_.panel, &MeasurePanel::kindChosen, this, [this] {
    points_.clear();
    show();
  });
  connect(&at_.panel, &MeasurePanel::cleared, this, [this] { running_ > 0 ? stop() : clear(); });
  connect(&at_.panel, &MeasurePanel::pinRemoved, this, &MeasureController::removePin);
  connect(&at_.panel, &MeasurePanel::exportRequested, this, &MeasureController::exportPins);
}

void MeasureController::setTool(const ToolChoice& choice) {
  mode_ = choice.handling;
  points_.clear();
  at_.panel.setMode(mode_);
  show();
}

void MeasureController::setScene(std::shared_ptr<const CompiledScene> scene, bool surface) {
  scene_ = std::move(scene);
  if (surface) {
    const Box3 box = scene_ ? bounds(*scene_->mesh) : Box3();
    at_.panel.setExtent(box.isEmpty() ? 0.1 : box.sizes().maxCoeff());
    clear();
  }
  show();
}

void MeasureController::click(const QPoint& pixel) {
  const bool measures = mode_ == InteractionMode::measure;
  if (!scene_ || !(measures || mode_ == InteractionMode::pin)) return;
  const auto front = at_.view.frontAt(pixel);
  if (!measures) {
    if (front) pin(*front);
    return;
  }
  if (const auto vertex = at_.view.vertexNear(pixel))
    measure(measuredPointAt(*scene_, *vertex));
  else if (front)
    measure(front->layer == Layer::mesh ? measuredPointAt(*scene_, front->point)
                                        : MeasuredPoint{front->point, {}});
}

void MeasureController::measure(const MeasuredPoint& point) {
  points_.push_back(point);
  if (points_.size() == pointsOf(at_.panel.kind())) finish(std::exchange(points_, {}));
  at_.panel.setNext(static_cast<int>(points_.size()));
  show();
}

// A path over a large mesh takes seconds, so the window goes on meanwhile.
void MeasureController::finish(std::vector<MeasuredPoint> points) {
  for (Background* job : findChildren<Background*>())
    if (job->isIdle()) delete job; // It was stopped, and has ended since.
  auto* job = new Background(this);
  at_.panel.setBusy(++running_ > 0);
  job->start([this, job, points = std::move(points), scene = scene_, kind = at_.panel.kind(),
              radius = at_.panel.patchRadius()](Progress& progress, const Background::Post& post) {
    Measurement found;
    try {
      found = measured(*scene, kind, points, radius, progress);
    } catch (const std::exception& error) {
      found = {error.what(), 0, {}, {}, true};
    }
    post(true, [this, job, found] {
      job->deleteLater();
      at_.panel.setBusy(--running_ > 0);
      if (found.failed) return notified({tr("Measure: %1").arg(shownText(found.words)), true});
      done_.push_back(found);
      show();
    });
  });
}

void MeasureController::stop() {
  for (Background* job : findChildren<Background*>())
    job->isIdle() ? delete job : job->discardResult();
  running_ = 0;
  at_.panel.setBusy(false);
}

void MeasureController::clear() {
  stop();
  points_.clear();
  done_.clear();
  at_.panel.setNext(0);
  show();
}

void MeasureController::pin(const Front& front) {
  changePins([at = front.point](std::vector<Pin>& pins) {
    pins.push_back({nextPinName(pins), at});
  });
}

void MeasureController::removePin(int row) {
  if (!scene_ || static_cast<std::size_t>(row) >= scene_->scene.pins.size()) return;
  const std::string name = scene_->scene.pins[static_cast<std::size_t>(row)].name;
  changePins([name](std::vector<Pin>& pins) {
    std::erase_if(pins, [&](const Pin& pin) { return pin.name == name; });
  });
}

// Each change is a step of the history: the empty request ends the collecting of values. It changes
// the pins of its turn, which may be others than those shown now.
void MeasureController::changePins(std::function<void(std::vector<Pin>&)> change) {
  at_.edits.previewValues([change = std::move(change)](Scene& scene) { change(scene.pins); });
  at_.edits.apply("", [](const CompiledScene&) { return nullptr; });
}

void MeasureController::exportPins() {
  saveDialog(at_.view.window(), tr("Export the pins"), tr("Tables (*.csv)"),
             QStringLiteral("pins.csv"),
             [this](const QString& path) {
               if (!scene_) return;
               try {
                 writeFileAtomically(path.toStdString(), pinTable(*scene_));
                 emit notified({tr("Saved %1").arg(path)});
               } catch (const Error& error) {
                 emit notified({shownText(error.what()), true});
               }
             })
      ->open();
}

void MeasureController::show() {
  std::vector<Annotation> annotations;
  QStringList results, pins;
  for (const Measurement& each : done_) {
    annotations.push_back({each.points, each.line, labelOf(each)});
    // One line for each number.
    results << inWords(each.words).replace(", ", "\n    ").split('\n');
  }
  if (!points_.empty()) {
    Annotation unfinished;
    for (const MeasuredPoint& point : points_) unfinished.points.push_back(point.position);
    annotations.push_back(unfinished);
  }
  if (scene_)
    for (Annotation& pin : pinAnnotations(scene_->scene.pins)) {
      const Vec3 at = 1e3 * pin.points.front();
      pin.label = pinLabel(*scene_, {pin.label, pin.points.front()});
      pins << tr("%1 at %2, %3, %4 mm")
                  .arg(inWords(pin.label))
                  .arg(shownAs(at.x(), 3), 0, 'f', 3)
                  .arg(shownAs(at.y(), 3), 0, 'f', 3)
                  .arg(shownAs(at.z(), 3), 0, 'f', 3);
      annotations.push_back(std::move(pin));
    }
  at_.view.view().setAnnotations(annotations);
  at_.panel.setResults(results);
  at_.panel.setPins(pins);
}

} // namespace patina
