#include "geometry/mesh/open_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/orientation.h"

namespace patina {
namespace {

constexpr double kTells = 0.35;           // how far from 1/2 a winding number must be
constexpr std::size_t kMostSamples = 256; // faces of a part that are asked
constexpr std::size_t kFewestFaces = 4;   // that can have an inside of their own

// Every edge runs as often one way as the other: no rim. By sums of the edges' hashes, so that a
// sound mesh costs next to nothing.
bool isBalanced(const std::vector<Triangle>& triangles) {
  std::uint64_t sum = 0;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
      std::uint64_t hash = static_cast<std::uint64_t>(std::min(a, b)) << 32 |
                           static_cast<std::uint64_t>(std::max(a, b));
      hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15u;
      hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9u;
      sum += a < b ? hash ^ hash >> 32 : 0 - (hash ^ hash >> 32);
    }
  }
  return sum == 0;
}

struct Part {
  std::vector<std::int32_t> faces;
  bool rim = false, open = false;
  double told = 0, before = 0; // area about which an inside is told; of it, where that is in front
};

std::vector<Part> connectedParts(const std::vector<Triangle>& triangles) {
  const std::vector<std::int32_t> twin = firstTwins(triangles);
  std::vector<std::int32_t> root(triangles.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t f) {
    while (root[index(f)] != f) f = root[index(f)] = root[index(root[index(f)])];
    return f;
  };
  std::vector<std::int32_t> on_rim;
  forEachEdge(
      triangles, twin, [](std::size_t) { return true; },
      [&](auto first, auto last) {
        if (last - first == 1) on_rim.push_back(first->face);
        for (auto use = first + 1; use != last; ++use) {
          const std::int32_t a = find(first->face), b = find(use->face);
          root[index(std::max(a, b))] = std::min(a, b);
        }
      });
  std::vector<Part> parts;
  std::vector<std::size_t> part_of(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::size_t lowest = index(find(twin[f])); // a root is its part's lowest face
    if (lowest == f) {
      part_of[f] = parts.size();
      parts.emplace_back();
    }
    parts[part_of[lowest]].faces.push_back(static_cast<std::int32_t>(f));
  }
  for (const std::int32_t f : on_rim) parts[part_of[index(find(f))]].rim = true;
  return parts;
}

struct Sample {
  std::size_t part;
  std::int32_t face;
  double area = 0;
  bool told = false, before = false;
};

Sample sampleOf(const TriangleMesh& mesh, const WindingNumber& winding, std::size_t part,
                std::int32_t face) {
  const Vec3 a = mesh.corner(index(face), 0), b = mesh.corner(index(face), 1),
             c = mesh.corner(index(face), 2);
  const Vec3 normal = (b - a).cross(c - a);
  const double doubled = normal.norm();
  const Vec3 off = 1e-3 / std::sqrt(doubled) * normal; // of the face's size
  const Vec3 centre = (a + b + c) / 3;
  const double before = std::abs(winding.at(centre + off)) - 0.5,
               behind = std::abs(winding.at(centre - off)) - 0.5;
  const bool told = std::abs(before) >= kTells && std::abs(behind) >= kTells;
  return {part, face, doubled, told, told && before > 0};
}

// Of the parts asked: whether the winding number tells less than half of their area.
void judge(const TriangleMesh& mesh, const WindingNumber& winding, std::vector<Part>& parts,
           const std::vector<std::size_t>& asked) {
  std::vector<Sample> samples;
  for (const std::size_t p : asked) {
    const auto& faces = parts[p].faces;
    const std::size_t count = std::min(faces.size(), kMostSamples);
    for (std::size_t i = 0; i < count; ++i) samples.push_back({p, faces[i * faces.size() / count]});
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 32), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      samples[i] = sampleOf(mesh, winding, samples[i].part, samples[i].face);
  });
  std::vector<double> area(parts.size());
  for (const std::size_t p : asked) parts[p].told = parts[p].before = 0;
  for (const Sample& sample : samples) {
    area[sample.part] += sample.area;
    if (sample.told) parts[sample.part].told += sample.area;
    if (sample.before) parts[sample.part].before += sample.area;
  }
  for (const std::size_t p : asked) parts[p].open = 2 * parts[p].told < area[p];
}

