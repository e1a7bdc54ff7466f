#include "geometry/atlas/uv_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

using Corners = std::array<Vec2, 3>;
using Faces = std::vector<std::int32_t>;
using Box2 = Eigen::AlignedBox2d;

constexpr std::size_t kLeafFaces = 16; // below this, comparing all pairs costs less than splitting
constexpr std::size_t kTaskFaces = 4096; // a cell with more faces searches its quarters in parallel

Corners counterClockwise(Corners uv) {
  if (cross(uv[1] - uv[0], uv[2] - uv[0]) < 0) std::swap(uv[1], uv[2]);
  return uv;
}

bool isNarrow(const Corners& uv) {
  const double doubled_area = cross(uv[1] - uv[0], uv[2] - uv[0]);
  const double longest2 = std::max({(uv[1] - uv[0]).squaredNorm(), (uv[2] - uv[1]).squaredNorm(),
                                    (uv[0] - uv[2]).squaredNorm()});
  return !(doubled_area > kUvResolution * std::sqrt(longest2));
}

// Whether all points lie right of an edge of a counter-clockwise face, or left by `margin` at most.
template <class Points> bool isParted(const Corners& face, const Points& points, double margin) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 along = face[(k + 1) % 3] - face[k];
    const double limit = margin > 0 ? margin * along.norm() : 0;
    if (std::all_of(points.begin(), points.end(),
                    [&](const Vec2& p) { return cross(along, p - face[k]) <= limit; }))
      return true;
  }
  return false;
}

Box2 boxOf(const Corners& uv) {
  return Box2(uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]), uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]));
}

bool overlap(const Corners& a, const Corners& b) {
  const Box2 box_a = boxOf(a), box_b = boxOf(b);
  const Vec2 common = box_a.max().cwiseMin(box_b.max()) - box_a.min().cwiseMax(box_b.min());
  return common.minCoeff() > kUvResolution && !isParted(a, b, kUvResolution) &&
         !isParted(b, a, kUvResolution);
}

std::array<Vec2, 4> cornersOf(const Box2& cell) {
  return {cell.min(), Vec2(cell.max()[0], cell.min()[1]), cell.max(),
          Vec2(cell.min()[0], cell.max()[1])};
}

bool covers(const Corners& face, const std::array<Vec2, 4>& cell) {
  for (std::size_t k = 0; k < 3; ++k)
    for (const Vec2& p : cell)
      if (cross(face[(k + 1) % 3] - face[k], p - face[k]) < 0) return false;
  return true;
}

class Search {
 public:
  explicit Search(const CornerUvs& uvs) : corners_(uvs.size()) {
    tbb::parallel_for(std::size_t{0}, uvs.size(),
                      [&](std::size_t f) { corners_[f] = counterClockwise(uvs[f]); });
  }

  std::optional<UvOverlap> run() const {
    Faces faces;
    for (std::size_t f = 0; f < corners_.size(); ++f)
      if (!isNarrow(corners_[f])) faces.push_back(static_cast<std::int32_t>(f));
    return in(Box2(Vec2::Zero().eval(), Vec2::Ones().eval()), faces);
  }

 private:
  struct Quarter {
    Box2 cell;
    Faces faces;
    std::optional<UvOverlap> found;
  };

  std::optional<UvOverlap> in(const Box2& cell, const Faces& faces) const {
    // Where many lie on one another the first few do.
    if (auto found = amongFirst(faces); found || faces.size() <= kLeafFaces) return found;
    if (cell.sizes()[0] <= kUvResolution) return std::nullopt;
    if (const auto hub = hubOf(faces)) return inFan(*hub, faces);
    std::array<Quarter, 4> quarters;
    const auto forQuarters = [&](const auto& visit) {
      if (faces.size() > kTaskFaces)
        tbb::parallel_for(std::size_t{0}, quarters.size(), visit);
      else
        for (std::size_t q = 0; q < quarters.size(); ++q) visit(q);
    };
    const auto firstFound = [&]() -> std::optional<UvOverlap> {
      for (const Quarter& quarter : quarters)
        if (quarter.found) return quarter.found;
      return std::nullopt;
    };
    forQuarters([&](std::size_t q) { quarters[q] = quarterOf(cell, faces, q); });
    if (const auto found = firstFound()) return found;
    forQuarters(
        [&](std::size_t q) { quarters[q].found = in(quarters[q].cell, quarters[q].faces); });
    return firstFound();
  }

