#include "geometry/mesh/polygon_split.h"

#include <algorithm>
#include <cmath>

#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kMaxCorners = 20'000;      // The time is quadratic in the corners.
constexpr std::size_t kMaxExchangeCorners = 128; // The exchange of edges grows faster still.
constexpr double kMaxHeight = 1e-5;              // height over size of a flat polygon
constexpr double kThin = 1e-12; // twice the area over the square of the longest edge
constexpr double kSpike = 1e-5; // [rad], angle of an outline that reverses
constexpr double kLessFold = 1e-9;

using Corners = std::array<std::size_t, 3>; // indices in the polygon

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool isBefore(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Splits one polygon at a time; reuses its arrays.
class PolygonSplitter {
 public:
  enum class Result { fan, split, crossing, too_long };

  // Fills triangles() unless the result is a fan or too long.
  Result split(const std::vector<Vec3>& points) {
    const std::size_t n = points.size();
    points_.resize(n);
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      points_[i] = points[i] - points[0];
      size = std::max(size, points_[i].cwiseAbs().maxCoeff());
      if (!points_[i].allFinite()) return Result::fan;
    }
    if (!(size > 0)) return Result::fan;
    for (Vec3& p : points_) p /= size;
    normal_ = Vec3::Zero(); // Newell's: twice the projected areas
    for (std::size_t i = 0; i < n; ++i) normal_ += points_[i].cross(points_[(i + 1) % n]);
    if (!(normal_.norm() > kThin)) return Result::fan;
    normal_.normalize();
    const bool flat = isFlat();
    if (flat && fanIsSound()) return Result::fan;
    if (n > kMaxCorners) return Result::too_long;
    start_ = 0;
    for (std::size_t i = 1; i < n; ++i)
      if (isBefore(points[i], points[start_])) start_ = i;
    std::rotate(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(start_),
                points_.end());
    project();
    const bool simple = !crosses();
    clipEars();
    if (!flat && n <= kMaxExchangeCorners) reduceFolds();
    for (Corners& t : triangles_)
      for (std::size_t& corner : t) corner = (corner + start_) % n;
    return simple ? Result::split : Result::crossing;
  }
  const std::vector<Corners>& triangles() const { return triangles_; }

 private:
  bool isFlat() const {
    double low = 0, high = 0;
    for (const Vec3& p : points_) {
      const double height = normal_.dot(p);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low <= kMaxHeight;
  }
  bool fanIsSound() const {
    for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
      const Vec3 &a = points_[k], &b = points_[k + 1]; // The fan's first corner is the origin.
      const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
      if (!(a.cross(b).dot(normal_) > kThin * longest)) return false;
    }
    return true;
  }

  // Projects along the largest component of the normal, so that coordinates stay unchanged.
  void project() {
    int axis = 0;
    normal_.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    flat_.clear();
    for (const Vec3& p : points_)
      flat_.push_back(normal_[axis] > 0 ? Vec2(p[u], p[v]) : Vec2(p[v], p[u]));
  }

  // Returns > 0 for a left turn from a over b to c, 0 if the three are collinear.
  double turn(std::size_t a, std::size_t b, std::size_t c) const {
    const Vec2 ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a], bc = flat_[c] - flat_[b];
    const double twice_area = cross(ab, ac);
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
    return std::abs(twice_area) > kThin * longest ? twice_area : 0;
  }

  enum class Ear { spike, sound, without_area, any };

  bool isEar(std::size_t b, Ear wanted) const {
    const std::size_t a = previous_[b], c = next_[b];
    if (wanted == Ear::spike) { // the outline reverses at b
      const Vec2 ba = flat_[a] - flat_[b], bc = flat_[c] - flat_[b];
      return ba.dot(bc) > 0 && std::abs(cross(ba, bc)) <= kSpike * ba.dot(bc);
    }
    const double area = turn(a, b, c);
    if (wanted == Ear::without_area) return area == 0;
    if (!(area > 0)) return false;
    if (wanted == Ear::any) return true;
    for (std::size_t p = next_[c]; p != a; p = next_[p])
      if (!convex_[p] && blocks(p, a, b, c)) return false;
    return true;
  }
  // Returns true if the outline at corner p enters the triangle or touches its boundary.
  bool blocks(std::size_t p, std::size_t a, std::size_t b, std::size_t c) const {
    if (flat_[p] == flat_[a] || flat_[p] == flat_[c]) return false;
    if (flat_[p] == flat_[b]) return entersAt(b, previous_[p]) || entersAt(b, next_[p]);
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  }
  bool entersAt(std::size_t b, std::size_t p) const {
    return turn(previous_[b], b, p) > 0 && turn(b, next_[b], p) > 0;
  }

  bool crosses() const {
    const std::size_t n = flat_.size();
    const auto divides = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      return turn(a, b, c) * turn(a, b, d) < 0;
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j) {
        const std::size_t b = i + 1, d = (j + 1) % n;
        if (divides(i, b, j, d) && divides(j, d, i, b)) return true;
      }
    return false;
  }

  void clipEars() {
    const std::size_t n = flat_.size();
    triangles_.clear();
    previous_.resize(n);
    next_.resize(n);
    convex_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      previous_[i] = (i + n - 1) % n;
      next_[i] = (i + 1) % n;
    }
    for (std::size_t i = 0; i < n; ++i) convex_[i] = turn(previous_[i], i, next_[i]) > 0;
    std::size_t at = 0;
    bool has_spikes = true; // They go first: whether their corners lie inside an ear is undefined.
    for (std::size_t left = n; left > 3; --left) {
      has_spikes = has_spikes && findEar(at, left, Ear::spike);
      if (!has_spikes && !findEar(at, left, Ear::sound) && !findEar(at, left, Ear::without_area))
        findEar(at, left, Ear::any); // only if the outline crosses itself
      const std::size_t a = previous_[at], c = next_[at];
      triangles_.push_back({a, at, c});
      next_[a] = c;
      previous_[c] = a;
      for (const std::size_t i : {a, c}) convex_[i] = turn(previous_[i], i, next_[i]) > 0;
      at = next_[c]; // Clipping the next ear elsewhere makes fewer slender triangles.
    }
    triangles_.push_back({previous_[at], at, next_[at]});
  }
  // Moves `at` to an ear, or leaves it if there is none.
  bool findEar(std::size_t& at, std::size_t left, Ear wanted) const {
    for (std::size_t tried = 0; tried < left; ++tried, at = next_[at])
      if (isEar(at, wanted)) return true;
    return false;
  }

  Vec3 unitNormal(std::size_t a, std::size_t b, std::size_t c) const {
    return (points_[b] - points_[a]).cross(points_[c] - points_[a]).normalized();
  }
  // Returns the cosine of the fold between the triangles (a, b, c) and (c, d, a).
  double foldCosine(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
    return unitNormal(a, b, c).dot(unitNormal(c, d, a));
  }

  // Flips an edge between two triangles while the other diagonal is folded less.
  void reduceFolds() {
    bool changed = true;
    for (std::size_t pass = 0; changed && pass < triangles_.size(); ++pass) {
      changed = false;
      for (std::size_t i = 0; i < triangles_.size(); ++i)
        for (std::size_t j = i + 1; j < triangles_.size(); ++j)
          changed |= exchangeEdge(triangles_[i], triangles_[j]);
    }
  }
  bool exchangeEdge(Corners& s, Corners& t) const {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t c = s[i], a = s[(i + 1) % 3], b = s[(i + 2) % 3];
        if (t[j] != a || t[(j + 1) % 3] != c) continue;
        const std::size_t d = t[(j + 2) % 3];
        const double cosine = foldCosine(d, a, b, c); // 0 if one has no area
        if (cosine == 0 || !(cosine > foldCosine(a, b, c, d) + kLessFold)) return false;
        s = {d, a, b};
        t = {b, c, d};
        return true;
      }
    return false;
  }

  std::vector<Vec3> points_; // relative to the first corner, in units of the polygon's size
  Vec3 normal_;
  std::size_t start_ = 0; // first corner of the ear clipping
  std::vector<Vec2> flat_;
  std::vector<std::size_t> previous_, next_; // remaining corners, as a ring
  std::vector<char> convex_;
  std::vector<Corners> triangles_;
};

} // namespace

