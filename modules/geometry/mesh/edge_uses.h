// Lists duplicate faces and the faces at each edge, with vertices at equal positions merged.
// Internal to geometry.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Items in groups by vertex, in one array. Sorting each short group replaces a hash table of all.
template <typename Item> class ByVertex {
 public:
  // forEach(visit) calls visit(vertex, item) for all items, twice the same.
  template <class ForEach> ByVertex(std::size_t vertices, const ForEach& forEach) {
    ends_.resize(vertices + 1);
    forEach([&](std::int32_t vertex, const Item&) { ++ends_[index(vertex) + 1]; });
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    items_.resize(ends_.back());
    std::vector<std::uint32_t> next(ends_.begin(), ends_.end() - 1);
    forEach([&](std::int32_t vertex, const Item& item) { items_[next[index(vertex)]++] = item; });
  }
  // Calls visit(vertex, first, last) for the sorted items of each vertex that has some.
  template <class Visit> void forEachSortedRun(const Visit& visit) {
    for (std::size_t v = 0; v + 1 < ends_.size(); ++v) {
      if (ends_[v] == ends_[v + 1]) continue;
      Item* const first = items_.data() + ends_[v];
      Item* const last = items_.data() + ends_[v + 1];
      std::sort(first, last);
      visit(static_cast<std::int32_t>(v), first, last);
    }
  }
  std::span<const Item> at(std::size_t vertex) const {
    return std::span(items_).subspan(ends_[vertex], ends_[vertex + 1] - ends_[vertex]);
  }

 private:
  std::vector<std::uint32_t> ends_;
  std::vector<Item> items_;
};

inline std::size_t vertexCount(const std::vector<Triangle>& triangles) {
  std::int32_t highest = -1;
  for (const Triangle& t : triangles) highest = std::max({highest, t[0], t[1], t[2]});
  return static_cast<std::size_t>(highest + 1);
}

// Returns for each face the lowest face with the same three vertices, which may be itself. Faces
// that do not count have no duplicates.
template <class Counts>
std::vector<std::int32_t> firstDuplicates(const std::vector<Triangle>& triangles,
                                          const Counts& counts) {
  struct Named {
    std::int32_t middle, high, face;
    auto operator<=>(const Named&) const = default;
  };
  std::vector<std::int32_t> first_of(triangles.size());
  std::iota(first_of.begin(), first_of.end(), 0);
  ByVertex<Named> by_lowest(vertexCount(triangles), [&](const auto& visit) {
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      if (!counts(f)) continue;
      Triangle v = triangles[f];
      std::sort(v.begin(), v.end());
      visit(v[0], Named{v[1], v[2], static_cast<std::int32_t>(f)});
    }
  });
  by_lowest.forEachSortedRun([&](std::int32_t, const Named* first, const Named* last) {
    for (const Named* item = first + 1; item < last; ++item)
      if (item[-1].middle == item->middle && item[-1].high == item->high)
        first_of[index(item->face)] = first_of[index(item[-1].face)];
  });
  return first_of;
}

inline std::vector<std::int32_t> firstDuplicates(const std::vector<Triangle>& triangles) {
  return firstDuplicates(triangles, [](std::size_t) { return true; });
}

struct EdgeUse {
  std::int32_t low, high, face;
  std::int32_t edge; // from corner `edge` of the face to the next
  auto operator<=>(const EdgeUse&) const = default;
};

// Calls visit(first, last) for the uses of each edge by the faces that count, in order.
template <class Counts, class Visit>
void forEachEdge(const std::vector<Triangle>& triangles, const Counts& counts, const Visit& visit) {
  ByVertex<EdgeUse> by_lower(vertexCount(triangles), [&](const auto& file) {
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      if (!counts(f)) continue;
      for (std::int32_t k = 0; k < 3; ++k) {
        const std::int32_t a = triangles[f][index(k)], b = triangles[f][index(k == 2 ? 0 : k + 1)];
        const std::int32_t low = std::min(a, b);
        file(low, EdgeUse{low, std::max(a, b), static_cast<std::int32_t>(f), k});
      }
    }
  });
  by_lower.forEachSortedRun([&](std::int32_t, const EdgeUse* first, const EdgeUse* end) {
    while (first != end) {
      const EdgeUse* last = first + 1;
      while (last != end && last->high == first->high) ++last;
      visit(first, last);
      first = last;
    }
  });
}

} // namespace patina
