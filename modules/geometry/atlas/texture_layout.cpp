#include "geometry/atlas/texture_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "geometry/atlas/atlas_charts.h"
#include "geometry/atlas/atlas_packing.h"
#include "geometry/atlas/uv_overlap.h"
#include "geometry/mesh/adjacency.h"

namespace patina {
namespace {

constexpr int kGap = 2 * kGutter; // [texels] between charts
// Smaller charts [texels] join neighbours despite stretch: their gaps would take more room.
constexpr double kSmallChart = 256;
constexpr double kMinShare = 0.4; // expected fraction of the image that charts fill
constexpr double kMaxLost = 1e-3; // largest fraction of the surface without area in the unit square
constexpr double kMinFilled = 0.01; // smallest fraction of the unit square that must be filled
// Largest chart [image sides]; a longer one would make the others small.
constexpr double kLongest = 0.95;

std::vector<Chart> chartsOf(const AtlasSurface& surface, int image_size) {
  const double area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
  std::vector<Chart> grown = grownCharts(surface, 2 * kSmallChart * area / image_size / image_size);
  const double side = std::sqrt(area / kMinShare); // [m], estimated side of the whole image
  const ChartLimits limits{kLongest * side, kGap * side / image_size};
  std::vector<std::vector<Chart>> pieces(grown.size());
  tbb::parallel_for(std::size_t{0}, grown.size(), [&](std::size_t c) {
    pieces[c] = embeddedPieces(surface, std::move(grown[c]), limits);
  });
  std::vector<Chart> charts;
  for (auto& list : pieces)
    for (Chart& chart : list) charts.push_back(std::move(chart));
  return charts;
}

double areaOf(const AtlasSurface& surface, const Chart& chart) {
  double sum = 0;
  for (const std::int32_t f : chart.faces) sum += surface.areas[index(f)];
  return sum;
}

// Sorts the largest first.
void sortByArea(const AtlasSurface& surface, std::vector<Chart>& charts) {
  std::vector<std::pair<double, std::size_t>> order;
  for (const Chart& chart : charts) order.emplace_back(-areaOf(surface, chart), order.size());
  std::sort(order.begin(), order.end());
  std::vector<Chart> sorted;
  for (const auto& entry : order) sorted.push_back(std::move(charts[entry.second]));
  charts = std::move(sorted);
}

std::vector<ChartOutline> outlinesOf(const AtlasSurface& surface,
                                     const std::vector<Chart>& charts) {
  std::vector<std::int32_t> chart_of(surface.triangles.size(), kNone);
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (const std::int32_t f : charts[c].faces) chart_of[index(f)] = static_cast<std::int32_t>(c);
  std::vector<ChartOutline> outlines(charts.size());
  tbb::parallel_for(std::size_t{0}, charts.size(), [&](std::size_t c) {
    const ChartPlane plane(charts[c].normal);
    for (const std::int32_t f : charts[c].faces)
      for (std::size_t e = 0; e < 3; ++e) {
        const std::int32_t next = surface.neighbours[index(f)][e];
        if (next != kNone && chart_of[index(next)] == static_cast<std::int32_t>(c)) continue;
        const Triangle& t = surface.triangles[index(f)];
        outlines[c].edges.push_back({plane(surface.positions[index(t[e])]),
                                     plane(surface.positions[index(t[(e + 1) % 3])])});
      }
  });
  return outlines;
}

// Removes the smallest charts until the others can use the image.
Packing packedOrFewer(const AtlasSurface& surface, std::vector<Chart>& charts, int image_size) {
  sortByArea(surface, charts);
  charts.resize(std::min(charts.size(), maxCharts(image_size, kGap)));
  for (;;) {
    Packing packing = packed(outlinesOf(surface, charts), image_size, kGap);
    const double texel = packing.scale > 0 ? 1 / packing.scale : 0;
    double area = 0;
    for (const Chart& chart : charts) area += areaOf(surface, chart);
    const bool wasteful = area < 0.2 * texel * texel * image_size * image_size;
    const auto tiny = std::find_if(charts.begin(), charts.end(), [&](const Chart& chart) {
      return areaOf(surface, chart) < texel * texel;
    });
    const auto kept = static_cast<std::size_t>(tiny - charts.begin());
    if (!packing.texel_from_plane.empty() && (!wasteful || 2 * kept > charts.size()))
      return packing;
    if (charts.size() < 2) return packing;
    charts.resize(std::clamp(kept, std::size_t{1}, charts.size() / 2));
  }
}

// Assigns each face without a chart the UV of a charted vertex found by breadth-first search.
void assignDegenerateUvs(const AtlasSurface& surface, std::vector<bool>& placed, CornerUvs& uvs) {
  std::vector<Vec2> place(surface.positions.size());
  std::vector<bool> known(place.size(), false);
  std::vector<std::int32_t> queue;
  const auto give = [&](std::int32_t vertex, const Vec2& uv) {
    if (known[index(vertex)]) return;
    known[index(vertex)] = true;
    place[index(vertex)] = uv;
    queue.push_back(vertex);
  };
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (std::size_t k = 0; k < 3 && placed[f]; ++k) give(surface.triangles[f][k], uvs[f][k]);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const std::size_t v = index(queue[k]);
    for (std::int32_t at = surface.vertex_offsets[v]; at < surface.vertex_offsets[v + 1]; ++at) {
      const std::int32_t f = surface.vertex_faces[index(at)];
      if (placed[index(f)]) continue;
      placed[index(f)] = true;
      uvs[index(f)].fill(place[v]);
      for (const std::int32_t next : surface.triangles[index(f)]) give(next, place[v]);
    }
  }
}

// Interleaves the bits of three coordinates (Morton order).
std::uint64_t mortonCode(const Vec3& unit) {
  std::uint64_t code = 0;
  for (int bit = 20; bit >= 0; --bit)
    for (int k = 0; k < 3; ++k) {
      const auto cell = static_cast<std::uint64_t>(std::clamp(unit[k], 0.0, 1.0) * 2097151);
      code = code << 1 | (cell >> bit & 1);
    }
  return code;
}

// Assigns parts of the surface without any chart the UV of a face that is near in space.
void assignIslandUvs(const AtlasSurface& surface, const std::vector<bool>& placed, CornerUvs& uvs) {
  if (std::find(placed.begin(), placed.end(), false) == placed.end()) return;
  Box3 box;
  for (const Vec3& p : surface.positions)
    if (p.allFinite()) box.extend(p);
  const double size = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t f = 0; f < uvs.size(); ++f) {
    const Vec3& p = surface.positions[index(surface.triangles[f][0])];
    const bool usable = size > 0 && p.allFinite();
    order.emplace_back(usable ? mortonCode((p - box.min()) / size) : 0, f);
  }
  std::sort(order.begin(), order.end());
  const auto first = std::find_if(order.begin(), order.end(),
                                  [&](const auto& entry) { return placed[entry.second]; });
  Vec2 last = first == order.end() ? Vec2::Constant(0.5) : uvs[first->second][0];
  for (const auto& [code, f] : order)
    if (placed[f])
      last = uvs[f][0];
    else
      uvs[f].fill(last);
}

