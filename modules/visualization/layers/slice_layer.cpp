#include "visualization/layers/slice_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkImageData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "field/store/node_reader.h"
#include "scene/painted_value.h"
#include "scene/surface_pick.h"
#include "visualization/values/color_table.h"
#include "visualization/values/palette.h"
#include "visualization/values/scalar_bar.h"

namespace patina {
namespace {

// VTK resamples textures whose sides are not powers of two and leaves notches. Returns a power of
// two near four texels per cell.
int texelsOver(int cells) {
  return 1 << std::clamp(std::lround(std::log2(4.0 * cells)), 2L, 13L);
}

// Smallest 1, 2 or 5 times a power of ten such that at most `lines` steps fit into `length`.
double niceStep(double length, int lines) {
  const double raw = length / lines;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10 * power;
}

// Fraction of a texel that a line covers. phi is a distance, so a line of constant width is a range
// of phi; its edge is smoothed over one texel.
double coverage(double distance, double half_width, double texel) {
  return std::clamp((half_width - distance) / texel + 0.5, 0.0, 1.0);
}

// Largest |phi| that is drawn [voxels]: every cell has all its nodes there.
// A texel of a plane at an angle to the grid needs nodes that are farther away.
double shownReach(const SurfaceField& field, const Vec3& normal) {
  const bool at_angle = normal.cwiseAbs().maxCoeff() < 1 - 1e-9;
  return std::max(0.6 * field.band, field.band - (at_angle ? 3.2 : 1.75));
}

struct Ink {
  vtkLookupTable* map;
  double voxel_mm, step_mm;
  double texel = 1; // voxels
  double shown = 0; // voxels; slightly below the band, where every cell has all its nodes
  double edge = 0;  // voxels, edge of the tinted band; 0 = none
  palette::Color tint{};
  std::optional<SliceMaterial> material{};

  void paint(double phi_voxels, const Vec3& place, unsigned char* rgba) const {
    const double mm = phi_voxels * voxel_mm;
    std::array<double, 3> color{};
    if (material) {
      const PaintedValue value = paintedValue(*material->scene, material->channel, place);
      // Thin paint is visible at full colour; its edge is smoothed.
      const double cover = std::clamp(8 * value.weight, 0.0, 1.0);
      const unsigned char* of_value = material->colors->MapValue(value.value);
      for (std::size_t c = 0; c < 3; ++c)
        color[c] = cover * of_value[c] + (1 - cover) * 255 * palette::kLight.low[c];
    } else {
      const unsigned char* of_distance = map->MapValue(mm);
      std::copy(of_distance, of_distance + 3, color.begin());
    }
    const double to_line = std::abs(mm - step_mm * std::round(mm / step_mm)) / voxel_mm;
    const double thin = 0.35 * coverage(to_line, 0.10, texel);
    const double thick = 0.90 * coverage(std::abs(phi_voxels), 0.28, texel);
    const double dark = std::max(thin, thick);
    const double at_edge = edge > 0 ? coverage(std::abs(phi_voxels - edge), 0.24, texel) : 0;
    const double within = edge > 0 && phi_voxels > 0 && phi_voxels < edge ? 0.5 : 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      double value = color[channel] * (1 - within) + 255 * tint[channel] * within;
      value = value * (1 - dark) + 255 * palette::kText[channel] * dark;
      value = value * (1 - at_edge) + 255 * 0.62 * tint[channel] * at_edge;
      rgba[channel] = static_cast<unsigned char>(std::lround(value));
    }
    rgba[3] =
        static_cast<unsigned char>(std::lround(255 * coverage(std::abs(phi_voxels), shown, texel)));
  }
};

// Interpolates linearly at grid coordinates; NaN if a node that counts is not stored.
float valueAt(const NodeReader& nodes, const Vec3& q) {
  const Vec3 low = q.array().floor();
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<int, 3> node{};
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = corner >> axis & 1;
      node[static_cast<std::size_t>(axis)] = static_cast<int>(low[axis]) + step;
      weight *= step == 1 ? q[axis] - low[axis] : 1 - (q[axis] - low[axis]);
    }
    if (weight < 1e-9) continue;
    const float phi = nodes.phiAt(node[0], node[1], node[2]);
    if (std::abs(phi) >= kBackground) return std::numeric_limits<float>::quiet_NaN();
    sum += weight * phi;
  }
  return static_cast<float>(sum);
}

