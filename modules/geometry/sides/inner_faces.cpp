#include "geometry/sides/inner_faces.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/orientation.h"
#include "geometry/winding/winding_number.h"

namespace patina {
namespace {

constexpr double kInside = 0.75;

TriangleMesh orientedFaces(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  TriangleMesh only{mesh.positions, {}, {}};
  for (const std::int32_t f : faces) only.triangles.push_back(mesh.triangles[index(f)]);
  for (const std::int32_t f : misorientedTriangles(only))
    std::swap(only.triangles[index(f)][1], only.triangles[index(f)][2]);
  return only;
}

} // namespace

std::vector<std::int32_t> innerFaces(const TriangleMesh& mesh,
                                     const std::vector<Triangle>& welded) {
  const std::vector<std::int32_t> first = firstDuplicates(welded);
  std::vector<std::int32_t> copies(welded.size());
  for (const std::int32_t f : first) ++copies[index(f)];
  std::vector<std::int32_t> single, paired;
  for (std::size_t f = 0; f < welded.size(); ++f)
    (copies[index(first[f])] == 2 ? paired : single).push_back(static_cast<std::int32_t>(f));
  if (single.empty() || paired.empty()) return {};
  const WindingNumber winding(orientedFaces(mesh, single));
  std::vector<std::uint8_t> inner(paired.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, paired.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      // Takes the first of both, so that rounding cannot make their results differ.
      const std::size_t f = index(first[index(paired[i])]);
      const Vec3 centre = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3;
      inner[i] = std::abs(winding.at(centre)) > kInside;
    }
  });
  std::vector<std::int32_t> faces;
  for (std::size_t i = 0; i < paired.size(); ++i)
    if (inner[i]) faces.push_back(paired[i]);
  return faces;
}

} // namespace patina
