#include "app/gui/painting/paint_controller.h"

#include <algorithm>
#include <cmath>

#include "app/gui/painting/mirror_plane.h"
#include "app/gui/painting/recent_colors.h"
#include "app/gui/state/contact_offset.h"
#include "app/gui/toolkit/words.h"
#include "authoring/brush/painter.h"
#include "haptics/catalog/device_catalog.h"
#include "scene/surface_pick.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

// A released stroke waits this long for the tip: in time, and in ticks if the servo is starved.
constexpr int kGracePeriod = 250; // [ms]
constexpr std::size_t kGraceTicks = 250;
// The wait ends after this time, because a tip may never reach the pointer.
constexpr int kMaxGracePeriod = 5000; // [ms]
// Limits how fast a press deepens on softer surface.
constexpr double kSinking = 0.05;      // [m/s]
constexpr double kMaxPressStep = 0.03; // Longest time step of a press, also after a pause [s].
// A tick farther than this from the chord of two samples becomes a sample [brush radii].
constexpr double kOff = 0.003;

} // namespace

PaintController::PaintController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts) {
  connect(&at_.bar, &ToolBar::chosen, this, &PaintController::take);
  connect(&at_.view, &SceneWidget::pointed, this, &PaintController::follow);
  connect(&at_.view, &SceneWidget::pickRequested, this, &PaintController::pickAt);
  connect(&at_.panel, &BrushPanel::edited, this,
          [this](const Brush& brush) { presets_.set(brush); });
  connect(&at_.panel, &BrushPanel::pressed, this, &PaintController::setForce);
  connect(&at_.tool, &ToolPanel::forceEdited, this, &PaintController::setForce);
  connect(&at_.view, &SceneWidget::forceTurned, this,
          [this](double notches) { setForce(presets_.press + 0.1 * notches); });
  connect(&at_.view, &SceneWidget::escaped, this, &PaintController::escape);
  connect(&at_.panel, &BrushPanel::toolRequested, this, [this](Tool tool) {
    at_.bar.choose({InteractionMode::paint, tool});
  });
}

void PaintController::take(const ToolChoice& choice) {
  down_ = in_grace_ = false;
  stopPainting();
  if (scene_ && force_ > 0) lift(); // Otherwise the next stroke would begin here.
  presses_ = choice.handling == InteractionMode::press;
  if (choice.handling == InteractionMode::paint) {
    tool_ = choice.tool;
    at_.panel.show(brush(), presets_);
    if (scene_) at_.edits.prepare(tool_);
  }
  at_.view.setHandling(choice.handling);
  emit chosen(choice);
}

void PaintController::setScene(std::shared_ptr<const CompiledScene> scene, bool is_new) {
  scene_ = std::move(scene);
  if (!scene_) {
    down_ = in_grace_ = false;
    stopPainting();
  }
  if (!is_new || !scene_) return;
  down_ = in_grace_ = false;
  mirrored_ = 0;
  const Box3 box = bounds(*scene_->mesh);
  presets_.scaleTo(box.isEmpty() ? 0.1 : box.sizes().maxCoeff(), scene_->scene.haptics);
  at_.panel.show(brush(), presets_);
  at_.tool.setForce(presets_.press);
  if (at_.bar.choice().handling == InteractionMode::paint) at_.edits.prepare(tool_);
}

void PaintController::setBrush(const Brush& brush) {
  presets_.set(brush);
  if (brush.tool == tool_) at_.panel.show(brush, presets_);
}

void PaintController::resizeBrush(double factor) {
  if (at_.bar.choice().handling != InteractionMode::paint) return;
  Brush changed = brush();
  changed.radius =
      std::clamp(changed.radius * factor, 1e-3 * presets_.extent(), 0.5 * presets_.extent());
  setBrush(changed);
}

void PaintController::softenBrush(double factor) {
  if (at_.bar.choice().handling != InteractionMode::paint) return;
  Brush changed = brush();
  changed.falloff = std::clamp(changed.falloff * factor, 0.25, 16.0);
  setBrush(changed);
}