// Distances that the plane shows, up to `shown` [voxels], ascending [m].
std::vector<double> shownDistances(const FieldPlane& plane, double voxel, double shown) {
  std::vector<double> distances;
  for (const float phi : plane.phi)
    if (std::abs(static_cast<double>(phi)) < shown)
      distances.push_back(voxel * static_cast<double>(phi));
  std::sort(distances.begin(), distances.end());
  return distances;
}

vtkSmartPointer<vtkImageData> painted(const FieldPlane& plane, const Ink& ink) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  const int columns = plane.columns - 1, rows = plane.rows - 1; // cells
  const int width = texelsOver(columns), height = texelsOver(rows);
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  auto* rgba = static_cast<unsigned char*>(image->GetScalarPointer());
  const auto node = [&](int column, int row) {
    return static_cast<double>(
        plane.phi[static_cast<std::size_t>(row) * static_cast<std::size_t>(plane.columns) +
                  static_cast<std::size_t>(column)]);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, rgba += 4) {
      const double across = (x + 0.5) / width * columns, up = (y + 0.5) / height * rows;
      const int column = static_cast<int>(across), row = static_cast<int>(up);
      const double u = across - column, v = up - row;
      const double phi = (1 - v) * ((1 - u) * node(column, row) + u * node(column + 1, row)) +
                         v * ((1 - u) * node(column, row + 1) + u * node(column + 1, row + 1));
      if (std::isfinite(phi))
        ink.paint(phi,
                  plane.origin + (x + 0.5) / width * plane.across + (y + 0.5) / height * plane.up,
                  rgba);
      else
        std::fill(rgba, rgba + 4, static_cast<unsigned char>(0));
    }
  return image;
}

} // namespace

Box3 boxOf(const FieldGrid& grid) {
  const Vec3 last(grid.nodes[0] - 1, grid.nodes[1] - 1, grid.nodes[2] - 1);
  return Box3(grid.origin, grid.toWorld(last));
}

ValueRange rangeOf(const FieldGrid& grid, const Vec3& normal) {
  const Box3 box = boxOf(grid);
  const double middle = normal.dot(box.center());
  const double half = 0.5 * normal.cwiseAbs().dot(box.sizes());
  return {middle - half, middle + half};
}

SlicePosition within(const FieldGrid& grid, SlicePosition place) {
  const ValueRange range = rangeOf(grid, place.normal);
  place.position =
      std::clamp(place.position.value_or((range.low + range.high) / 2), range.low, range.high);
  return place;
}

FieldPlane planeOf(const SurfaceField& field, const SlicePosition& place) {
  const FieldGrid& grid = field.grid;
  FieldPlane plane;
  plane.normal = place.normal;
  int along = 0;
  place.normal.cwiseAbs().maxCoeff(&along);
  const Vec3 axis = Vec3::Unit((along + 1) % 3);
  const Vec3 across = (axis - axis.dot(place.normal) * place.normal).normalized();
  const Vec3 up = place.normal.cross(across);
  const auto points = [&](const ValueRange& range) {
    return 1 +
           std::max(1, static_cast<int>(std::ceil((range.high - range.low) / grid.voxel - 1e-6)));
  };
  const ValueRange wide = rangeOf(grid, across), high = rangeOf(grid, up);
  plane.columns = points(wide);
  plane.rows = points(high);
  plane.origin = wide.low * across + high.low * up + *within(grid, place).position * place.normal;
  plane.across = (plane.columns - 1) * grid.voxel * across;
  plane.up = (plane.rows - 1) * grid.voxel * up;
  plane.phi.reserve(static_cast<std::size_t>(plane.columns) * static_cast<std::size_t>(plane.rows));
  const NodeReader nodes(field);
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const Vec3 q = grid.toGrid(plane.origin + grid.voxel * (column * across + row * up));
      // Rounding would turn nodes of the grid's end into nodes beyond it.
      const Vec3 node = q.array().round();
      plane.phi.push_back(valueAt(nodes, (q - node).cwiseAbs().maxCoeff() < 1e-6 ? node : q));
    }
  return plane;
}