void copyToTwins(const AtlasSurface& surface, CornerUvs& uvs) {
  for (const auto& [face, first] : surface.duplicates) {
    const Triangle &to = surface.triangles[index(face)], &from = surface.triangles[index(first)];
    for (std::size_t k = 0; k < 3; ++k)
      uvs[index(face)][k] = uvs[index(first)][to[k] == from[0] ? 0 : to[k] == from[1] ? 1 : 2];
  }
}

// Counts the pieces in the image. Connected faces have equal UVs at a common edge.
int piecesOf(const TriangleMesh& mesh) {
  const Adjacency around = adjacency(mesh);
  std::vector<bool> taken(mesh.triangles.size(), false);
  std::vector<std::size_t> queue;
  int pieces = 0;
  for (std::size_t seed = 0; seed < taken.size(); ++seed) {
    if (taken[seed]) continue;
    taken[seed] = true;
    ++pieces;
    for (queue = {seed}; !queue.empty();) {
      const std::size_t f = queue.back();
      queue.pop_back();
      for (std::size_t e = 0; e < 3; ++e) {
        const std::int32_t next = around.face_neighbours[f][e];
        if (next == kNone || taken[index(next)]) continue;
        const auto placeIn = [&](std::size_t face, std::int32_t vertex) {
          const Triangle& t = mesh.triangles[face];
          return mesh.corner_uvs[face][t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2];
        };
        const std::int32_t a = mesh.triangles[f][e], b = mesh.triangles[f][(e + 1) % 3];
        if (placeIn(f, a) != placeIn(index(next), a) || placeIn(f, b) != placeIn(index(next), b))
          continue;
        taken[index(next)] = true;
        queue.push_back(index(next));
      }
    }
  }
  return pieces;
}

} // namespace