// Pieces that close a body together turn the same way. Two sheets one above the other do not: of
// one the inside that they seem to have is in front, of the other behind. Told over half its area
// by the other, neither is more than twice as large.
bool turnBothWays(const std::vector<Part>& parts, const std::vector<std::size_t>& asked) {
  double before = 0, told = 0;
  for (const std::size_t p : asked) {
    if (parts[p].open) continue;
    before += parts[p].before;
    told += parts[p].told;
  }
  return 4 * std::min(before, told - before) > told;
}

// Corners are not shared.
TriangleMesh onlyFaces(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  TriangleMesh only;
  for (const std::int32_t f : faces) {
    const auto first = static_cast<std::int32_t>(only.positions.size());
    for (int k = 0; k < 3; ++k) only.positions.push_back(mesh.corner(index(f), k));
    only.triangles.push_back({first, first + 1, first + 2});
  }
  return only;
}

} // namespace

OpenParts openParts(const TriangleMesh& mesh, const WindingNumber& winding) {
  OpenParts result;
  if (isBalanced(mesh.triangles)) return result;
  const std::vector<Triangle> triangles = weldedTriangles(mesh);
  if (isBalanced(triangles)) return result;
  std::vector<Part> parts = connectedParts(triangles);
  std::vector<std::size_t> asked;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (parts[p].rim) asked.push_back(p);
  judge(mesh, winding, parts, asked);
  if (turnBothWays(parts, asked))
    for (const std::size_t p : asked) parts[p].open = true;
  // What else is there may hide that a part has an inside of its own: a terrain beneath it, say.
  for (const std::size_t p : asked) {
    if (!parts[p].open || parts[p].faces.size() < kFewestFaces || parts.size() == 1) continue;
    judge(mesh, WindingNumber(onlyFaces(mesh, parts[p].faces)), parts, {p});
  }
  // Or pretend it: of what is open nothing is left when the closed ones are signed.
  for (bool opened = true; opened;) {
    std::vector<std::int32_t> closed;
    std::vector<std::size_t> doubtful;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].open) continue;
      closed.insert(closed.end(), parts[p].faces.begin(), parts[p].faces.end());
      if (parts[p].rim) doubtful.push_back(p);
    }
    opened = doubtful.size() > 0 && closed.size() < mesh.triangles.size();
    if (!opened) break;
    judge(mesh, WindingNumber(onlyFaces(mesh, closed)), parts, doubtful);
    opened =
        std::any_of(doubtful.begin(), doubtful.end(), [&](std::size_t p) { return parts[p].open; });
  }
  for (const Part& part : parts) {
    if (!part.open) continue;
    ++result.parts;
    result.triangles += part.faces.size();
    result.open.resize(mesh.triangles.size());
    for (const std::int32_t f : part.faces) result.open[index(f)] = 1;
  }
  return result;
}

OpenParts openParts(const TriangleMesh& mesh) {
  TriangleMesh sound = onlyFaces(mesh, usableTriangles(mesh));
  for (const std::int32_t f : misorientedTriangles(sound)) {
    Triangle& t = sound.triangles[index(f)];
    std::swap(t[1], t[2]);
  }
  return openParts(sound, WindingNumber(sound));
}

std::vector<SideCount> sideCounts(std::size_t triangles, std::size_t open_triangles,
                                  OpenSides sides) {
  std::vector<SideCount> counts;
  if (triangles > open_triangles) counts.push_back({"closed", triangles - open_triangles});
  if (open_triangles > 0)
    counts.push_back({sides == OpenSides::one ? "one-sided" : "two-sided", open_triangles});
  return counts;
}

std::string describeSides(const std::vector<SideCount>& counts) {
  if (counts.size() == 1) return counts[0].sides;
  std::string line;
  for (const SideCount& count : counts)
    line +=
        (line.empty() ? "" : ", ") + std::to_string(count.triangles) + " triangles " + count.sides;
  return line;
}

} // namespace patina