std::vector<float> refinedValues(const FieldPlane& plane, int n) {
  std::vector<float> values;
  for (int row = 0; row + 1 < plane.rows; ++row)
    for (int column = 0; column + 1 < plane.columns; ++column) {
      const float* low = &plane.phi[static_cast<std::size_t>(row * plane.columns + column)];
      const float* high = low + plane.columns;
      if (!std::isfinite(low[0] + low[1] + high[0] + high[1])) continue;
      for (int i = 0; i < n * n; ++i) {
        const auto u = (static_cast<float>(i % n) + 0.5F) / static_cast<float>(n);
        const auto v = (static_cast<float>(i / n) + 0.5F) / static_cast<float>(n);
        values.push_back((1 - v) * ((1 - u) * low[0] + u * low[1]) +
                         v * ((1 - u) * high[0] + u * high[1]));
      }
    }
  return values;
}

SliceLayer::Plane::Plane(vtkRenderer& scene)
    : quad(vtkSmartPointer<vtkPlaneSource>::New()), texture(vtkSmartPointer<vtkTexture>::New()),
      actor(vtkSmartPointer<vtkActor>::New()), cut(vtkSmartPointer<vtkPlane>::New()) {
  quad->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(quad->GetOutputPort());
  actor->SetMapper(mapper);
  actor->SetTexture(texture);
  actor->GetProperty()->LightingOff();
  texture->InterpolateOn();
  texture->MipmapOn();
  scene.AddActor(actor);
}

ClipPlane SliceLayer::Plane::seenFrom(const Vec3& eye) const {
  const Vec3 origin(quad->GetOrigin()), normal(quad->GetNormal());
  return {origin, (eye - origin).dot(normal) < 0 ? Vec3(-normal) : normal};
}

SliceLayer::SliceLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : bar_(scalarBar("distance [mm]")) {
  for (std::size_t i = 0; i < kMaxSlices; ++i) planes_.emplace_back(scene);
  overlay.AddActor2D(bar_);
  setVisible(false);
}

