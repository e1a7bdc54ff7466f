#include "session/build/compile_warnings.h"

#include <algorithm>
#include <cmath>

#include "core/numbers.h"
#include "field/sampling/field_sampler.h"
#include "haptics/stability/stabilisers.h"

namespace patina {
namespace {

constexpr std::size_t kMostProbes = 50'000;
constexpr double kProbeDepth = 0.5;    // voxels
constexpr double kToldVanished = 0.01; // of the area; slivers beside sharp edges are less
constexpr double kToldMoved = 0.1;     // of the area; a fine mesh has much of it beside edges
constexpr double kMoved = 0.05;        // voxels; a smooth surface is felt far closer
constexpr double kLargestScene = 2;    // [m]

struct ThinParts {
  double vanished = 0, moved = 0; // of the area
  double by = 0;                  // [m], mean over what is moved
};

// Nothing where the tip's radius or an offset makes such parts thick.
ThinParts thinParts(const CompiledScene& compiled) {
  const HapticProperties& haptics = compiled.scene.haptics;
  const SurfaceField& field = *compiled.built.field;
  const double iso = haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
  if (iso >= field.grid.voxel || compiled.mesh_report.boundary_edges > 0) return {};
  const FieldSampler sampler(field, compiled.scene.sampler);
  const TriangleMesh& mesh = *compiled.mesh;
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kMostProbes);
  double all = 0, vanished = 0, moved = 0, by = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    const Vec3 a = mesh.corner(i, 0), b = mesh.corner(i, 1), c = mesh.corner(i, 2);
    const Vec3 across = (b - a).cross(c - a);
    const double twice_area = across.norm();
    if (!(twice_area > 0) || !std::isfinite(twice_area)) continue;
    all += twice_area;
    const Vec3 centre = field.grid.toGrid((a + b + c) / 3);
    const Vec3 aside = kProbeDepth / twice_area * across;
    // Whichever way the triangle is turned, one side of it is the inside.
    if (std::min(sampler.phiAtGrid(centre + aside), sampler.phiAtGrid(centre - aside)) >= 0) {
      vanished += twice_area;
    } else if (const double off = std::abs(sampler.phiAtGrid(centre)); off > kMoved) {
      moved += twice_area;
      by += twice_area * off;
    }
  }
  if (!(all > 0)) return {};
  return {vanished / all, moved / all, moved > 0 ? by / moved * field.grid.voxel : 0};
}

// Numbers that faces have and no texture.
void tellUnknownTextures(const Scene& scene, std::vector<std::string>& lines) {
  for (const SceneObject& object : scene.objects) {
    if (!object.paint || !object.paint->textures) continue;
    const LaidTextures& laid = *object.paint->textures;
    std::map<std::int32_t, std::size_t> unknown;
    for (const TexturedFace& face : laid.faces)
      if (!laid.library.contains(face.texture)) ++unknown[face.texture];
    for (const auto& [number, faces] : unknown)
      lines.push_back(object.name + ": " + formatCount(faces) + " faces have the texture " +
                      std::to_string(number) + ", which is not known: they are felt without; " +
                      "--texture " + std::to_string(number) + "=T.json names its file");
  }
}

// F7: a layer has no lateral coupling that would keep it quiet.
void tellStiffLayers(const CompiledScene& compiled, std::vector<std::string>& lines) {
  if (!compiled.scene.device_model) return;
  const double steady =
      steadyBend(compiled.scene.haptics.force_limit, *compiled.scene.device_model);
  for (std::size_t i = 0; i < compiled.paint.objects.size(); ++i) {
    const auto& layer = compiled.paint.objects[i].layer;
    if (layer && layer->textures->bend() > steady)
      lines.push_back(compiled.scene.objects[i].name +
                      ": its texture is sharper than this device can hold steady as a layer; "
                      "without texture.gain it is coupled along the surface");
  }
}

std::string percent(double share) {
  return formatNumber(std::round(100 * share)) + " %";
}

} // namespace

std::vector<std::string> compileWarnings(const CompiledScene& compiled) {
  std::vector<std::string> lines;
  tellUnknownTextures(compiled.scene, lines);
  tellStiffLayers(compiled, lines);
  const double voxel = compiled.built.field->grid.voxel;
  const ThinParts thin = thinParts(compiled);
  if (thin.vanished > kToldVanished)
    lines.push_back(percent(thin.vanished) +
                    " of the surface belongs to parts thinner than a voxel (" +
                    formatLength(voxel) +
                    "), which are not felt: set a smaller voxel, an offset or a tip radius");
  if (thin.moved > kToldMoved)
    lines.push_back(percent(thin.moved) +
                    " of the surface belongs to parts thinner than two voxels (" +
                    formatLength(2 * voxel) + ") and is felt " + formatLength(thin.by) +
                    " from where it is: set a smaller voxel, an offset or a tip radius");
  const std::optional<Magnet>& magnet = compiled.scene.haptics.magnet;
  if (magnet && magnet->range * magnet->strength == 0)
    lines.push_back(magnet->range > 0 ? "magnet.range has no effect without magnet.strength"
                                      : "magnet.strength has no effect without magnet.range");
  bool posed = false;
  for (const SceneObject& object : compiled.scene.objects)
    posed |= !object.world_from_object.matrix().isIdentity(0.0);
  const auto& nodes = compiled.built.field->grid.nodes;
  const double size = (*std::max_element(nodes.begin(), nodes.end()) - 1) * voxel;
  if (posed && size > kLargestScene)
    lines.push_back("the scene is " + formatLength(size) +
                    " wide: the numbers of a pose are in metres");
  return lines;
}

} // namespace patina
