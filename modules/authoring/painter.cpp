#include "authoring/painter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "authoring/dab_image.h"
#include "authoring/dab_material.h"
#include "authoring/volume_fill.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kRadiusSeconds = 0.05; // of the low-pass that takes the force's noise away (K19)
// Dabs are a quarter of the radius apart, but not more than so many a voxel: a needle of a brush
// would never come to an end.
constexpr double kMostDabsAVoxel = 64;
constexpr double kMostDabsARadius = 32; // of the wider end, where the radius changes

bool paintsImages(const Brush& brush) {
  return brush.tool == Tool::color || brush.tool == Tool::relief;
}

bool erases(const Brush& brush, Tool tool) {
  return brush.tool == Tool::erase && (brush.erases.empty() || brush.erases == name(tool));
}

// Once at each place: along the path, so that no ripple is left between dabs.
bool sweeps(const Brush& brush) {
  return brush.mode == StrokeMode::max || brush.mode == StrokeMode::add;
}

struct Interval {
  double from = 0, to = 1;
};

// The part of the way from a to b that the field knows of; empty if from > to.
Interval within(const FieldGrid& grid, const Vec3& a, const Vec3& b) {
  Interval part;
  const Vec3 start = grid.toGrid(a), way = grid.toGrid(b) - start;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = -1, high = grid.nodes[static_cast<std::size_t>(axis)];
    double first = (low - start[axis]) / way[axis], last = (high - start[axis]) / way[axis];
    if (way[axis] == 0) {
      if (start[axis] < low || start[axis] > high) return {1, 0};
      continue;
    }
    if (first > last) std::swap(first, last);
    part.from = std::max(part.from, first);
    part.to = std::min(part.to, last);
  }
  return part;
}

} // namespace

struct Painter::Impl {
  struct ObjectStroke {
    std::optional<ImageStroke> color, relief;
    std::optional<MaterialStroke> material;
  };
  struct Touch {
    Vec3 foot;
    double radius;
  };
  struct Tip {
    StrokeSample sample;
    double radius = 0;
  };

  std::shared_ptr<const PaintSurface> surface;
  Material base;
  double relief_height;
  std::vector<std::shared_ptr<const ObjectPaint>> paint;
  std::vector<PaintChange> changes; // by object; those of strokes that have ended
  VolumeFill fill;

  Brush brush;
  bool active = false;
  std::vector<std::optional<ObjectStroke>> strokes; // made when the brush first touches the object
  std::optional<Tip> tip;                           // the last sample
  std::optional<Touch> touch, mirrored;             // the last dabs

  Impl(std::shared_ptr<const PaintSurface> s, const Scene& scene)
      : surface(std::move(s)), base(baseMaterial(scene.haptics)),
        relief_height(scene.relief.height), fill(surface) {}

  void dabAt(const Vec3& position, double radius, PaintReport& report, bool counts_misses);
  std::optional<Touch> stamp(const Vec3& position, double radius, const std::optional<Touch>& last,
                             PaintReport& report, std::size_t& seed_object);
  void apply(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report);
  ObjectStroke begun(std::size_t object) const;
  std::size_t objectOf(std::int32_t face) const;
  void publish();
  void collect(std::size_t object, ObjectStroke& stroke);
};

Painter::Painter(std::shared_ptr<const PaintSurface> surface, const Scene& scene) {
  if (!surface || surface->objects.size() != scene.objects.size())
    throw std::invalid_argument("Painter: not the surface of this scene");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const PaintObject& made = surface->objects[i];
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
  impl_ = std::make_unique<Impl>(std::move(surface), scene);
  for (const SceneObject& object : scene.objects) impl_->paint.push_back(object.paint);
  impl_->changes.resize(scene.objects.size());
  impl_->strokes.resize(scene.objects.size());
}

Painter::~Painter() = default;

void Painter::begin(const Brush& brush) {
  validate(brush);
  Impl& self = *impl_;
  if (brush.tool == Tool::relief && self.relief_height == 0)
    throw Error("relief.height is 0: no relief can be painted");
  end();
  bool needs_images = paintsImages(brush);
  for (const auto& paint : self.paint)
    needs_images |= paint && ((paint->color && erases(brush, Tool::color)) ||
                              (paint->relief && erases(brush, Tool::relief)));
  if (needs_images && !hasImages(*self.surface))
    throw std::invalid_argument("Painter: the surface has no images");
  self.brush = brush;
  self.active = true;
}

