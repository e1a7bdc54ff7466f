#include "authoring/brush/painter.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "authoring/brush/object_stroke.h"
#include "authoring/brush/stroke_path.h"
#include "authoring/brush/volume_fill.h"
#include "core/error.h"
#include "geometry/mesh/joint_mesh.h"

namespace patina {
namespace {

// Each place once: then along the path, so that no ripple is left between dabs.
bool sweeps(const Brush& brush) {
  return brush.mode == StrokeMode::max || brush.mode == StrokeMode::add ||
         (brush.mode == StrokeMode::smooth && brush.tool == Tool::erase);
}

void check(const PaintSurface& surface, const Scene& scene) {
  if (surface.objects.size() != scene.objects.size())
    throw std::invalid_argument("Painter: not the surface of this scene");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const PaintObject& made = surface.objects[i];
    const ObjectPaint* paint = scene.objects[i].paint.get();
    if (static_cast<std::size_t>(made.faces) != scene.objects[i].mesh->triangles.size())
      throw std::invalid_argument("Painter: not the surface of this scene");
    if (!paint || !made.texels) continue;
    for (const auto& image : {paint->color, paint->relief})
      if (image &&
          (image->width() != made.texels->width || image->height() != made.texels->height ||
           (paint->layout.uvs != made.layout.uvs && *paint->layout.uvs != *made.layout.uvs)))
        throw std::invalid_argument("Painter: the surface has another layout than the paint");
  }
}

} // namespace

struct Painter::Impl {
  struct Touch {
    ClosestPoint foot;
    double radius;
  };

  Impl(std::shared_ptr<const PaintSurface> s, const Scene& scene)
      : surface(std::move(s)), fill(surface), changes(scene.objects.size()),
        strokes(scene.objects.size()) {
    for (const SceneObject& object : scene.objects) paint.push_back(object.paint);
    task.base = baseMaterial(scene.haptics);
    task.relief_height = scene.relief.height;
  }

  bool dab(const PathStep& step, PaintReport& report);
  std::optional<ClosestPoint> footOf(const PathStep& step) const;
  std::optional<Touch> stamp(const PathStep& step, const std::optional<Touch>& last,
                             PaintReport& report);
  void apply(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report);
  std::size_t objectOf(std::int32_t face) const;
  void publish();

  std::shared_ptr<const PaintSurface> surface;
  VolumeFill fill;
  std::vector<std::shared_ptr<const ObjectPaint>> paint;
  std::vector<PaintChange> changes; // by object; of strokes that have ended
  StrokeTask task;
  std::optional<StrokePath> path;                   // absent between strokes
  std::vector<std::optional<ObjectStroke>> strokes; // made when the brush first touches the object
  std::optional<Touch> touch, mirrored;             // the last dabs
};

Painter::Painter(std::shared_ptr<const PaintSurface> surface, const Scene& scene) {
  if (!surface) throw std::invalid_argument("Painter: no surface");
  check(*surface, scene);
  impl_ = std::make_unique<Impl>(std::move(surface), scene);
}

Painter::~Painter() = default;

void Painter::begin(const Brush& brush) {
  validate(brush);
  if (layerOf(brush, Tool::relief) && impl_->task.relief_height == 0)
    throw Error("relief.height is 0: no relief can be painted");
  end();
  const bool images = std::any_of(impl_->paint.begin(), impl_->paint.end(), [&](const auto& paint) {
    return changesImages(brush, paint.get());
  });
  if (images && !hasImages(*impl_->surface))
    throw std::invalid_argument("Painter: the surface has no images");
  impl_->task.brush = brush;
  impl_->path.emplace(brush, impl_->surface->field->grid);
}

PaintReport Painter::dab(const StrokeSample& sample) {
  if (!impl_->path) throw std::invalid_argument("Painter: no stroke has begun");
  PaintReport report;
  bool hit = false;
  for (const PathStep& step : impl_->path->to(sample)) hit = impl_->dab(step, report);
  if (!hit || !impl_->path->reached()) report.missed = 1;
  return report;
}

void Painter::end() {
  if (!impl_->path) return;
  for (auto& stroke : impl_->strokes)
    if (stroke) stroke->finish();
  impl_->publish();
  for (std::size_t i = 0; i < impl_->strokes.size(); ++i) {
    if (impl_->strokes[i]) impl_->strokes[i]->collect(impl_->changes[i]);
    impl_->strokes[i].reset();
  }
  impl_->path.reset();
  impl_->touch = impl_->mirrored = std::nullopt;
}

const std::vector<std::shared_ptr<const ObjectPaint>>& Painter::paint() const {
  impl_->publish();
  return impl_->paint;
}

