#include "geometry/sides/open_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <tbb/parallel_for.h>

#include "geometry/mesh/disjoint_sets.h"
#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/holes.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/orientation.h"
#include "geometry/mesh/point_grid.h"
#include "geometry/sides/inner_faces.h"

namespace patina {
namespace {

constexpr double kTells = 0.35;          // least distance of a winding number from 1/2
constexpr std::size_t kMaxSamples = 256; // sampled faces of a part
constexpr double kShares[] = {0.25, 0.5, 1};
constexpr std::size_t kMinFaces = 4; // smallest part with an inside of its own

// Returns true if every edge has as many faces in one direction as in the other. Sums the edges'
// hashes, so that a sound mesh costs next to nothing.
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
  bool joined = false;            // assembled from loose pieces
  double decided = 0, before = 0; // area with a known inside; of it, with the inside in front
};

struct Sample {
  std::size_t part;
  std::int32_t face;
  double area = 0;
  bool decided = false, before = false;
};

// `off`: distance of both query points from the surface.
Sample sampleOf(const TriangleMesh& mesh, const WindingNumber& winding, std::size_t part,
                std::int32_t face, double off) {
  const Vec3 a = mesh.corner(index(face), 0), b = mesh.corner(index(face), 1),
             c = mesh.corner(index(face), 2);
  const Vec3 normal = (b - a).cross(c - a);
  const double doubled = normal.norm();
  const Vec3 step = (off > 0 ? off / doubled : 1e-3 / std::sqrt(doubled)) * normal;
  const Vec3 centre = (a + b + c) / 3;
  const double before = std::abs(winding.at(centre + step)) - 0.5,
               behind = std::abs(winding.at(centre - step)) - 0.5;
  const bool decided = std::abs(before) >= kTells && std::abs(behind) >= kTells &&
                       (!(off > 0) || (before > 0) != (behind > 0));
  return {part, face, doubled, decided, decided && before > 0};
}

// Opens a part if the winding number distinguishes the sides of less than half its area, at a
// distance `off` [m] from the surface; 0: 1e-3 of each face's size.
void judgeAt(double off, const TriangleMesh& mesh, const WindingNumber& winding,
             std::vector<Part>& parts, const std::vector<std::size_t>& asked) {
  std::vector<Sample> samples;
  for (const std::size_t p : asked) {
    const auto& faces = parts[p].faces;
    const std::size_t count = std::min(faces.size(), kMaxSamples);
    for (std::size_t i = 0; i < count; ++i) samples.push_back({p, faces[i * faces.size() / count]});
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 32), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      samples[i] = sampleOf(mesh, winding, samples[i].part, samples[i].face, off);
  });
  std::vector<double> area(parts.size());
  for (const std::size_t p : asked) parts[p].decided = parts[p].before = 0;
  for (const Sample& sample : samples) {
    area[sample.part] += sample.area;
    if (sample.decided) parts[sample.part].decided += sample.area;
    if (sample.before) parts[sample.part].before += sample.area;
  }
  for (const std::size_t p : asked) parts[p].open = 2 * parts[p].decided < area[p];
}

// Near the surface, overlapping loose pieces dominate the winding number, so joined parts are also
// judged farther off, up to `reach`.
void judge(const TriangleMesh& mesh, const WindingNumber& winding, std::vector<Part>& parts,
           std::vector<std::size_t> asked, double reach) {
  judgeAt(0, mesh, winding, parts, asked);
  for (const double share : kShares) {
    std::erase_if(asked, [&](std::size_t p) { return !parts[p].joined || !parts[p].open; });
    if (asked.empty()) return;
    judgeAt(share * reach, mesh, winding, parts, asked);
  }
}

// Detects parts that only seem to enclose a volume, such as two parallel sheets: the inside would
// lie in front of one and behind the other, and neither area exceeds twice the other.
bool turnBothWays(const std::vector<Part>& parts, const std::vector<std::size_t>& asked) {
  double before = 0, decided = 0;
  for (const std::size_t p : asked) {
    if (parts[p].open) continue;
    before += parts[p].before;
    decided += parts[p].decided;
  }
  return 4 * std::min(before, decided - before) > decided;
}

// Does not share corners.
TriangleMesh onlyFaces(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  TriangleMesh only;
  for (const std::int32_t f : faces) {
    const auto first = static_cast<std::int32_t>(only.positions.size());
    for (int k = 0; k < 3; ++k) only.positions.push_back(mesh.corner(index(f), k));
    only.triangles.push_back({first, first + 1, first + 2});
  }
  return only;
}