void PaintController::setForce(double newtons) {
  presets_.press = std::clamp(newtons, 0.1, 3.0);
  at_.tool.setForce(presets_.press);
  if (force_ > 0) force_ = presets_.press; // The next window tick applies it.
}

void PaintController::escape() {
  down_ = in_grace_ = paints_ = false;
  at_.edits.cancelPainting();
  if (scene_) lift();
}

std::optional<SurfaceValues> PaintController::valuesAt(const Vec3& surface) const {
  const auto joint = surfacePointAt(*scene_->built.field, *scene_->mesh, surface);
  const auto own = joint ? objectPointOf(scene_->scene, *joint) : std::nullopt;
  if (!own) return std::nullopt;
  return surfaceValues(scene_->scene, own->object, own->point);
}

void PaintController::passTip(const Vec3& target) {
  if (target == at_.view.target()) return;
  at_.view.setTarget(target);
  at_.feel.addWaypoint(target, t_);
}

void PaintController::press(const Vec3& surface, double newtons) {
  // Includes painted relief, so that engraved places can be reached, but no texture.
  const auto values = valuesAt(surface);
  // The depth follows from the local stiffness, not from the servo's force, so there is no feedback
  // loop. It grows slowly on softer surface, because the tip lags behind the pointer. Pointer and
  // ticks both call this, so the elapsed time is measured here.
  const bool begins = force_ == 0, presses = newtons > 0; // A pen may touch without pressure.
  const double compliance = presses ? pressDepth(*scene_, surface, newtons) / newtons : 0;
  const double seconds =
      pressed_.isValid()
          ? std::min(1e-9 * static_cast<double>(pressed_.nsecsElapsed()), kMaxPressStep)
          : 0;
  pressed_.start();
  compliance_ = begins || !presses
                    ? compliance
                    : std::min(compliance, compliance_ + kSinking * seconds / newtons);
  double depth = newtons * compliance_;
  // A simulated hand is a spring itself, so the target must be deeper for the same force.
  depth += newtons * deviceNamed(scene_->scene.device).hand_compliance;
  const SurfaceField& field = *scene_->built.field;
  depth = std::min(depth, 0.5 * field.band * field.grid.voxel);
  aim_ = surface;
  if (begins) {
    // Starts above the surface, because a straight path could pass through the object.
    touched_ = false;
    begin_ = surface;
    leapTip(lifted());
  }
  force_ = newtons;
  const double below = depth - contactOffset(scene_->scene.haptics) - (values ? values->height : 0);
  passTip(surface - clampedDepth(*scene_, surface, below) * normalAt(*scene_, surface));
}

Vec3 PaintController::lifted() const {
  const HapticProperties& haptics = scene_->scene.haptics;
  const double offset = contactOffset(haptics) + (haptics.magnet ? haptics.magnet->range : 0);
  const auto values = valuesAt(aim_);
  const double raised = values ? std::max(0.0, values->height) : 0;
  return aim_ + (offset + raised + 0.02 * presets_.extent()) * normalAt(*scene_, aim_);
}

void PaintController::lift() {
  force_ = 0;
  const Vec3 target = lifted();
  at_.view.setTarget(target);
  at_.feel.setTarget(target);
}

void PaintController::follow(const Pointed& where) {
  if (!scene_) return;
  t_ = where.t;
  const auto raise = [this] {
    force_ = 0;
    passTip(lifted());
  };
  if (where.down) {
    down_ = true;
    in_grace_ = false;
    if (where.surface)
      press(*where.surface, presets_.press * where.pressure);
    else
      raise(); // The contact ends, and with it the stroke.
  } else if (down_) {
    down_ = false;
    if (presses_) return raise();
    in_grace_ = true;
    released_.start();
    grace_ticks_ = 0;
  }
  if (at_.bar.choice().handling == InteractionMode::paint) sendHand(true);
}

