// Gives equal points one index by a hash of their bits, and so merges the vertices of a mesh.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

class VertexWeld {
 public:
  explicit VertexWeld(std::size_t expected) {
    slots_.resize(std::bit_ceil(2 * expected + 16));
    points_.reserve(expected);
  }

  // Equal means the same bits, but -0 equals 0.
  std::int32_t index(const Vec3& given) {
    const Vec3 point = given.array() + 0.0; // -0 + 0 is +0
    const std::uint64_t hash = hashOf(point);
    const auto tag = static_cast<std::uint32_t>(hash >> 32);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = hash & mask;; at = (at + 1) & mask) {
      Slot& slot = slots_[at];
      if (slot.index < 0) {
        slot = {tag, static_cast<std::int32_t>(points_.size())};
        points_.push_back(point);
        const std::int32_t index = slot.index;
        if (2 * points_.size() > slots_.size()) grow();
        return index;
      }
      if (slot.tag == tag && sameBits(points_[static_cast<std::size_t>(slot.index)], point))
        return slot.index;
    }
  }

  static std::uint64_t hashOf(const Vec3& p) {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[k])) * 0xbf58476d1ce4e5b9u;
      hash ^= hash >> 29;
    }
    return hash * 0x94d049bb133111ebu ^ hash >> 31;
  }

  const std::vector<Vec3>& points() const { return points_; }
  std::vector<Vec3> takePoints() { return std::move(points_); }

 private:
  struct Slot {
    std::uint32_t tag = 0;
    std::int32_t index = -1;
  };

  static bool sameBits(const Vec3& a, const Vec3& b) {
    bool same = true;
    for (int k = 0; k < 3; ++k)
      same &= std::bit_cast<std::uint64_t>(a[k]) == std::bit_cast<std::uint64_t>(b[k]);
    return same;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), Slot{});
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::uint64_t hash = hashOf(points_[i]);
      std::size_t at = hash & mask;
      while (slots_[at].index >= 0) at = (at + 1) & mask;
      slots_[at] = {static_cast<std::uint32_t>(hash >> 32), static_cast<std::int32_t>(i)};
    }
  }

  std::vector<Slot> slots_;
  std::vector<Vec3> points_;
};

// Returns the triangles of a mesh with the first vertex at each position for all that are there.
inline std::vector<Triangle> weldedTriangles(const TriangleMesh& mesh) {
  constexpr std::size_t kMost = std::size_t{1} << 28; // Then hashes have 32 bits.
  // Finds the hashes that occur more than once by bits that fit into the cache: most vertices of a
  // sound mesh are known to be alone by these.
  const std::size_t mask = std::bit_ceil(8 * std::min(mesh.positions.size(), kMost) + 64) - 1;
  std::vector<std::uint64_t> once(mask / 64 + 1), twice(mask / 64 + 1);
  const auto bitOf = [](std::size_t at) { return std::uint64_t{1} << at % 64; };
  std::vector<std::uint32_t> hashes;
  hashes.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    const std::size_t at = VertexWeld::hashOf(p.array() + 0.0) & mask;
    twice[at / 64] |= once[at / 64] & bitOf(at);
    once[at / 64] |= bitOf(at);
    hashes.push_back(static_cast<std::uint32_t>(at));
  }
  VertexWeld weld(mesh.positions.size() / 16);
  std::vector<std::int32_t> first, first_of; // first vertex of each point; of each vertex
  first_of.reserve(mesh.positions.size());
  for (const std::size_t at : hashes) {
    const std::size_t v = first_of.size();
    first_of.push_back(static_cast<std::int32_t>(v));
    if (!(twice[at / 64] & bitOf(at))) continue;
    const auto place = static_cast<std::size_t>(weld.index(mesh.positions[v]));
    if (place == first.size()) first.push_back(first_of[v]);
    first_of[v] = first[place];
  }
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles)
    for (std::int32_t& v : t) v = first_of[static_cast<std::size_t>(v)];
  return triangles;
}

} // namespace patina
