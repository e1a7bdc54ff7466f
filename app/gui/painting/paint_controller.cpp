#include "app/gui/painting/paint_controller.h"

#include <algorithm>
#include <cmath>

#include "app/gui/control/touching.h"
#include "app/gui/painting/mirror_plane.h"
#include "app/gui/painting/recent_colors.h"
#include "app/gui/widgets/words.h"
#include "authoring/brush/painter.h"
#include "core/numbers.h"
#include "haptics/devices/device_catalog.h"
#include "scene/surface_pick.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

// A button that is let go before the tip has come down: so long the tip may take. Ticks as well,
// for it does not move while the machine has no time for it.
constexpr int kLinger = 250; // [ms]
constexpr std::size_t kLingerTicks = 250;
// And so long in all, for a tip that does not follow the pointer never arrives.
constexpr int kLongest = 5000; // [ms]
// How fast a press gets deeper where the surface gets softer, at most.
constexpr double kSinking = 0.05;     // [m/s]
constexpr double kLongestStep = 0.03; // [s], also after a time in which nothing was followed
// A tick this far from the path between samples, in radii, is a sample.
constexpr double kOff = 0.003;

QString number(double value) {
  return QString::fromStdString(formatNumber(std::round(value * 1e4) / 1e4));
}

// "3 N s/m", "50 µm"
QString measured(const Channel& row, double value) {
  if (row.unit == "m") return inWords(value);
  const QString unit = QString::fromStdString(std::string(row.unit));
  return (number(value) + QStringLiteral(" ") + unit).trimmed();
}

} // namespace

PaintController::PaintController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts) {
  connect(&at_.bar, &ToolBar::chosen, this, &PaintController::take);
  connect(&at_.view, &SceneWidget::pointed, this, &PaintController::follow);
  connect(&at_.view, &SceneWidget::pickAsked, this, &PaintController::pickAt);
  connect(&at_.panel, &BrushPanel::edited, this,
          [this](const Brush& brush) { presets_.set(brush); });
  connect(&at_.panel, &BrushPanel::pressed, this, &PaintController::setForce);
  connect(&at_.tool, &ToolPanel::forceEdited, this, &PaintController::setForce);
  connect(&at_.view, &SceneWidget::forceTurned, this,
          [this](double notches) { setForce(presets_.press + 0.1 * notches); });
  connect(&at_.view, &SceneWidget::escaped, this, &PaintController::escape);
  connect(&at_.panel, &BrushPanel::toolAsked, this, [this](Tool tool) {
    at_.bar.choose({Handling::paint, tool});
  });
}

void PaintController::take(const ToolChoice& choice) {
  down_ = lingers_ = false;
  send(tracker_.finish());
  if (scene_ && newtons_ > 0) lift(); // or the next stroke would begin where this one did
  presses_ = choice.handling == Handling::press;
  if (choice.handling == Handling::paint) {
    tool_ = choice.tool;
    at_.panel.show(brush(), presets_);
    if (scene_) at_.edits.prepare(tool_);
  }
  at_.view.setHandling(choice.handling);
  emit chosen(choice);
}

void PaintController::setScene(std::shared_ptr<const CompiledScene> scene, bool anew) {
  scene_ = std::move(scene);
  if (!anew || !scene_) return;
  down_ = lingers_ = false;
  tracker_ = {};
  mirrored_ = 0;
  const Box3 box = bounds(*scene_->mesh);
  presets_.suit(box.isEmpty() ? 0.1 : box.sizes().maxCoeff(), scene_->scene.haptics);
  at_.panel.show(brush(), presets_);
  at_.tool.setForce(presets_.press);
  if (at_.bar.choice().handling == Handling::paint) at_.edits.prepare(tool_);
}

void PaintController::setBrush(const Brush& brush) {
  presets_.set(brush);
  if (brush.tool == tool_) at_.panel.show(brush, presets_);
}

void PaintController::resizeBrush(double factor) {
  if (at_.bar.choice().handling != Handling::paint) return;
  Brush changed = brush();
  changed.radius =
      std::clamp(changed.radius * factor, 1e-3 * presets_.extent(), 0.5 * presets_.extent());
  setBrush(changed);
}

