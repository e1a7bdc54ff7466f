#include "geometry/mesh/mesh_unit.h"

#include <cmath>

#include "core/error.h"
#include "core/named.h"
#include "core/numbers.h"

namespace patina {
namespace {

struct UnitName : Named<MeshUnit> {
  double metres; // 0: depends on the mesh
};
constexpr std::array<UnitName, 5> kUnits = {{{{MeshUnit::mm, "mm"}, 1e-3},
                                             {{MeshUnit::cm, "cm"}, 1e-2},
                                             {{MeshUnit::m, "m"}, 1.0},
                                             {{MeshUnit::in, "in"}, 0.0254},
                                             {{MeshUnit::fit, "fit"}, 0.0}}};

const UnitName& entry(MeshUnit unit) {
  return kUnits[static_cast<std::size_t>(unit)];
}

// Bounds the finite corners, so that a NaN does not determine the scale.
Box3 finiteBox(const TriangleMesh& mesh) {
  Box3 box;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (const Vec3 p = mesh.corner(t, k); p.allFinite()) box.extend(p);
  return box;
}

constexpr double kFitted = 0.1;
constexpr double kSmall = 1e-3; // lengths outside these limits are probably a mistake
constexpr double kLarge = 2.0;

} // namespace

MeshUnit parseMeshUnit(std::string_view text) {
  if (const auto unit = parseIn(kUnits, text)) return *unit;
  throw Error("unit '" + std::string(text) + "' is unknown; mm, cm, m, in and fit are");
}

std::string_view name(MeshUnit unit) {
  return nameIn(kUnits, unit);
}

MeshUnit likelyUnit(double longest) {
  for (const MeshUnit unit : {MeshUnit::mm, MeshUnit::cm, MeshUnit::m})
    if (std::abs(std::log10(longest * entry(unit).metres / kFitted)) < 0.5) return unit;
  return MeshUnit::fit;
}

UpAxis parseUpAxis(std::string_view text) {
  constexpr std::array<Named<UpAxis>, 2> kAxes = {{{UpAxis::z, "z"}, {UpAxis::y, "y"}}};
  if (const auto axis = parseIn(kAxes, text)) return *axis;
  throw Error("up axis '" + std::string(text) + "' is unknown; z and y are");
}

TriangleMesh zUp(TriangleMesh mesh, UpAxis up) {
  if (up == UpAxis::y)
    for (Vec3& p : mesh.positions) p = Vec3(p.x(), -p.z(), p.y());
  return mesh;
}

bool isUsualLength(double metres) {
  return metres >= kSmall && metres <= kLarge;
}

ScaledMesh inMetres(TriangleMesh mesh, MeshUnit unit) {
  ScaledMesh result;
  const Box3 box = finiteBox(mesh);
  const double side = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  result.scale = entry(unit).metres;
  if (unit == MeshUnit::fit)
    result.scale = side > 0 && std::isfinite(kFitted / side) ? kFitted / side : 1.0;
  const double farthest =
      box.isEmpty() ? 0.0
                    : result.scale * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  if (!(farthest <= kMaxCoordinate))
    throw Error("a corner lies " + formatNumber(farthest) + " m from the origin when the unit is " +
                std::string(name(unit)) + "; the maximum is " + formatNumber(kMaxCoordinate) +
                " m");
  if (result.scale != 1.0)
    for (Vec3& p : mesh.positions) p *= result.scale;
  const double metres = side * result.scale;
  if (side > 0 && !isUsualLength(metres))
    result.warning = "the mesh is " + formatLength(metres) + " long when its unit is " +
                     std::string(name(unit)) + "; choose another with --unit (mm, cm, m, in, fit)";
  result.mesh = std::move(mesh);
  return result;
}

} // namespace patina