bool PaintController::arrived(const std::vector<ToolSample>& ticks) const {
  return touched_ && at_.feel.passed() && !ticks.empty() &&
         // Otherwise the end of the stroke would be cut off.
         (ticks.back().surface - aim_).norm() < 0.01 * brush().radius;
}

void PaintController::sendHand(bool paints) {
  paints_ = true;
  const double near = std::max(brush().radius, 0.02 * presets_.extent());
  at_.edits.paint({down_ || in_grace_, begin_, near, kOff * brush().radius, paints}, brush());
}

void PaintController::feed(const std::vector<ToolSample>& ticks) {
  if (!ticks.empty()) last_ = ticks.back();
  touched_ = touched_ || std::any_of(ticks.begin(), ticks.end(),
                                     [](const ToolSample& tick) { return tick.contact; });
  if (!scene_) return;
  if (force_ > 0 && (down_ || in_grace_)) press(aim_, force_); // The surface may have changed.
  if (presses_) return;
  const bool paints = at_.bar.choice().handling == InteractionMode::paint;
  if (paints || down_ || in_grace_)
    sendHand(paints);
  else
    stopPainting();
  const bool waits = in_grace_ && !at_.feel.passed(); // The tip is still on its path.
  const bool over = (!waits && grace_ticks_ > kGraceTicks && released_.elapsed() > kGracePeriod) ||
                    released_.elapsed() > kMaxGracePeriod;
  grace_ticks_ += waits ? 0 : ticks.size(); // The first ticks may be older than the release.
  if (!in_grace_ || !(arrived(ticks) || over)) return;
  in_grace_ = false;
  stopPainting();
  lift();
}

void PaintController::refresh() {
  const bool paints = scene_ && at_.bar.choice().handling == InteractionMode::paint;
  const auto surface = scene_ ? at_.view.underPointer() : std::nullopt;
  if ((paints || (scene_ && presses_)) && surface && !down_ && !in_grace_ &&
      at_.feel.passed()) { // The tool hovers where it would paint.
    aim_ = *surface;
    leapTip(lifted());
  }
  if (paints && surface && brush().symmetry != Symmetry::none)
    if (const auto joint = surfacePointAt(*scene_->built.field, *scene_->mesh, *surface))
      if (const auto own = objectPointOf(scene_->scene, *joint)) mirrored_ = own->object;
  showMirror(paints);
  showCursor(!paints                ? std::nullopt
             : at_.edits.painting() ? std::optional(last_.surface)
                                    : surface);
}

void PaintController::showMirror(bool paints) {
  const Symmetry symmetry = paints ? brush().symmetry : Symmetry::none;
  if (symmetry == Symmetry::none || mirrored_ >= scene_->scene.objects.size())
    return at_.view.view().setMirror(std::nullopt);
  const SceneObject& object = scene_->scene.objects[mirrored_];
  at_.view.view().setMirror(mirrorPlane(object, symmetry));
}

void PaintController::showCursor(const std::optional<Vec3>& surface) {
  if (!surface) return at_.view.view().setBrush(std::nullopt);
  const Brush now = brush();
  const double radius = brushRadius(now, last_.contact ? last_.force.norm() : presets_.press);
  BrushCursorState place{
      *surface, normalAt(*scene_, *surface), radius, halfRadius(now, radius), {1, 1, 1}};
  if (now.tool == Tool::color) place.color = now.color;
  at_.view.view().setBrush(place);
}

void PaintController::pickAt(const Vec3& surface) {
  if (!scene_) return;
  if (const auto values = valuesAt(surface)) {
    const Brush taken = picked(brush(), *values);
    if (taken.tool == Tool::color)
      rememberColor(QColor::fromRgbF(taken.color[0], taken.color[1], taken.color[2]));
    setBrush(taken);
  }
  // The eyedropper works once; then the picked value is painted.
  if (at_.bar.choice().handling == InteractionMode::pick)
    at_.bar.choose({InteractionMode::paint, tool_});
}

} // namespace patina
