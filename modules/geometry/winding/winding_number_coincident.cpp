// Finds exactly coincident triangles and drops the redundant ones.
#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "geometry/winding/winding_number_tree.h"

namespace patina::winding {

namespace {

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Sorted corner positions; odd: the order is an odd permutation of the mesh's.
struct Corners {
  std::array<Vec3, 3> at;
  bool odd = false;

  Corners(const TriangleMesh& mesh, std::size_t triangle)
      : at{mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)} {
    const auto order = [&](std::size_t i, std::size_t j) {
      if (!before(at[j], at[i])) return;
      std::swap(at[i], at[j]);
      odd = !odd;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
  }
};

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      // + 0.0 turns -0 into 0.
      h = (h ^ std::bit_cast<std::uint64_t>(p[i] + 0.0)) * 0x9e3779b97f4a7c15ULL;
      h ^= h >> 32;
    }
    return h;
  }
};

// Parts connected through vertices at equal positions.
class Parts {
 public:
  explicit Parts(const TriangleMesh& mesh) : mesh_(mesh), parent_(mesh.positions.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    std::unordered_map<Vec3, std::int32_t, PositionHash> seen;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const auto [at, is_new] = seen.emplace(mesh.positions[v], static_cast<std::int32_t>(v));
      if (!is_new) join(static_cast<std::int32_t>(v), at->second);
    }
    for (const Triangle& t : mesh.triangles) {
      join(t[0], t[1]);
      join(t[0], t[2]);
    }
  }
  std::int32_t of(std::uint32_t triangle) { return find(mesh_.triangles[triangle][0]); }

 private:
  std::int32_t& up(std::int32_t v) { return parent_[static_cast<std::size_t>(v)]; }
  std::int32_t find(std::int32_t v) {
    while (up(v) != v) v = up(v) = up(up(v));
    return v;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    up(std::max(a, b)) = std::min(a, b);
  }
  const TriangleMesh& mesh_;
  std::vector<std::int32_t> parent_;
};

} // namespace

std::vector<Item> withoutCoincident(const TriangleMesh& mesh, std::vector<Item> items) {
  std::size_t kept = 0;
  std::vector<std::size_t> cancelled; // indices among the kept
  std::vector<std::pair<Corners, std::uint32_t>> run;
  for (std::size_t begin = 0; begin < items.size();) {
    const std::uint32_t code = items[begin].code;
    std::size_t end = begin + 1;
    while (end < items.size() && items[end].code == code) ++end;
    if (end == begin + 1) {
      items[kept++] = items[begin++];
      continue;
    }
    run.clear();
    for (; begin < end; ++begin) {
      const std::uint32_t triangle = items[begin].triangle;
      run.emplace_back(Corners(mesh, triangle), triangle);
    }
    // Sorting makes coincident triangles neighbours, the lowest index first.
    std::sort(run.begin(), run.end(), [](const auto& a, const auto& b) {
      for (std::size_t k = 0; k < 3; ++k)
        if (a.first.at[k] != b.first.at[k]) return before(a.first.at[k], b.first.at[k]);
      return a.second < b.second;
    });
    for (std::size_t i = 0; i < run.size();) {
      int net = 0; // triangles facing as the first does minus the others
      std::size_t j = i;
      for (; j < run.size() && run[j].first.at == run[i].first.at; ++j)
        net += run[j].first.odd == run[i].first.odd ? 1 : -1;
      if (net == 0) cancelled.push_back(kept);
      items[kept++] = {code, run[i].second & 0x7FFFFFFFU, net < 0 ? 1U : 0U};
      i = j;
    }
  }
  items.resize(kept);
  if (cancelled.empty()) return items;

  struct Tally {
    std::size_t all = 0;
    std::size_t cancelled = 0;
  };
  Parts parts(mesh);
  std::unordered_map<std::int32_t, Tally> tallies;
  for (const Item& item : items) ++tallies[parts.of(item.triangle)].all;
  for (std::size_t place : cancelled) ++tallies[parts.of(items[place].triangle)].cancelled;
  std::vector<bool> drop(items.size());
  for (std::size_t place : cancelled) {
    const Tally& tally = tallies[parts.of(items[place].triangle)];
    drop[place] = 2 * tally.cancelled <= tally.all;
  }
  kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!drop[i]) items[kept++] = items[i];
  items.resize(kept);
  return items;
}

} // namespace patina::winding