PaintReport Painter::dab(const StrokeSample& sample) {
  Impl& self = *impl_;
  if (!self.active) throw std::invalid_argument("Painter: no stroke has begun");
  PaintReport report;
  // A device that loses its place for a moment must not end the stroke.
  if (!sample.position.allFinite() || !std::isfinite(sample.force) || !std::isfinite(sample.t)) {
    report.missed = 1;
    return report;
  }
  Impl::Tip now{sample, brushRadius(self.brush, sample.force)};
  if (!self.tip) {
    self.tip = now;
    self.dabAt(sample.position, now.radius, report, true);
    return report;
  }
  const Impl::Tip last = *self.tip;
  const double seconds = std::max(0.0, sample.t - last.sample.t);
  now.radius = last.radius + (now.radius - last.radius) * -std::expm1(-seconds / kRadiusSeconds);
  self.tip = now;

  const FieldGrid& grid = self.surface->field->grid;
  const Vec3 way = sample.position - last.sample.position;
  const double step = std::max({std::min(last.radius, now.radius) / 4,
                                std::max(last.radius, now.radius) / kMostDabsARadius,
                                grid.voxel / kMostDabsAVoxel});
  const double count = std::max(1.0, std::ceil(way.norm() / step - 1e-9));
  const Interval known = within(grid, last.sample.position, sample.position);
  const double first = std::max(1.0, std::ceil(known.from * count));
  const double final = std::min(count, std::floor(known.to * count + 1));
  if (first > 1) self.touch = self.mirrored = std::nullopt;
  for (double k = first; k <= final; ++k) {
    const double t = k / count;
    self.dabAt(k == count ? sample.position : Vec3(last.sample.position + t * way),
               last.radius + t * (now.radius - last.radius), report, k == count);
  }
  if (!(final >= count)) {
    self.touch = self.mirrored = std::nullopt;
    report.missed = 1;
  }
  return report;
}

void Painter::end() {
  Impl& self = *impl_;
  if (!self.active) return;
  for (auto& stroke : self.strokes) {
    if (!stroke || self.brush.tool != Tool::erase) continue;
    if (stroke->color) stroke->color->dropEmpty();
    if (stroke->relief) stroke->relief->dropEmpty();
    if (stroke->material) stroke->material->dropEmpty();
  }
  self.publish();
  for (std::size_t i = 0; i < self.strokes.size(); ++i) {
    if (self.strokes[i]) self.collect(i, *self.strokes[i]);
    self.strokes[i].reset();
  }
  self.tip.reset();
  self.touch = self.mirrored = std::nullopt;
  self.active = false;
}

const std::vector<std::shared_ptr<const ObjectPaint>>& Painter::paint() const {
  impl_->publish();
  return impl_->paint;
}

std::vector<PaintChange> Painter::takeChanges() {
  Impl& self = *impl_;
  std::vector<PaintChange> result;
  for (std::size_t i = 0; i < self.changes.size(); ++i) {
    if (self.strokes[i]) self.collect(i, *self.strokes[i]);
    PaintChange change = std::move(self.changes[i]);
    self.changes[i] = {};
    change.object = i;
    if (!change.region.isEmpty()) result.push_back(std::move(change));
  }
  return result;
}

// A dab and its mirror image, which starts from the surface's own point: a tip that is a little
// off paints both sides alike.
void Painter::Impl::dabAt(const Vec3& position, double radius, PaintReport& report,
                          bool counts_misses) {
  std::size_t object = 0;
  touch = stamp(position, radius, touch, report, object);
  if (!touch) {
    mirrored.reset();
    if (counts_misses) ++report.missed;
    return;
  }
  if (brush.symmetry == Symmetry::none) return;
  const PaintObject& owner = surface->objects[object];
  const int axis = static_cast<int>(brush.symmetry) - static_cast<int>(Symmetry::x);
  Vec3 p = owner.world_from_object.inverse() * touch->foot;
  p[axis] = 2 * owner.middle[axis] - p[axis];
  mirrored = stamp(owner.world_from_object * p, radius, mirrored, report, object);
}

std::optional<Painter::Impl::Touch> Painter::Impl::stamp(const Vec3& position, double radius,
                                                         const std::optional<Touch>& last,
                                                         PaintReport& report,
                                                         std::size_t& seed_object) {
  if (!(radius > 0)) return std::nullopt;
  const std::optional<ClosestPoint> foot = fill.foot(position);
  if (!foot || !(foot->distance <= radius)) return std::nullopt;
  seed_object = objectOf(foot->surface.face);
  const Touch now{foot->point, radius};
  Dab dab{now.foot, now.foot, radius, radius};
  // A foot that leaps went to another part of the surface.
  const bool near = last && (now.foot - last->foot).norm() <= 0.5 * std::max(last->radius, radius);
  if (near && sweeps(brush)) {
    dab.from = last->foot;
    dab.radius_from = last->radius;
  }
  const auto seed = static_cast<std::size_t>(foot->surface.face);
  const Vec3 front = brush.front_only ? faceNormal(*surface->mesh, seed) : Vec3::Zero();
  const auto faces = fill.fill(dab.centre(), dab.reach(), foot->surface.face, front);
  ++report.dabs;
  report.faces += faces.size();
  apply(dab, faces, report);
  return now;
}

