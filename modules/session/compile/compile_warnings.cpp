#include "session/compile/compile_warnings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.h"
#include "core/percentiles.h"
#include "field/sampling/field_sampler.h"
#include "haptics/law/stabilisers.h"

namespace patina {
namespace {

constexpr std::size_t kMaxProbes = 50'000;
constexpr double kProbeDepth = 0.5;          // voxels
constexpr double kWarnVanished = 0.01;       // share of the area; slivers at sharp edges have less
constexpr double kWarnMoved = 0.1;           // share of the area; edges of a fine mesh have less
constexpr double kMinDisplacement = 0.05;    // voxels; a smooth surface deviates far less
constexpr double kMaxDisplacedThickness = 2; // voxels; thicker parts deviate only at edges
// A bar, thin in two directions, lets the tip pass if pressed hard off its middle: always somewhere
// below this thickness, never above. A plate of one voxel holds.
constexpr double kMinThickness = 4;  // voxels
constexpr double kMinOffset = 0.5;   // voxels; with it bars of two voxels hold
constexpr double kWarnBars = 0.005;  // share of an object's area
constexpr double kWarnHole = 0.01;   // share of the area
constexpr std::size_t kMaxHoles = 4; // lines
constexpr double kLargestScene = 2;  // [m]

// Number of directions over half a turn in the plane of a face, along which a part's thickness is
// measured.
constexpr int kAcross = 8;

struct ThinParts {
  double vanished = 0, moved = 0; // shares of the area
  double by = 0;                  // mean over the displaced area [m]
  struct Bar {
    std::size_t object;
    double thickness; // median [m]
  };
  std::vector<Bar> bars;
};

// Distance from an inside point along `way` to the outside, at most kMinThickness [voxel].
double insideAlong(const FieldSampler& sampler, const Vec3& from, const Vec3& way) {
  constexpr double kStep = 0.25;
  double before = sampler.phiAtGrid(from);
  for (double at = kStep; at <= kMinThickness; at += kStep) {
    const double phi = sampler.phiAtGrid(from + at * way);
    if (phi >= 0) return at - kStep * phi / (phi - before);
    before = phi;
  }
  return kMinThickness;
}

// Thickness at a face, through it and in its narrowest direction [voxel], at most kMinThickness;
// `inside` is a point just below the face.
struct Section {
  double through, along;
};
Section sectionAt(const FieldSampler& sampler, const Vec3& inside, const Vec3& inwards) {
  const double ahead = insideAlong(sampler, inside, inwards),
               behind = insideAlong(sampler, inside, -inwards);
  Section section{std::min(ahead + behind, kMinThickness), kMinThickness};
  if (section.through >= kMinThickness) return section;
  const Vec3 middle = inside + (ahead - behind) / 2 * inwards;
  const Vec3 u = inwards.unitOrthogonal(), v = inwards.cross(u);
  for (int i = 0; i < kAcross; ++i) {
    const double turn = std::numbers::pi * i / kAcross;
    const Vec3 way = std::cos(turn) * u + std::sin(turn) * v;
    section.along = std::min(section.along, insideAlong(sampler, middle, way) +
                                                insideAlong(sampler, middle, -way));
  }
  return section;
}

// Empty if the tip's radius or an offset thickens such parts.
ThinParts thinParts(const CompiledScene& compiled) {
  const HapticProperties& haptics = compiled.scene.haptics;
  const SurfaceField& field = *compiled.built.field;
  const double voxel = field.grid.voxel;
  const double iso = haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
  if (iso >= voxel || compiled.mesh_report.boundary_edges > 0) return {};
  const FieldSampler sampler(field, compiled.scene.sampler);
  const std::size_t faces = compiled.mesh->triangles.size();
  const std::size_t stride = std::max<std::size_t>(1, faces / kMaxProbes);
  ThinParts found;
  double all = 0, by = 0;
  std::size_t first = 0;
  for (std::size_t object = 0; object < compiled.objects.size(); ++object) {
    const std::size_t end = first + compiled.objects[object]->mesh->triangles.size();
    double own = 0, thin = 0; // area
    std::vector<double> thicknesses;
    for (std::size_t i = (first + stride - 1) / stride * stride; i < end; i += stride) {
      const TriangleMesh& mesh = *compiled.mesh;
      const Vec3 a = mesh.corner(i, 0), b = mesh.corner(i, 1), c = mesh.corner(i, 2);
      const Vec3 across = (b - a).cross(c - a);
      const double area = across.norm();
      if (!(area > 0) || !std::isfinite(area)) continue;
      own += area;
      const Vec3 centre = field.grid.toGrid((a + b + c) / 3);
      Vec3 inwards = across / area;
      const double one = sampler.phiAtGrid(centre + kProbeDepth * inwards),
                   other = sampler.phiAtGrid(centre - kProbeDepth * inwards);
      // The triangle may have either orientation; one side of it is inside.
      if (std::min(one, other) >= 0) {
        found.vanished += area;
        continue;
      }
      if (other < one) inwards = -inwards;
      const Section section = sectionAt(sampler, centre + kProbeDepth * inwards, inwards);
      const double off = std::abs(sampler.phiAtGrid(centre));
      if (section.through < kMaxDisplacedThickness && off > kMinDisplacement) {
        found.moved += area;
        by += area * off;
      }
      const double thickness = std::max(section.through, section.along);
      if (thickness >= kMinThickness || iso >= kMinOffset * voxel) continue;
      thin += area;
      thicknesses.push_back(thickness * voxel);
    }
    if (thin > kWarnBars * own)
      found.bars.push_back({object, percentiles(std::move(thicknesses)).p50});
    all += own;
    first = end;
  }
  if (!(all > 0)) return {};
  if (found.moved > 0) found.by = by / found.moved * voxel;
  found.vanished /= all;
  found.moved /= all;
  return found;
}

void addUnknownTextures(const Scene& scene, std::vector<std::string>& lines) {
  for (const SceneObject& object : scene.objects) {
    if (!object.paint || !object.paint->textures) continue;
    const TextureMappings& laid = *object.paint->textures;
    std::map<std::int32_t, std::size_t> unknown;
    for (const TexturedFace& face : laid.faces)
      if (!laid.library.contains(face.texture)) ++unknown[face.texture];
    for (const auto& [number, faces] : unknown)
      lines.push_back(object.name + ": " + formatCount(faces) + " faces have the texture " +
                      std::to_string(number) + ", which is unknown: they have no texture; " +
                      "--texture " + std::to_string(number) + "=T.json names its file");
  }
}

// F7: a layer has no lateral coupling that would stabilise it.
void addStiffLayers(const CompiledScene& compiled, std::vector<std::string>& lines) {
  if (!compiled.scene.device_model) return;
  const double steady =
      maxStableCurvature(compiled.scene.haptics.force_limit, *compiled.scene.device_model);
  for (std::size_t i = 0; i < compiled.paint.objects.size(); ++i) {
    const auto& layer = compiled.paint.objects[i].layer;
    if (layer && layer->textures->maxCurvature() > steady)
      lines.push_back(compiled.scene.objects[i].name +
                      ": its texture is too sharp for this device to render stably as a layer; "
                      "without texture.gain it is coupled along the surface");
  }
}

double areaOf(const TriangleMesh& mesh, std::int32_t face) {
  const Vec3 a = mesh.corner(index(face), 0);
  return 0.5 * (mesh.corner(index(face), 1) - a).cross(mesh.corner(index(face), 2) - a).norm();
}

std::string percent(double share) {
  return formatNumber(std::round(100 * share)) + " %";
}

} // namespace

std::vector<std::string> surfaceWarnings(const FieldReport& built, OpenSides sides,
                                         const TriangleMesh& mesh) {
  std::vector<std::string> lines;
  if (built.inner_triangles > 0)
    lines.push_back(formatCount(built.inner_triangles) +
                    " triangles are duplicates inside a body, as between the cells of a "
                    "tetrahedral mesh: they are left out");
  if (sides != OpenSides::closed && !built.holes.empty()) {
    double area = 0;
    for (const std::int32_t f : usableTriangles(mesh)) area += areaOf(mesh, f);
    for (const Hole& hole : built.holes) {
      if (hole.area < kWarnHole * area || lines.size() >= kMaxHoles) break;
      lines.push_back("a hole of " + describeHole(hole) +
                      " is closed over, so that what lies behind it is solid: surface.sides = one "
                      "keeps it open, or two with tip.radius or offset");
    }
  }
  const bool obeyed = std::any_of(built.parts.begin(), built.parts.end(),
                                  [](const PartSides& part) { return part.asked; });
  if ((sides == OpenSides::one || sides == OpenSides::two) && !obeyed)
    lines.push_back(std::string("surface.sides = ") + (sides == OpenSides::one ? "one" : "two") +
                    " has no effect: no part has an edge of one triangle, all are closed");
  return lines;
}

std::vector<std::string> compileWarnings(const CompiledScene& compiled) {
  std::vector<std::string> lines =
      surfaceWarnings(compiled.built.report, compiled.scene.field.sides, *compiled.mesh);
  addUnknownTextures(compiled.scene, lines);
  addStiffLayers(compiled, lines);
  const double voxel = compiled.built.field->grid.voxel;
  const ThinParts thin = thinParts(compiled);
  if (thin.vanished > kWarnVanished)
    lines.push_back(percent(thin.vanished) +
                    " of the surface belongs to parts thinner than a voxel (" +
                    formatLength(voxel) +
                    "), which cannot be touched: set a smaller voxel, an offset or a tip radius");
  if (thin.moved > kWarnMoved)
    lines.push_back(percent(thin.moved) +
                    " of the surface belongs to parts thinner than two voxels (" +
                    formatLength(2 * voxel) + ") and is felt " + formatLength(thin.by) +
                    " from where it is: set a smaller voxel, an offset or a tip radius");
  for (const ThinParts::Bar& bar : thin.bars)
    lines.push_back(
        compiled.scene.objects[bar.object].name + ": a part " + formatLength(bar.thickness) +
        " thick is under four voxels (" + formatLength(kMinThickness * voxel) +
        ") in both directions and lets the tip through when pressed hard: set a smaller voxel, an "
        "offset or a tip radius");
  const std::optional<Magnet>& magnet = compiled.scene.haptics.magnet;
  if (magnet && magnet->range * magnet->strength == 0)
    lines.push_back(magnet->range > 0 ? "magnet.range has no effect without magnet.strength"
                                      : "magnet.strength has no effect without magnet.range");
  const Vec3 sides = bounds(*compiled.mesh).sizes();
  const double extent = compiled.mesh->triangles.empty() ? 0 : sides.maxCoeff();
  const auto warnIfLarge = [&](const char* key, const std::optional<double>& length) {
    if (length && *length > extent && extent > 0)
      lines.push_back(std::string(key) + " " + formatLength(*length) +
                      " is more than the whole scene, which is " + formatLength(extent) +
                      " long: lengths without a unit are in metres");
  };
  warnIfLarge("tip.radius", compiled.scene.haptics.tip_radius);
  warnIfLarge("offset", compiled.scene.haptics.offset);
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