void PaintController::softenBrush(double factor) {
  if (at_.bar.choice().handling != Handling::paint) return;
  Brush changed = brush();
  changed.falloff = std::clamp(changed.falloff * factor, 0.25, 16.0);
  setBrush(changed);
}

void PaintController::setForce(double newtons) {
  presets_.press = std::clamp(newtons, 0.1, 3.0);
  at_.tool.setForce(presets_.press);
  if (newtons_ > 0) newtons_ = presets_.press; // felt with the next tick of the window
}

void PaintController::escape() {
  down_ = lingers_ = false;
  if (tracker_.painting()) at_.edits.cancelStroke();
  tracker_.cancel();
  if (scene_) lift();
}

std::optional<SurfaceValues> PaintController::valuesAt(const Vec3& surface, QString* object) const {
  const auto joint = surfacePointAt(*scene_->built.field, *scene_->mesh, surface);
  const auto own = joint ? objectPointOf(scene_->scene, *joint) : std::nullopt;
  if (!own) return std::nullopt;
  if (object) *object = QString::fromStdString(scene_->scene.objects[own->object].name);
  return surfaceValues(scene_->scene, own->object, own->point);
}

void PaintController::moveTip(const Vec3& target) {
  at_.view.setTarget(target);
  at_.feel.setTarget(target);
}

void PaintController::leapTip(const Vec3& target) {
  at_.view.setTarget(target);
  at_.feel.leapTarget(target, t_);
}

void PaintController::passTip(const Vec3& target) {
  if (target == at_.view.target()) return;
  at_.view.setTarget(target);
  at_.feel.passTarget(target, t_);
}

void PaintController::press(const Vec3& surface, double newtons) {
  // Painted relief is followed, or an engraved place would be out of reach; what a texture adds to
  // the force is felt.
  const auto values = valuesAt(surface);
  // By the stiffness of the place, which is no answer of the servo: nothing can swing. From hard to
  // soft it sinks slowly, so that it does not press on what is hard ahead of the pointer.
  // Pointer and ticks both come here, so the time is neither's own: it must not count twice.
  const bool begins = newtons_ == 0, presses = newtons > 0; // a pen may only touch
  const double softness = presses ? pressDepth(*scene_, surface, newtons) / newtons : 0;
  const double seconds =
      pressed_.isValid()
          ? std::min(1e-9 * static_cast<double>(pressed_.nsecsElapsed()), kLongestStep)
          : 0;
  pressed_.start();
  softness_ =
      begins || !presses ? softness : std::min(softness, softness_ + kSinking * seconds / newtons);
  double depth = newtons * softness_;
  // A simulated hand is a spring itself: it must reach deeper for the same force.
  depth += newtons * deviceNamed(scene_->scene.device).hand_compliance;
  const SurfaceField& field = *scene_->built.field;
  depth = std::min(depth, 0.5 * field.band * field.grid.voxel);
  aim_ = surface;
  if (begins) {
    // It comes down here, from above: on a straight way it would go through the object.
    begin_ = surface;
    leapTip(lifted());
  }
  newtons_ = newtons;
  const double below = depth - skinOf(scene_->scene.haptics) - (values ? values->height : 0);
  passTip(surface - depthWithin(*scene_, surface, below) * normalAt(*scene_, surface));
}

Vec3 PaintController::lifted() const {
  const HapticProperties& haptics = scene_->scene.haptics;
  const double skin = skinOf(haptics) + (haptics.magnet ? haptics.magnet->range : 0);
  const auto values = valuesAt(aim_);
  const double raised = values ? std::max(0.0, values->height) : 0;
  return aim_ + (skin + raised + 0.02 * presets_.extent()) * normalAt(*scene_, aim_);
}

void PaintController::lift() {
  newtons_ = 0;
  moveTip(lifted());
}

void PaintController::follow(const Pointed& where) {
  if (!scene_) return;
  t_ = where.t;
  const auto raise = [this] {
    newtons_ = 0;
    passTip(lifted());
  };
  if (where.down) {
    down_ = true;
    lingers_ = false;
    if (where.surface)
      press(*where.surface, presets_.press * where.pressure);
    else
      raise(); // beside the object: the stroke ends with its contact
  } else if (down_) {
    down_ = false;
    if (presses_) return raise();
    lingers_ = true;
    released_.start();
    lingered_ = 0;
  }
}