std::vector<PaintChange> Painter::takeChanges() {
  std::vector<PaintChange> result;
  for (std::size_t i = 0; i < impl_->changes.size(); ++i) {
    if (impl_->strokes[i]) impl_->strokes[i]->collect(impl_->changes[i]);
    PaintChange change = std::exchange(impl_->changes[i], {});
    change.object = i;
    if (!change.region.isEmpty()) result.push_back(std::move(change));
  }
  return result;
}

// A dab and its mirror image, which starts from the surface's own point, so that a tip that is a
// little off paints both sides alike. Whether the surface is within the brush.
bool Painter::Impl::dab(const PathStep& step, PaintReport& report) {
  if (!step.connected) touch = mirrored = std::nullopt;
  touch = stamp(step, touch, report);
  if (!touch || task.brush.symmetry == Symmetry::none) {
    mirrored.reset();
    return touch.has_value();
  }
  const PaintObject& owner = surface->objects[objectOf(touch->foot.surface.face)];
  const int axis = static_cast<int>(task.brush.symmetry) - static_cast<int>(Symmetry::x);
  const auto beyond = [&](const Vec3& place) {
    Vec3 p = owner.world_from_object.inverse() * place;
    p[axis] = 2 * owner.middle[axis] - p[axis];
    return Vec3(owner.world_from_object * p);
  };
  PathStep there = step;
  there.position = beyond(touch->foot.point);
  if (step.tip) there.tip = beyond(*step.tip);
  mirrored = stamp(there, mirrored, report);
  return true;
}

std::optional<ClosestPoint> Painter::Impl::footOf(const PathStep& step) const {
  if (task.brush.seed == Seed::segment && step.tip)
    if (const auto hit = fill.pierced(*step.tip, step.position)) return hit;
  return fill.foot(step.position);
}

std::optional<Painter::Impl::Touch>
Painter::Impl::stamp(const PathStep& step, const std::optional<Touch>& last, PaintReport& report) {
  const double radius = step.radius;
  if (!(radius > 0)) return std::nullopt;
  const std::optional<ClosestPoint> foot = footOf(step);
  if (!foot || !(foot->distance <= radius)) return std::nullopt;
  Dab dab{foot->point, foot->point, radius, radius, Vec3::Zero()};
  const std::int32_t seed = foot->surface.face;
  if (task.brush.front_only) dab.front = faceNormal(*surface->mesh, static_cast<std::size_t>(seed));
  // A foot that leaps went to another part of the surface.
  if (sweeps(task.brush) && last &&
      (foot->point - last->foot.point).norm() <= 0.5 * std::max(last->radius, radius)) {
    dab.from = last->foot.point;
    dab.radius_from = last->radius;
  }
  const auto faces = fill.fill(dab.centre(), dab.reach(), seed, dab.front);
  ++report.dabs;
  report.faces += faces.size();
  apply(dab, faces, report);
  return Touch{*foot, radius};
}

void Painter::Impl::apply(const Dab& dab, std::span<const std::int32_t> faces,
                          PaintReport& report) {
  for (auto first = faces.begin(); first != faces.end();) {
    const std::size_t object = objectOf(*first);
    const std::int32_t end = surface->objects[object].first_face + surface->objects[object].faces;
    const auto last = std::find_if(first, faces.end(), [&](std::int32_t f) { return f >= end; });
    if (!strokes[object]) strokes[object].emplace(surface, object, paint[object], task);
    strokes[object]->paint(dab, {first, last}, report);
    first = last;
  }
}

std::size_t Painter::Impl::objectOf(std::int32_t face) const {
  return static_cast<std::size_t>(partOfFace(surface->objects, face, &PaintObject::first_face));
}

void Painter::Impl::publish() {
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (strokes[i]) paint[i] = strokes[i]->paint();
}

PaintReport& PaintReport::operator+=(const PaintReport& other) {
  dabs += other.dabs;
  faces += other.faces;
  texels += other.texels;
  nodes += other.nodes;
  missed += other.missed;
  return *this;
}

Scene painted(std::shared_ptr<const PaintSurface> surface, const Scene& scene, const Stroke& stroke,
              PaintReport* report) {
  validate(stroke);
  Painter painter(std::move(surface), scene);
  painter.begin(stroke.brush);
  PaintReport sum;
  for (const StrokeSample& sample : stroke.samples) sum += painter.dab(sample);
  painter.end();
  Scene result = scene;
  for (std::size_t i = 0; i < result.objects.size(); ++i)
    result.objects[i].paint = painter.paint()[i];
  if (report) *report = sum;
  return result;
}

} // namespace patina
