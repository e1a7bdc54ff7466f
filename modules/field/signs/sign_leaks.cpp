#include "field/signs/sign_leaks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace patina::signs {
namespace {

// Lowest index of the vertices at each vertex's position.
std::vector<std::int32_t> welded(const std::vector<Vec3>& positions) {
  std::vector<std::int32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](std::int32_t v) -> const Vec3& {
    return positions[static_cast<std::size_t>(v)];
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    for (int k = 0; k < 3; ++k)
      if (at(a)[k] != at(b)[k]) return at(a)[k] < at(b)[k];
    return a < b;
  });
  std::vector<std::int32_t> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && at(order[i]) == at(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

} // namespace

bool isClosed(const TriangleMesh& mesh, const OpenParts& open) {
  for (const PartSides& part : open.decided)
    if (part.sides == OpenSides::closed && part.rim_edges > 0) return false;
  const std::vector<std::int32_t> vertex = welded(mesh.positions);
  std::vector<Triangle> faces;
  faces.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (open.any() && open.open[f]) continue;
    const Triangle& t = mesh.triangles[f];
    Triangle face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = vertex[static_cast<std::size_t>(t[k])];
    std::sort(face.begin(), face.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * faces.size());
  for (const Triangle& face : faces) {
    const auto a = static_cast<std::uint64_t>(face[0]), b = static_cast<std::uint64_t>(face[1]),
               c = static_cast<std::uint64_t>(face[2]);
    if (a != b) edges.push_back(a << 32 | b);
    if (b != c) edges.push_back(b << 32 | c);
    if (a != c) edges.push_back(a << 32 | c);
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i == 1) return false;
    i = j;
  }
  return true;
}

std::vector<std::int8_t> cutLeaks(const Components& components, const std::vector<float>& opinion) {
  // How often the walk ends at a node, against one step along an edge.
  constexpr float kTrust = 0.1F;
  constexpr int kSweeps = 40;
  const std::size_t parts = components.parts.size();
  std::vector<std::uint32_t> offset(parts + 1);
  for (const Link& link : components.links) {
    if (std::isnan(opinion[link.a])) continue;
    ++offset[link.a + 1];
    ++offset[link.b + 1];
  }
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  struct Neighbour {
    std::uint32_t part;
    float edges;
  };
  std::vector<Neighbour> neighbours(offset.back());
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (const Link& link : components.links) {
    if (std::isnan(opinion[link.a])) continue;
    neighbours[next[link.a]++] = {link.b, static_cast<float>(link.edges)};
    neighbours[next[link.b]++] = {link.a, static_cast<float>(link.edges)};
  }

  std::vector<float> value = opinion;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < parts; ++i) {
      if (std::isnan(opinion[i])) continue;
      const Part& part = components.parts[i];
      const float own = kTrust * static_cast<float>(part.slot < 0 ? kBlockNodes : part.nodes) *
                        std::abs(opinion[i]);
      float sum = opinion[i] < 0 ? -own : own;
      float weight = own;
      for (std::uint32_t n = offset[i]; n < offset[i + 1]; ++n) {
        sum += neighbours[n].edges * value[neighbours[n].part];
        weight += neighbours[n].edges;
      }
      if (weight > 0) value[i] = sum / weight;
    }
  }
  std::vector<std::int8_t> sign(parts);
  for (std::size_t i = 0; i < parts; ++i)
    if (!std::isnan(opinion[i])) sign[i] = value[i] > 0 ? -1 : 1;
  return sign;
}

} // namespace patina::signs