void Painter::Impl::apply(const Dab& dab, std::span<const std::int32_t> faces,
                          PaintReport& report) {
  for (std::size_t first = 0; first < faces.size();) {
    const std::size_t object = objectOf(faces[first]);
    const PaintObject& owner = surface->objects[object];
    const auto end = std::lower_bound(
        faces.begin() + static_cast<std::ptrdiff_t>(first), faces.end(), 0,
        [&](std::int32_t face, int) { return face < owner.first_face + owner.faces; });
    const auto count = static_cast<std::size_t>(end - faces.begin()) - first;
    const auto own = faces.subspan(first, count);
    first += count;
    if (!strokes[object]) strokes[object].emplace(begun(object));
    ObjectStroke& stroke = *strokes[object];
    if (stroke.color) report.texels += stroke.color->paint(dab, brush, own);
    if (stroke.relief) report.texels += stroke.relief->paint(dab, brush, own);
    if (stroke.material) report.nodes += stroke.material->paint(dab, brush);
  }
}

Painter::Impl::ObjectStroke Painter::Impl::begun(std::size_t object) const {
  ObjectStroke stroke;
  static const ObjectPaint kNone{};
  const ObjectPaint& start = paint[object] ? *paint[object] : kNone;
  const Ink ink{.erases = true};
  if (brush.tool == Tool::color)
    stroke.color.emplace(surface, object, start.color, kColorChannels,
                         Ink{{brush.color[0], brush.color[1], brush.color[2], 1}, false});
  else if (start.color && erases(brush, Tool::color))
    stroke.color.emplace(surface, object, start.color, kColorChannels, ink);
  if (brush.tool == Tool::relief)
    stroke.relief.emplace(surface, object, start.relief, 1,
                          Ink{{brush.value / relief_height, 0, 0, 0}, false});
  else if (start.relief && erases(brush, Tool::relief))
    stroke.relief.emplace(surface, object, start.relief, 1, ink);

  std::vector<MaterialChannel> channels;
  for (int t = 0; t < static_cast<int>(Tool::erase); ++t) {
    const auto tool = static_cast<Tool>(t);
    const std::optional<MaterialChannel> channel = channelOf(tool);
    if (!channel) continue;
    const bool erased = erases(brush, tool) && start.material && start.material->has(*channel);
    if (tool == brush.tool || erased) channels.push_back(*channel);
  }
  if (!channels.empty())
    stroke.material.emplace(surface, object, start.material, base, std::move(channels));
  return stroke;
}

std::size_t Painter::Impl::objectOf(std::int32_t face) const {
  std::size_t object = 0;
  while (object + 1 < surface->objects.size() && face >= surface->objects[object + 1].first_face)
    ++object;
  return object;
}

void Painter::Impl::publish() {
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (!strokes[i]) continue;
    ObjectStroke& stroke = *strokes[i];
    const bool changed = (stroke.color && stroke.color->changed()) ||
                         (stroke.relief && stroke.relief->changed()) ||
                         (stroke.material && stroke.material->changed());
    if (!changed) continue;
    auto next = std::make_shared<ObjectPaint>(paint[i] ? *paint[i] : ObjectPaint{});
    if (stroke.color && stroke.color->changed()) next->color = stroke.color->take();
    if (stroke.relief && stroke.relief->changed()) next->relief = stroke.relief->take();
    if (stroke.material && stroke.material->changed()) next->material = stroke.material->take();
    const bool images = next->color || next->relief;
    if (!images) next->layout = {};
    if (images && !next->layout.uvs) next->layout = surface->objects[i].layout;
    paint[i] = images || next->material ? std::move(next) : nullptr;
  }
}

void Painter::Impl::collect(std::size_t object, ObjectStroke& stroke) {
  PaintChange& change = changes[object];
  const auto join = [](auto& all, const auto& more) {
    all.insert(all.end(), more.begin(), more.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  if (stroke.color) {
    join(change.color_tiles, stroke.color->takeTiles());
    change.region.extend(stroke.color->takeRegion());
  }
  if (stroke.relief) {
    join(change.relief_tiles, stroke.relief->takeTiles());
    change.region.extend(stroke.relief->takeRegion());
  }
  if (stroke.material) {
    join(change.material_blocks, stroke.material->takeBlocks());
    change.region.extend(stroke.material->takeRegion());
  }
}

Scene painted(std::shared_ptr<const PaintSurface> surface, const Scene& scene, const Stroke& stroke,
              PaintReport* report) {
  validate(stroke);
  Painter painter(std::move(surface), scene);
  painter.begin(stroke.brush);
  PaintReport sum;
  for (const StrokeSample& sample : stroke.samples) {
    const PaintReport one = painter.dab(sample);
    sum.dabs += one.dabs;
    sum.faces += one.faces;
    sum.texels += one.texels;
    sum.nodes += one.nodes;
    sum.missed += one.missed;
  }
  painter.end();
  Scene result = scene;
  for (std::size_t i = 0; i < result.objects.size(); ++i)
    result.objects[i].paint = painter.paint()[i];
  if (report) *report = sum;
  return result;
}

} // namespace patina