void SliceLayer::update(const SurfaceField& field, const Slices& places,
                        const std::optional<TouchBand>& band,
                        const std::optional<SliceMaterial>& material, const ColorScale& scale) {
  const FieldGrid& grid = field.grid;
  std::array<FieldPlane, kMaxSlices> values;
  std::vector<double> distances; // ascending, for a percentile
  for (std::size_t i = 0; i < kMaxSlices; ++i) {
    Plane& plane = planes_[i];
    plane.is_there = i == 0 || places[i];
    if (!plane.is_there) continue;
    values[i] = planeOf(field, places[i].value_or(SlicePosition{}));
    plane.shown = shownReach(field, values[i].normal);
    if (!scale.percentile) continue;
    const auto more = shownDistances(values[i], grid.voxel, plane.shown);
    const auto middle = distances.insert(distances.end(), more.begin(), more.end());
    std::inplace_merge(distances.begin(), middle, distances.end());
  }
  const double voxel_mm = 1000 * grid.voxel;
  const double limit_mm = field.band * voxel_mm;
  range_ = shownRange(scale, {-1e-3 * limit_mm, 1e-3 * limit_mm}, distances);
  const auto map = colorTable(scale, StandardMap::diverging, {1e3 * range_.low, 1e3 * range_.high});
  const double reach_mm =
      std::min(limit_mm, 1e3 * std::max(std::abs(range_.low), std::abs(range_.high)));
  Ink ink{.map = map,
          .voxel_mm = voxel_mm,
          // Lines nearer than a voxel would cover the colours.
          .step_mm = niceStep(std::max(reach_mm, 4 * voxel_mm), 4)};
  if (band && isStored(*band, field)) {
    ink.edge = band->edge / grid.voxel;
    ink.tint = bandColor(*band);
  }
  ink.material = material;
  const bool several = places[1] || places[2];
  for (std::size_t i = 0; i < kMaxSlices; ++i) {
    Plane& plane = planes_[i];
    if (!plane.is_there) continue;
    const FieldPlane& at = values[i];
    plane.quad->SetOrigin(at.origin.x(), at.origin.y(), at.origin.z());
    Vec3 corner = at.origin + at.across;
    plane.quad->SetPoint1(corner.data());
    corner = at.origin + at.up;
    plane.quad->SetPoint2(corner.data());
    const int cells = at.columns - 1;
    ink.texel = static_cast<double>(cells) / texelsOver(cells);
    ink.shown = plane.shown;
    plane.texture->SetInputData(painted(at, ink));
    plane.actor->GetProperty()->SetOpacity(scale.opacity.value_or(1));
    // Its transparent edge makes VTK draw the plane as translucent, which hides no other plane.
    plane.actor->SetForceOpaque(several && scale.opacity.value_or(1) == 1);
  }
  shows_distance_ = !material;
  bar_->SetLookupTable(map);
  bar_->SetLabelFormat(labelFormat(scale, reach_mm < 1    ? "%.2f"
                                          : reach_mm < 50 ? "%.1f"
                                                          : "%.0f")
                           .c_str());
}

std::vector<vtkPlane*> SliceLayer::cuts() {
  std::vector<vtkPlane*> cuts;
  for (Plane& plane : planes_)
    if (plane.is_there) cuts.push_back(plane.cut);
  return cuts;
}

bool SliceLayer::turnCuts(const Vec3& eye, const SurfaceField& field) {
  bool turned = false;
  for (Plane& plane : planes_) {
    const ClipPlane seen = plane.seenFrom(eye);
    const bool positive = seen.normal.dot(Vec3(plane.quad->GetNormal())) < 0;
    turned = turned || (plane.is_there && positive != plane.keeps_positive);
    plane.keeps_positive = positive;
    Vec3 inward = -seen.normal;
    plane.cut->SetNormal(inward.data());
    // Slightly behind the slice, because cut edges would otherwise show through its lines.
    Vec3 origin = seen.origin + 0.35 * field.grid.voxel * inward;
    plane.cut->SetOrigin(origin.data());
  }
  return turned;
}

bool SliceLayer::hides(const Vec3& point, const Vec3& eye) const {
  return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    const ClipPlane seen = plane.seenFrom(eye);
    return plane.is_there && (point - seen.origin).dot(seen.normal) > 0;
  });
}

std::optional<SliceLayer::Hit> SliceLayer::hitAlong(const SurfaceField& field, const Vec3& eye,
                                                    const Ray& ray,
                                                    std::optional<Ray>& beyond) const {
  std::optional<Hit> first;
  beyond = ray;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!planes_[i].is_there) continue;
    const ClipPlane plane = planes_[i].seenFrom(eye);
    const auto part = behind(plane, ray);
    if (beyond) beyond = behind(plane, *beyond);
    const bool crosses = part && part->origin != ray.origin;
    const auto depth = [&](const Vec3& point) { return (point - ray.origin).dot(ray.direction); };
    if (!crosses || (first && depth(first->point) < depth(part->origin))) continue;
    if (std::abs(distanceAt(field, part->origin)) < planes_[i].shown * field.grid.voxel)
      first = Hit{i, part->origin};
  }
  return first;
}

void SliceLayer::setVisible(bool on) {
  // A window system may draw a frame before the first update(), and VTK fails on an empty texture.
  for (Plane& plane : planes_)
    plane.actor->SetVisibility(on && plane.is_there && plane.has_picture());
  bar_->SetVisibility(on && planes_.front().has_picture() && shows_distance_);
}

} // namespace patina
