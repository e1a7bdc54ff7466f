#include "authoring/brush/painter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "authoring/brush/dab_image.h"
#include "authoring/brush/volume_fill.h"
#include "core/error.h"
#include "geometry/mesh/combined_mesh.h"

namespace patina {
namespace {

constexpr double kRadiusSeconds = 0.05;
constexpr double kMaxDabsAVoxel = 64;
constexpr double kFarthest = 1e9;      // [voxel], beyond it steps are lost in rounding
constexpr double kMaxDabsARadius = 32; // per radius of the wider end, if the radius falls to 0

struct Interval {
  double from = 0, to = 1;
};

// Returns the part of the segment from a to b inside the grid; empty if from > to.
Interval within(const FieldGrid& grid, const Vec3& a, const Vec3& b) {
  Interval part;
  const Vec3 start = grid.toGrid(a), way = grid.toGrid(b) - start;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = -1, high = grid.nodes[static_cast<std::size_t>(axis)];
    if (way[axis] == 0) {
      if (!(start[axis] >= low && start[axis] <= high)) return {1, 0};
      continue;
    }
    double first = (low - start[axis]) / way[axis], last = (high - start[axis]) / way[axis];
    if (first > last) std::swap(first, last);
    part.from = std::max(part.from, first);
    part.to = std::min(part.to, last);
  }
  return part;
}

} // namespace

std::vector<PathStep> StrokePath::advanceTo(const StrokeSample& sample) {
  reached_ = false;
  const bool finite = sample.position.allFinite() && std::isfinite(sample.force) &&
                      std::isfinite(sample.t) && (!sample.tip || sample.tip->allFinite());
  if (!finite || grid_.toGrid(sample.position).cwiseAbs().maxCoeff() > kFarthest) return {};
  const double target = brushRadius(brush_, sample.force);
  if (!last_) {
    last_ = sample;
    radius_ = target;
    reached_ = true;
    return {{sample.position, radius_, false, sample.tip}};
  }
  const StrokeSample from = *last_;
  const double radius = radius_;
  const double seconds = std::max(0.0, sample.t - from.t);
  radius_ += (target - radius) * -std::expm1(-seconds / kRadiusSeconds);
  last_ = sample;

  const Vec3 way = sample.position - from.position;
  const double step =
      std::max({std::min(radius, radius_) / 4, std::max(radius, radius_) / kMaxDabsARadius,
                grid_.voxel / kMaxDabsAVoxel});
  // Prevents an extra step by rounding above an integer.
  const double count = std::max(1.0, std::ceil(way.norm() / step - 1e-9));
  const Interval known = within(grid_, from.position, sample.position);
  std::vector<PathStep> steps;
  if (!(known.from <= known.to)) return steps;
  const double first = std::max(1.0, std::ceil(known.from * count));
  const double last = std::min(count, std::floor(known.to * count));
  for (double k = first; k <= last; ++k) {
    const double t = k / count;
    steps.push_back(
        {from.position + t * way, radius + t * (radius_ - radius), k > first || k == 1});
    if (from.tip && sample.tip) steps.back().tip = *from.tip + t * (*sample.tip - *from.tip);
  }
  reached_ = last == count && first <= last;
  if (!reached_) return steps;
  steps.back().position = sample.position;
  steps.back().tip = sample.tip;
  return steps;
}

// Properties of a stroke common to all objects.
struct StrokeTask {
  Brush brush;
  Material base;            // unpainted values
  double relief_height = 0; // [m] at an image value of 1
};

class ObjectStroke {
 public:
  // start: null = unpainted.
  ObjectStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
               std::shared_ptr<const ObjectPaint> start, const StrokeTask& task);

  // faces: this object's, in the combined mesh. Adds texels and nodes to the report.
  void paint(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report);
  // Returns the current paint, or null if unpainted. The same pointer until something changes.
  std::shared_ptr<const ObjectPaint> paint();
  void finish();                     // drops parts that the eraser has emptied
  void collect(PaintChange& change); // adds the parts written since the last call

 private:
  std::shared_ptr<const PaintSurface> surface_;
  std::size_t object_;
  Brush brush_;
  std::shared_ptr<const ObjectPaint> paint_;
  std::optional<ImageStroke> color_, relief_;
  std::optional<MaterialStroke> material_;
};

