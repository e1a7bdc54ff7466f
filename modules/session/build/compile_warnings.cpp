#include "session/build/compile_warnings.h"

#include <algorithm>
#include <cmath>

#include "core/numbers.h"
#include "field/sampling/field_sampler.h"

namespace patina {
namespace {

constexpr std::size_t kMostProbes = 50'000;
constexpr double kProbeDepth = 0.5; // voxels
constexpr double kToldShare = 0.01; // of the area; slivers beside sharp edges are less
constexpr double kLargestScene = 2; // [m]

} // namespace

double vanishedShare(const CompiledScene& compiled) {
  const HapticProperties& haptics = compiled.scene.haptics;
  const SurfaceField& field = *compiled.built.field;
  const double iso = haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
  if (iso >= field.grid.voxel || compiled.mesh_report.boundary_edges > 0) return 0;
  const FieldSampler sampler(field, compiled.scene.sampler);
  const TriangleMesh& mesh = *compiled.mesh;
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kMostProbes);
  double all = 0, vanished = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    const auto corner = [&](int k) -> const Vec3& {
      return mesh
          .positions[static_cast<std::size_t>(mesh.triangles[i][static_cast<std::size_t>(k)])];
    };
    const Vec3 across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const double twice_area = across.norm();
    if (!(twice_area > 0) || !std::isfinite(twice_area)) continue;
    all += twice_area;
    const Vec3 centre = field.grid.toGrid((corner(0) + corner(1) + corner(2)) / 3);
    const Vec3 aside = kProbeDepth / twice_area * across;
    // Whichever way the triangle is turned, one side of it is the inside.
    if (std::min(sampler.phiAtGrid(centre + aside), sampler.phiAtGrid(centre - aside)) >= 0)
      vanished += twice_area;
  }
  return all > 0 ? vanished / all : 0;
}

std::vector<std::string> compileWarnings(const CompiledScene& compiled) {
  std::vector<std::string> lines;
  const double share = vanishedShare(compiled);
  if (share > kToldShare) {
    lines.push_back(formatNumber(std::round(100 * share)) + " %" +
                    " of the surface belongs to parts thinner than a voxel (" +
                    formatLength(compiled.built.field->grid.voxel) +
                    "), which are not felt: set a smaller voxel, an offset or a tip radius");
  }
  const std::optional<Magnet>& magnet = compiled.scene.haptics.magnet;
  if (magnet && magnet->range * magnet->strength == 0)
    lines.push_back(magnet->range > 0 ? "magnet.range has no effect without magnet.strength"
                                      : "magnet.strength has no effect without magnet.range");
  bool posed = false;
  for (const SceneObject& object : compiled.scene.objects)
    posed |= !object.world_from_object.matrix().isIdentity(0.0);
  const FieldGrid& grid = compiled.built.field->grid;
  const double size = (*std::max_element(grid.nodes.begin(), grid.nodes.end()) - 1) * grid.voxel;
  if (posed && size > kLargestScene)
    lines.push_back("the scene is " + formatLength(size) +
                    " wide: the numbers of a pose are in metres");
  return lines;
}

} // namespace patina