// Decides which of the parts with a boundary are open.
void decide(const TriangleMesh& mesh, const WindingNumber& winding, std::vector<Part>& parts,
            double reach) {
  std::vector<std::size_t> asked;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (parts[p].rim) asked.push_back(p);
  judge(mesh, winding, parts, asked, reach);
  if (turnBothWays(parts, asked))
    for (const std::size_t p : asked) parts[p].open = true;
  // Other parts, such as a terrain beneath, may hide that a part has an inside of its own.
  for (const std::size_t p : asked) {
    if (!parts[p].open || parts[p].faces.size() < kMinFaces || parts.size() == 1) continue;
    judge(mesh, WindingNumber(onlyFaces(mesh, parts[p].faces)), parts, {p}, reach);
  }
  // Open parts may also feign an inside, so the closed parts are judged again without them.
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
    judge(mesh, WindingNumber(onlyFaces(mesh, closed)), parts, doubtful, reach);
    opened =
        std::any_of(doubtful.begin(), doubtful.end(), [&](std::size_t p) { return parts[p].open; });
  }
}

// Returns for each vertex the lowest one it is merged with, at most `reach` away, along joined
// boundaries.
std::vector<std::int32_t> nearVertices(const TriangleMesh& mesh, const ConnectedParts& found,
                                       const std::vector<const RimEdge*>& rims, double reach) {
  std::vector<std::uint8_t> asked(mesh.positions.size());
  for (const RimEdge* rim : rims)
    if (found.parts[index(found.part_of[index(rim->face)])].joined)
      for (const std::int32_t v : rim->vertices) asked[index(v)] = 1;
  std::vector<std::int32_t> vertices;
  for (std::size_t v = 0; v < asked.size(); ++v)
    if (asked[v]) vertices.push_back(static_cast<std::int32_t>(v));
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const std::int32_t v : vertices) points.push_back(mesh.positions[index(v)]);
  double length = 0;
  for (const RimEdge* rim : rims)
    length +=
        (mesh.positions[index(rim->vertices[0])] - mesh.positions[index(rim->vertices[1])]).norm();
  // Less than half an edge, so that no hole closes.
  const double near = std::min(reach, 0.4 * length / static_cast<double>(rims.size()));
  const PointGrid grid(points, near);
  DisjointSets sets(mesh.positions.size());
  grid.forEachPair(near, [&](std::size_t n, std::size_t m) {
    sets.join(vertices[grid.point(n)], vertices[grid.point(m)]);
  });
  return std::move(sets).lowest();
}

std::vector<Hole> closedOver(const TriangleMesh& mesh, const ConnectedParts& found,
                             const std::vector<std::uint8_t>& open, double reach, double min_area) {
  std::vector<const RimEdge*> rims;
  for (const RimEdge& rim : found.rims)
    if (!rim.covered && (open.empty() || !open[index(rim.face)])) rims.push_back(&rim);
  if (rims.empty()) return {};
  const std::vector<std::int32_t> vertex = nearVertices(mesh, found, rims, reach);
  std::vector<std::int32_t> point_of(mesh.positions.size(), -1);
  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const RimEdge* rim : rims) {
    std::array<std::int32_t, 2> edge{};
    for (std::size_t k = 0; k < 2; ++k) {
      std::int32_t& point = point_of[index(vertex[index(rim->vertices[k])])];
      if (point < 0) {
        point = static_cast<std::int32_t>(points.size());
        points.push_back(mesh.positions[index(vertex[index(rim->vertices[k])])]);
      }
      edge[k] = point;
    }
    if (edge[0] != edge[1]) edges.push_back(edge);
  }
  return holesOf(points, edges, min_area);
}

// Removes loops that are no holes: those that edges of loose pieces form by chance, and cracks. In
// the middle of a hole the winding number is about a half; inside and outside a body it is an
// integer.
void dropLoopsOfChance(const WindingNumber& winding, std::vector<Hole>& holes) {
  constexpr double kHole = 0.35; // largest distance from a half
  std::erase_if(holes, [&](const Hole& hole) {
    const double around = std::abs(winding.at(hole.on));
    return std::abs(around - std::floor(around) - 0.5) > kHole;
  });
}

} // namespace