PolygonFaults splitPolygons(TriangleMesh& mesh, const std::vector<PolygonFan>& fans) {
  PolygonFaults faults;
  PolygonSplitter splitter;
  std::vector<std::int32_t> vertices;
  std::vector<Vec2> uvs;
  std::vector<Vec3> points;
  const bool textured = !mesh.corner_uvs.empty();
  for (const PolygonFan& fan : fans) {
    const auto cornerOf = [&](std::size_t i) { // in the fan: a triangle and its corner
      const std::size_t triangle = i < 2 ? 0 : i - 2;
      return std::pair(fan.first_triangle + triangle, i < 2 ? i : std::size_t{2});
    };
    vertices.clear();
    uvs.clear();
    points.clear();
    for (std::size_t i = 0; i < fan.corners; ++i) {
      const auto [t, k] = cornerOf(i);
      vertices.push_back(mesh.triangles[t][k]);
      points.push_back(mesh.positions[static_cast<std::size_t>(vertices.back())]);
      if (textured) uvs.push_back(mesh.corner_uvs[t][k]);
    }
    const PolygonSplitter::Result result = splitter.split(points);
    faults.crossing += result == PolygonSplitter::Result::crossing;
    faults.too_long += result == PolygonSplitter::Result::too_long;
    if (result == PolygonSplitter::Result::fan || result == PolygonSplitter::Result::too_long)
      continue;
    for (std::size_t t = 0; t < splitter.triangles().size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t corner = splitter.triangles()[t][k];
        mesh.triangles[fan.first_triangle + t][k] = vertices[corner];
        if (textured) mesh.corner_uvs[fan.first_triangle + t][k] = uvs[corner];
      }
  }
  return faults;
}

void addPolygonWarnings(const PolygonFaults& faults, std::vector<std::string>& warnings) {
  const auto faces = [](std::size_t n) { return formatCount(n) + (n == 1 ? " face" : " faces"); };
  if (faults.crossing)
    warnings.push_back(faces(faults.crossing) +
                       " with an outline that crosses itself: the split into triangles is a guess");
  if (faults.too_long)
    warnings.push_back(faces(faults.too_long) + " with more than " + formatCount(kMaxCorners) +
                       " corners: split as if convex");
}

} // namespace patina