bool hasArea(const std::array<Vec2, 3>& uv) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0], c = uv[2] - uv[1];
  const double longest2 = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
  return std::abs(a[0] * b[1] - a[1] * b[0]) > 1e-13 * longest2;
}

std::string ownLayoutFault(const TriangleMesh& mesh) {
  if (mesh.corner_uvs.empty()) return "the mesh has no texture coordinates";
  if (mesh.corner_uvs.size() != mesh.triangles.size())
    return "texture coordinates are missing on some faces";
  bool finite = true, inside = true;
  double filled = 0, whole = 0, lost = 0;
  std::size_t flat = 0; // faces without UV area
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& uv = mesh.corner_uvs[f];
    for (const Vec2& p : uv) {
      finite = finite && p.allFinite();
      inside = inside && p.minCoeff() >= 0 && p.maxCoeff() <= 1;
    }
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    const double area =
        (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).norm();
    if (!std::isfinite(area)) continue;
    whole += area;
    filled += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    if (hasArea(uv)) continue;
    lost += area;
    ++flat;
  }
  if (!finite) return "texture coordinates are not finite";
  if (!inside) return "texture coordinates leave the unit square";
  if (filled == 0) return "texture coordinates have no area";
  if (lost > kMaxLost * whole)
    return "texture coordinates have no area on " + std::to_string(flat) + " triangles";
  if (filled < kMinFilled) return "texture coordinates fill less than 1 % of the unit square";
  const std::optional<UvOverlap> overlap = findUvOverlap(mesh.corner_uvs);
  if (!overlap) return "";
  return "texture coordinates overlap, those of triangles " + std::to_string(overlap->a) + " and " +
         std::to_string(overlap->b) + " for one";
}

TextureLayout textureLayout(const TriangleMesh& mesh, int image_size) {
  if (!ownLayoutFault(mesh).empty()) return generateAtlas(mesh, image_size);
  return {std::make_shared<CornerUvs>(mesh.corner_uvs), false, piecesOf(mesh)};
}

TextureLayout generateAtlas(const TriangleMesh& mesh, int image_size) {
  if (image_size < 16 || image_size > 16384)
    throw std::invalid_argument("an atlas has 16 to 16384 texels a side");
  const AtlasSurface surface = atlasSurface(mesh);
  std::vector<Chart> charts = chartsOf(surface, image_size);
  const Packing packing = packedOrFewer(surface, charts, image_size);

  auto uvs = std::make_shared<CornerUvs>(mesh.triangles.size());
  std::vector<bool> placed(mesh.triangles.size(), false);
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (const std::int32_t f : charts[c].faces) placed[index(f)] = true;
  tbb::parallel_for(std::size_t{0}, charts.size(), [&](std::size_t c) {
    const ChartPlane plane(charts[c].normal);
    const Eigen::Affine2d& texel_from_plane = packing.texel_from_plane[c];
    for (const std::int32_t f : charts[c].faces)
      for (std::size_t k = 0; k < 3; ++k)
        (*uvs)[index(f)][k] = texel_from_plane *
                              plane(surface.positions[index(surface.triangles[index(f)][k])]) /
                              image_size;
  });
  assignDegenerateUvs(surface, placed, *uvs);
  assignIslandUvs(surface, placed, *uvs);
  copyToTwins(surface, *uvs);
  return {std::move(uvs), true, static_cast<int>(charts.size())};
}

} // namespace patina
