#include "authoring/brush/near_texels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace patina {
namespace {

constexpr double kNear = 1.5;      // footprints
constexpr std::int64_t kReach = 3; // cells either way: what bounds the time of uneven maps

struct Cell {
  std::int64_t x, y, z;
};

// Points in cells of a cube's lattice, sorted so that a row along x is one run.
class Cells {
 public:
  Cells(const std::vector<NearTexel>& texels, double side) : side_(side) {
    Box3 box;
    for (const NearTexel& texel : texels) box.extend(texel.point);
    origin_ = box.min();
    for (std::size_t n = 0; n < texels.size(); ++n)
      if (texels[n].inside) entries_.push_back({key(cellOf(texels[n].point)), n});
    std::sort(entries_.begin(), entries_.end());
  }

  Cell cellOf(const Vec3& p) const {
    const Vec3 q = ((p - origin_) / side_).cwiseMin(1e6);
    return {static_cast<std::int64_t>(q[0]), static_cast<std::int64_t>(q[1]),
            static_cast<std::int64_t>(q[2])};
  }
  template <typename Visit> void forRow(Cell from, std::int64_t to_x, const Visit& visit) const {
    if (from.y < 0 || from.z < 0) return;
    const std::uint64_t last = key({to_x, from.y, from.z});
    from.x = std::max<std::int64_t>(from.x, 0);
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{key(from), 0});
    for (; entry != entries_.end() && entry->key <= last; ++entry) visit(entry->texel);
  }

 private:
  struct Entry {
    std::uint64_t key;
    std::size_t texel;
    auto operator<=>(const Entry&) const = default;
  };
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.z << 42 | c.y << 21 | c.x);
  }
  double side_;
  Vec3 origin_;
  std::vector<Entry> entries_;
};

double cellSide(const std::vector<NearTexel>& texels) {
  std::vector<double> footprints;
  for (const NearTexel& texel : texels) footprints.push_back(texel.footprint);
  const auto low = footprints.begin() + static_cast<std::ptrdiff_t>(footprints.size() / 10);
  std::nth_element(footprints.begin(), low, footprints.end());
  return kNear * *low;
}

} // namespace

std::vector<std::array<double, 4>> meansOfNeighbours(const std::vector<NearTexel>& texels) {
  std::vector<std::array<double, 4>> means(texels.size());
  for (std::size_t n = 0; n < texels.size(); ++n) means[n] = texels[n].values;
  if (texels.empty()) return means;
  const double side = cellSide(texels);
  if (!(side > 0)) return means;
  const Cells cells(texels, side);
  for (std::size_t n = 0; n < texels.size(); ++n) {
    const NearTexel& texel = texels[n];
    const double radius = kNear * texel.footprint;
    const auto span = std::min(kReach, static_cast<std::int64_t>(std::ceil(radius / side)));
    const Cell cell = cells.cellOf(texel.point);
    std::array<double, 4> sum{};
    int count = 0;
    for (std::int64_t z = cell.z - span; z <= cell.z + span; ++z)
      for (std::int64_t y = cell.y - span; y <= cell.y + span; ++y)
        cells.forRow({cell.x - span, y, z}, cell.x + span, [&](std::size_t m) {
          const NearTexel& other = texels[m];
          if (m == n || (other.point - texel.point).squaredNorm() > radius * radius ||
              other.normal.dot(texel.normal) < 0)
            return;
          for (std::size_t c = 0; c < 4; ++c) sum[c] += other.values[c];
          ++count;
        });
    for (std::size_t c = 0; c < 4 && count > 0; ++c) means[n][c] = sum[c] / count;
  }
  return means;
}

} // namespace patina
