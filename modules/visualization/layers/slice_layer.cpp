#include "visualization/layers/slice_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkImageData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "field/store/node_reader.h"
#include "scene/painted_value.h"
#include "visualization/values/distance_map.h"
#include "visualization/values/palette.h"
#include "visualization/values/scalar_bar.h"

namespace patina {
namespace {

// VTK resamples a texture whose sides are no powers of two, and leaves notches where it rounds: of
// some four texels a cell, as many as give a power.
int texelsOver(int cells) {
  return 1 << std::clamp(std::lround(std::log2(4.0 * cells)), 2L, 13L);
}

// 1, 2 or 5 times a power of ten, so that at most `lines` of them fit in `length`.
double niceStep(double length, int lines) {
  const double raw = length / lines;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10 * power;
}

// How much of a texel a line covers: phi is a distance, so a line of constant width is a range of
// phi, and its edge is softened over one texel.
double coverage(double distance, double half_width, double texel) {
  return std::clamp((half_width - distance) / texel + 0.5, 0.0, 1.0);
}

struct Ink {
  vtkLookupTable* map;
  double voxel_mm, step_mm;
  double texel;    // voxels
  double shown;    // voxels: a little less than the band, where every cell has all of its nodes
  double edge = 0; // voxels, of the tinted band; 0 = none
  palette::Color tint{};
  std::optional<SliceMaterial> material{};

  // At `place` [m].
  void paint(double phi_voxels, const Vec3& place, unsigned char* rgba) const {
    const double mm = phi_voxels * voxel_mm;
    std::array<double, 3> color{};
    if (material) {
      const PaintedValue value = paintedValue(*material->scene, material->channel, place);
      // Little paint is seen as paint; the rim is softened.
      const double cover = std::clamp(8 * value.weight, 0.0, 1.0);
      const unsigned char* of_value = material->colors->MapValue(value.felt);
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

struct Corners {
  Vec3 origin, across, up; // [m]; the plane's whole sides
};

vtkSmartPointer<vtkImageData> painted(const FieldPlane& plane, const Corners& corners,
                                      const Ink& ink) {
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
                  corners.origin + (x + 0.5) / width * corners.across +
                      (y + 0.5) / height * corners.up,
                  rgba);
      else
        std::fill(rgba, rgba + 4, static_cast<unsigned char>(0));
    }
  return image;
}

} // namespace

FieldPlane planeOf(const SurfaceField& field, const SlicePlace& place) {
  const auto along = static_cast<std::size_t>(place.axis);
  const std::size_t across = (along + 1) % 3, up = (along + 2) % 3;
  const int last_cell = std::max(0, field.grid.nodes[along] - 2);
  const double q = std::clamp(place.position, 0.0, 1.0) * (field.grid.nodes[along] - 1);
  const int below = std::clamp(static_cast<int>(q), 0, last_cell);
  const auto weight = static_cast<float>(q - below);

  FieldPlane plane;
  plane.columns = field.grid.nodes[across];
  plane.rows = field.grid.nodes[up];
  plane.phi.reserve(static_cast<std::size_t>(plane.columns) * static_cast<std::size_t>(plane.rows));
  const NodeReader nodes(field);
  std::array<int, 3> node{};
  for (node[up] = 0; node[up] < plane.rows; ++node[up])
    for (node[across] = 0; node[across] < plane.columns; ++node[across]) {
      node[along] = below;
      const float low = nodes.phiAt(node[0], node[1], node[2]);
      node[along] = below + 1;
      const float high = nodes.phiAt(node[0], node[1], node[2]);
      const bool stored = std::abs(low) < kBeyondBand && std::abs(high) < kBeyondBand;
      plane.phi.push_back(stored ? (1 - weight) * low + weight * high
                                 : std::numeric_limits<float>::quiet_NaN());
    }
  return plane;
}

SliceLayer::SliceLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : quad_(vtkSmartPointer<vtkPlaneSource>::New()), texture_(vtkSmartPointer<vtkTexture>::New()),
      actor_(vtkSmartPointer<vtkActor>::New()), bar_(scalarBar("distance [mm]")),
      plane_(vtkSmartPointer<vtkPlane>::New()) {
  quad_->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(quad_->GetOutputPort());
  actor_->SetMapper(mapper);
  actor_->SetTexture(texture_);
  actor_->GetProperty()->LightingOff();
  texture_->InterpolateOn();
  texture_->MipmapOn();
  scene.AddActor(actor_);

  overlay.AddActor2D(bar_);
  setVisible(false);
}

void SliceLayer::update(const SurfaceField& field, const SlicePlace& place,
                        const std::optional<TouchBand>& band,
                        const std::optional<SliceMaterial>& material) {
  const auto along = static_cast<std::size_t>(place.axis);
  const FieldGrid& grid = field.grid;
  Vec3 corner = Vec3::Zero();
  corner[place.axis] = std::clamp(place.position, 0.0, 1.0) * (grid.nodes[along] - 1);
  Vec3 across = corner, up = corner;
  across[(place.axis + 1) % 3] = grid.nodes[(along + 1) % 3] - 1;
  up[(place.axis + 2) % 3] = grid.nodes[(along + 2) % 3] - 1;
  quad_->SetOrigin(grid.toWorld(corner).data());
  quad_->SetPoint1(grid.toWorld(across).data());
  quad_->SetPoint2(grid.toWorld(up).data());
  plane_->SetOrigin(grid.toWorld(corner).data());
  position_ = grid.toWorld(corner)[place.axis];
  Vec3 normal = Vec3::Unit(place.axis);
  plane_->SetNormal(normal.data());

  const double voxel_mm = 1000 * grid.voxel;
  const double limit_mm = field.band * voxel_mm;
  const auto map = distanceMap(limit_mm);
  const int cells = grid.nodes[(along + 1) % 3] - 1;
  Ink ink{.map = map,
          .voxel_mm = voxel_mm,
          .step_mm = niceStep(limit_mm, 4),
          .texel = static_cast<double>(cells) / texelsOver(cells),
          .shown = std::max(0.6 * field.band, field.band - 1.75)};
  if (band && isStored(*band, field)) {
    ink.edge = band->edge / grid.voxel;
    ink.tint = bandColor(*band);
  }
  ink.material = material;
  shows_distance_ = !material;
  const Vec3 origin = grid.toWorld(corner);
  texture_->SetInputData(painted(planeOf(field, place),
                                 {origin, grid.toWorld(across) - origin, grid.toWorld(up) - origin},
                                 ink));
  bar_->SetLookupTable(map);
  bar_->SetLabelFormat(limit_mm < 1 ? "%.2f" : limit_mm < 50 ? "%.1f" : "%.0f");
}

void SliceLayer::setVisible(bool on) {
  // Before the first update() a window system may want a frame: VTK fails on a texture of nothing.
  const bool made = texture_->GetNumberOfInputConnections(0) > 0;
  actor_->SetVisibility(on && made);
  bar_->SetVisibility(on && made && shows_distance_);
}

} // namespace patina