OpenParts openParts(const TriangleMesh& mesh, const std::vector<Triangle>& triangles,
                    const WindingNumber& winding, OpenSides sides, double reach) {
  OpenParts result;
  if (isBalanced(triangles)) return result;
  const TriangleMesh welded{mesh.positions, triangles, {}};
  ConnectedParts found = connectedParts(welded, reach);
  result.gap = found.gap;
  std::vector<Part> parts;
  for (ConnectedPart& part : found.parts)
    parts.push_back({std::move(part.faces), part.rim_edges > 0, false, part.joined});
  if (decidesItself(sides)) decide(mesh, winding, parts, reach);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Part& part = parts[p];
    const bool twisted = found.parts[p].twisted && sides == OpenSides::two;
    const bool asked = !decidesItself(sides) && (part.rim || twisted);
    if (asked) part.open = sides != OpenSides::closed;
    const OpenSides own = !part.open            ? OpenSides::closed
                          : haveTwoSides(sides) ? OpenSides::two
                                                : OpenSides::one;
    result.decided.push_back(
        {part.faces.size(), found.parts[p].rim_edges, own, asked, part.joined});
    if (!part.open) continue;
    ++result.parts;
    result.triangles += part.faces.size();
    result.open.resize(mesh.triangles.size());
    for (const std::int32_t f : part.faces) result.open[index(f)] = 1;
  }
  for (const RimEdge& rim : found.rims)
    if (rim.covered) result.seams.push_back({rim.face, rim.edge});
  // Ignores holes between loose pieces that are smaller than a square of side `reach`.
  const bool loose = std::any_of(found.parts.begin(), found.parts.end(),
                                 [](const auto& part) { return part.joined; });
  result.holes = closedOver(welded, found, result.open, reach, loose ? reach * reach : 0);
  dropLoopsOfChance(winding, result.holes);
  return result;
}

OpenParts openParts(const TriangleMesh& mesh, OpenSides sides, double reach) {
  // The mesh is copied only if it changes, and without edges of one face nothing is open.
  std::optional<TriangleMesh> changed;
  const auto sound = [&]() -> const TriangleMesh& { return changed ? *changed : mesh; };
  const auto change = [&]() -> TriangleMesh& { return changed ? *changed : changed.emplace(mesh); };
  const std::vector<std::int32_t> usable = usableTriangles(mesh);
  if (usable.size() < mesh.triangles.size()) {
    for (Vec3& p : change().positions)
      if (!p.allFinite()) p.setZero();
    changed->triangles.clear();
    for (const std::int32_t f : usable) changed->triangles.push_back(mesh.triangles[index(f)]);
  }
  std::vector<Triangle> welded = weldedTriangles(sound());
  const std::vector<std::int32_t> inner = innerFaces(sound(), welded);
  if (!inner.empty())
    for (auto* triangles : {&change().triangles, &welded}) {
      for (const std::int32_t f : inner) (*triangles)[index(f)] = {-1, -1, -1};
      std::erase(*triangles, Triangle{-1, -1, -1});
    }
  for (const std::int32_t f : misorientedTriangles(sound(), welded))
    for (auto* triangles : {&change().triangles, &welded})
      std::swap((*triangles)[index(f)][1], (*triangles)[index(f)][2]);
  OpenParts result;
  if (!isBalanced(welded))
    result = openParts(sound(), welded, WindingNumber(sound()), sides, reach);
  result.inner_triangles = inner.size();
  return result;
}

const char* sideName(OpenSides sides) {
  return sides == OpenSides::two ? "two-sided" : sides == OpenSides::one ? "one-sided" : "closed";
}

std::string describeParts(const std::vector<PartSides>& parts) {
  std::map<std::pair<bool, OpenSides>, std::size_t> counts;
  for (const PartSides& part : parts) ++counts[{!part.asked, part.sides}];
  std::string line;
  for (const auto& [kind, count] : counts)
    line += (line.empty() ? "" : ", ") + std::to_string(count) +
            (count == 1 ? " part " : " parts ") + sideName(kind.second) +
            (kind.first ? " by the program" : " as asked");
  return line.empty() ? "all closed by the program: no edge has one triangle" : line;
}

std::vector<SideCount> sideCounts(std::size_t triangles, std::size_t open_triangles,
                                  OpenSides sides) {
  std::vector<SideCount> counts;
  if (triangles > open_triangles) counts.push_back({"closed", triangles - open_triangles});
  if (open_triangles > 0)
    counts.push_back(
        {sideName(haveTwoSides(sides) ? OpenSides::two : OpenSides::one), open_triangles});
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