bool PaintController::arrived(const std::vector<ToolSample>& ticks) const {
  return tracker_.painting() && at_.feel.passed() && !ticks.empty() &&
         (ticks.back().surface - aim_).norm() < 0.01 * brush().radius; // or the end is cut
}

void PaintController::send(const std::vector<StrokePiece>& pieces) {
  for (const StrokePiece& piece : pieces) {
    if (piece.begins) at_.edits.beginStroke(brush());
    at_.edits.dabs(piece.samples);
    if (piece.ends) at_.edits.endStroke();
  }
}

void PaintController::feed(const std::vector<ToolSample>& ticks) {
  if (!ticks.empty()) last_ = ticks.back();
  if (!scene_) return;
  if (newtons_ > 0 && (down_ || lingers_)) press(aim_, newtons_); // the surface may have changed
  if (presses_) return;
  const double near = std::max(brush().radius, 0.02 * presets_.extent());
  const bool paints = at_.bar.choice().handling == Handling::paint;
  send(tracker_.feed(ticks, {down_ || lingers_, begin_, near, kOff * brush().radius, paints}));
  const bool waits = lingers_ && !at_.feel.passed(); // for a tip that is still on its way
  const bool over = (!waits && lingered_ > kLingerTicks && released_.elapsed() > kLinger) ||
                    released_.elapsed() > kLongest;
  lingered_ += waits ? 0 : ticks.size(); // only after: the first may be from before the button
  if (!lingers_ || !(arrived(ticks) || over)) return;
  lingers_ = false;
  send(tracker_.finish());
  lift();
}

void PaintController::refresh() {
  const bool paints = scene_ && at_.bar.choice().handling == Handling::paint;
  const auto surface = scene_ ? at_.view.underPointer() : std::nullopt;
  if ((paints || (scene_ && presses_)) && surface && !down_ && !lingers_ &&
      at_.feel.passed()) { // the tool hovers where it would paint
    aim_ = *surface;
    leapTip(lifted());
  }
  if (paints && surface && brush().symmetry != Symmetry::none)
    if (const auto joint = surfacePointAt(*scene_->built.field, *scene_->mesh, *surface))
      if (const auto own = objectPointOf(scene_->scene, *joint)) mirrored_ = own->object;
  showMirror(paints);
  showCursor(!paints ? std::nullopt : tracker_.painting() ? std::optional(last_.surface) : surface);
  if (refreshes_++ % 3 == 0) emit underPointer(surface ? wordsFor(*surface) : QString());
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
  BrushPlace place{
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
  // The eyedropper is used once: what was picked is painted with next.
  if (at_.bar.choice().handling == Handling::pick) at_.bar.choose({Handling::paint, tool_});
}

QString PaintController::wordsFor(const Vec3& surface) const {
  QString object;
  const auto values = valuesAt(surface, &object);
  if (!values) return {};
  const Material& m = values->material;
  QStringList words{object, tr("%1 N/m").arg(m.stiffness, 0, 'f', 0)};
  if (m.static_friction > 0 || m.dynamic_friction > 0)
    words << tr("friction %1 / %2").arg(number(m.static_friction), number(m.dynamic_friction));
  for (const Channel& row : kChannels) {
    const double value = valueOf(m, row.channel);
    if (row.channel <= MaterialChannel::dynamic_friction || !(value > 0)) continue; // above
    const bool rough = row.channel == MaterialChannel::roughness;
    const QString what = rough ? tr("rough") : captionOf(Tool::material(row.channel));
    words << what + QStringLiteral(" ") + measured(row, value);
  }
  if (values->height != 0)
    words << tr("relief %1 mm").arg(shownAs(1000 * values->height, 3), 0, 'f', 3);
  if (values->color[3] > 0) {
    const double cover = values->color[3];
    words << tr("colour %1")
                 .arg(QColor::fromRgbF(std::min(1.0, values->color[0] / cover),
                                       std::min(1.0, values->color[1] / cover),
                                       std::min(1.0, values->color[2] / cover))
                          .name());
    if (cover < 0.995) words.back() += tr(" at %1 %").arg(100 * cover, 0, 'f', 0);
  }
  return words.join(QStringLiteral(" · "));
}

} // namespace patina