namespace {

bool erases(const Brush& brush, Tool tool) {
  return brush.tool == Tool::erase && (brush.erases.empty() || brush.erases == name(tool));
}

std::vector<MaterialInk> inksOf(const Brush& brush, const MaterialMap* map) {
  std::vector<MaterialInk> inks;
  for (const BrushLayer& layer : layersOf(brush))
    if (const std::optional<MaterialChannel> channel = channelOf(layer.tool))
      inks.push_back({*channel, layer.value});
  for (const MaterialChannel channel : kAllMaterialChannels)
    if (map && erases(brush, Tool::material(channel)) && map->has(channel))
      inks.push_back({channel, 0});
  return inks;
}

template <typename T> void join(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

// Returns true if the brush changes images of an object with this paint (null = unpainted).
bool changesImages(const Brush& brush, const ObjectPaint* paint) {
  return layerOf(brush, Tool::color) || layerOf(brush, Tool::relief) ||
         (paint && ((paint->color && erases(brush, Tool::color)) ||
                    (paint->relief && erases(brush, Tool::relief))));
}

} // namespace

ObjectStroke::ObjectStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                           std::shared_ptr<const ObjectPaint> start, const StrokeTask& task)
    : surface_(std::move(surface)), object_(object), brush_(task.brush), paint_(std::move(start)) {
  static const ObjectPaint kBare{};
  const ObjectPaint& paint = paint_ ? *paint_ : kBare;
  if (const BrushLayer* layer = layerOf(brush_, Tool::color)) {
    const auto& [red, green, blue] = layer->color;
    color_.emplace(surface_, object, paint.color, kColorChannels,
                   Ink{{red, green, blue, 1}, false});
  } else if (paint.color && erases(brush_, Tool::color)) {
    color_.emplace(surface_, object, paint.color, kColorChannels, Ink{{}, true});
  }
  if (const BrushLayer* layer = layerOf(brush_, Tool::relief))
    relief_.emplace(surface_, object, paint.relief, 1,
                    Ink{{layer->value / task.relief_height, 0, 0, 0}, false});
  else if (paint.relief && erases(brush_, Tool::relief))
    relief_.emplace(surface_, object, paint.relief, 1, Ink{{}, true});
  std::vector<MaterialInk> inks = inksOf(brush_, paint.material.get());
  if (!inks.empty())
    material_.emplace(surface_, object, paint.material, task.base, std::move(inks));
}

void ObjectStroke::paint(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report) {
  if (color_) report.texels += color_->paint(dab, brush_, faces);
  if (relief_) report.texels += relief_->paint(dab, brush_, faces);
  if (material_) report.nodes += material_->paint(dab, brush_);
}

std::shared_ptr<const ObjectPaint> ObjectStroke::paint() {
  const auto changed = [](const auto& part) { return part && part->changed(); };
  if (!changed(color_) && !changed(relief_) && !changed(material_)) return paint_;
  auto next = std::make_shared<ObjectPaint>(paint_ ? *paint_ : ObjectPaint{});
  if (changed(color_)) next->color = color_->take();
  if (changed(relief_)) next->relief = relief_->take();
  if (changed(material_)) next->material = material_->take();
  const bool images = next->color || next->relief;
  if (!images) next->layout = {};
  if (images && !next->layout.uvs) next->layout = surface_->objects[object_].layout;
  paint_ = images || next->material || next->textures ? std::move(next) : nullptr;
  return paint_;
}

void ObjectStroke::finish() {
  if (brush_.tool != Tool::erase) return;
  if (color_) color_->dropEmpty();
  if (relief_) relief_->dropEmpty();
  if (material_) material_->dropEmpty();
}

void ObjectStroke::collect(PaintChange& change) {
  if (color_) {
    change.images |= color_->takeWritten();
  }
  if (relief_) {
    change.images |= relief_->takeWritten();
  }
  if (material_) {
    join(change.material_blocks, material_->takeBlocks());
  }
}

namespace {

// Returns true for modes that weight each point once; these sweep along the path to leave no
// ripples.
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
  std::vector<PaintChange> changes; // per object, from finished strokes
  StrokeTask task;
  std::optional<StrokePath> path;                   // absent between strokes
  std::vector<std::optional<ObjectStroke>> strokes; // made at first contact
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
  for (const PathStep& step : impl_->path->advanceTo(sample)) hit = impl_->dab(step, report);
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
    if (change.images || !change.material_blocks.empty()) result.push_back(std::move(change));
  }
  return result;
}

// Paints a dab and its mirror image, which starts from the surface's own point, so that both sides
// are equal even if the tip is slightly off. Returns true if the surface is within the brush.
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
  if (task.brush.anchor == DabAnchor::segment && step.tip)
    if (const auto hit = fill.segmentHit(*step.tip, step.position)) return hit;
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
  // A jump of the foot point leads to another part of the surface.
  if (sweeps(task.brush) && last &&
      (foot->point - last->foot.point).norm() <= 0.5 * std::max(last->radius, radius)) {
    dab.from = last->foot.point;
    dab.radius_from = last->radius;
  }
  const auto faces = fill.fill(dab.centre(), dab.boundingRadius(), seed, dab.front);
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
  return static_cast<std::size_t>(objectOfFace(surface->objects, face, &PaintObject::first_face));
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