  Quarter quarterOf(const Box2& whole, const Faces& faces, std::size_t quarter) const {
    const Vec2 low(quarter & 1 ? whole.center()[0] : whole.min()[0],
                   quarter & 2 ? whole.center()[1] : whole.min()[1]);
    Quarter result{Box2(low, (low + whole.sizes() / 2).eval()), {}, std::nullopt};
    const std::array<Vec2, 4> corners = cornersOf(result.cell);
    std::int32_t cover = kNone;
    for (const std::int32_t f : faces) {
      const Corners& face = corners_[index(f)];
      if (!boxOf(face).intersects(result.cell) || isParted(face, corners, 0)) continue;
      result.faces.push_back(f);
      if (!covers(face, corners)) continue;
      // Two faces that hold the whole cell would be in all of its quarters for ever.
      if (cover != kNone && overlap(corners_[index(cover)], face)) {
        result.found = UvOverlap{cover, f};
        break;
      }
      cover = f;
    }
    return result;
  }

  // The corner that all faces have, if there is one.
  std::optional<Vec2> hubOf(const Faces& faces) const {
    for (const Vec2& hub : corners_[index(faces[0])])
      if (std::all_of(faces.begin(), faces.end(), [&](std::int32_t f) {
            const Corners& uv = corners_[index(f)];
            return uv[0] == hub || uv[1] == hub || uv[2] == hub;
          }))
        return hub;
    return std::nullopt;
  }

  // Faces round a hub, in the order of the angles where they begin: one overlaps those that begin
  // before it ends, or none.
  std::optional<UvOverlap> inFan(const Vec2& hub, const Faces& faces) const {
    constexpr double kTurn = 2 * std::numbers::pi;
    struct Sector {
      double from, to;
      std::int32_t face;
    };
    std::vector<Sector> sectors;
    for (const std::int32_t f : faces) {
      const Corners& uv = corners_[index(f)];
      const std::size_t k = uv[0] == hub ? 0 : uv[1] == hub ? 1 : 2;
      const Vec2 first = uv[(k + 1) % 3] - hub, last = uv[(k + 2) % 3] - hub;
      const double from = std::atan2(first[1], first[0]);
      const double to = from + std::atan2(cross(first, last), first.dot(last));
      sectors.push_back({from, to, f});
      sectors.push_back({from + kTurn, to + kTurn, f}); // for those that end beyond a whole turn
    }
    std::sort(sectors.begin(), sectors.end(), [](const Sector& a, const Sector& b) {
      return std::tie(a.from, a.face) < std::tie(b.from, b.face);
    });
    for (std::size_t i = 0; i < sectors.size(); ++i)
      for (std::size_t j = i + 1; j < sectors.size() && sectors[j].from < sectors[i].to; ++j) {
        const std::int32_t a = sectors[i].face, b = sectors[j].face;
        if (overlap(corners_[index(a)], corners_[index(b)]))
          return UvOverlap{std::min(a, b), std::max(a, b)};
      }
    return std::nullopt;
  }

  std::optional<UvOverlap> amongFirst(const Faces& faces) const {
    const std::size_t count = std::min(faces.size(), kLeafFaces);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        if (overlap(corners_[index(faces[i])], corners_[index(faces[j])]))
          return UvOverlap{faces[i], faces[j]};
    return std::nullopt;
  }

  std::vector<Corners> corners_; // counter-clockwise
};

} // namespace

std::optional<UvOverlap> findUvOverlap(const CornerUvs& uvs) {
  return Search(uvs).run();
}

} // namespace patina
