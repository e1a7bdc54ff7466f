// Paths of the trials: see contact_trials.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "app/studies/contact/contact_trials.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

constexpr double kAbove = 3e-3; // start height of a touch [m]
constexpr double kShutIn = 0.2; // winding number, well below the threshold of the inside

// Appends steps of at most `step` from the last point of the path.
void walk(std::vector<Vec3>& path, const Vec3& to, double step) {
  const Vec3 from = path.back();
  const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step)));
  for (int i = 1; i <= count; ++i)
    path.push_back(from + static_cast<double>(i) / count * (to - from));
}

Vec3 outOf(const ExactSurface::Nearest& near, const Vec3& p) {
  if (std::abs(near.distance) < 1e-7) return near.outward;
  return (p - near.point) / near.distance;
}

} // namespace

TouchPaths::TouchPaths(const ExactSurface& surface, double iso, unsigned seed)
    : surface_(surface), iso_(iso), random_(seed) {
  double area = 0;
  bool closed = true;
  TriangleMesh all;
  for (const TriangleMesh& mesh : surface.meshes()) {
    closed = closed && inspect(mesh).watertight;
    all = joined(all, mesh);
    // Maps an edge to the face on its left until that on its right is found.
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> left;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
      area += 0.5 * (b - a).cross(c - a).norm();
      faces_.push_back({area, {a, faceNormal(mesh, f)}});
      corners_.push_back({a, b, c});
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t from = mesh.triangles[f][k], to = mesh.triangles[f][(k + 1) % 3];
        left[{from, to}] = f;
        const auto other = left.find({to, from});
        if (other == left.end()) continue;
        const Vec3 n = faceNormal(mesh, f), m = faceNormal(mesh, other->second);
        if (n.dot(m) < std::cos(20 * std::numbers::pi / 180))
          creases_.push_back({mesh.positions[static_cast<std::size_t>(from)],
                              mesh.positions[static_cast<std::size_t>(to)], n, m});
      }
    }
  }
  if (!closed) sheets_ = std::make_shared<const WindingNumber>(all);
  if (surface.meshes().size() > 1) findMeetings();
}

// Finds junctions of two meshes: faces outside another mesh and at most 2 mm from it.
void TouchPaths::findMeetings() {
  std::vector<ExactSurface> parts;
  for (const TriangleMesh& mesh : surface_.meshes()) parts.emplace_back(std::vector{mesh});
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t f = 0; f < parts[i].meshes()[0].triangles.size(); ++f) {
      const TriangleMesh& mesh = parts[i].meshes()[0];
      const Vec3 at = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3;
      for (std::size_t j = 0; j < parts.size(); ++j) {
        if (j == i) continue;
        const ExactSurface::Nearest other = parts[j].nearest(at);
        if (other.distance > 0 && other.distance < 2e-3)
          creases_.push_back({at, at, faceNormal(mesh, f), other.outward});
      }
    }
}

double TouchPaths::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random_);
}

Vec3 TouchPaths::direction() {
  std::normal_distribution<double> normal;
  const double x = normal(random_), y = normal(random_), z = normal(random_);
  return Vec3(x, y, z).normalized();
}

TouchPaths::Place TouchPaths::place() {
  const double at = uniform(0, faces_.back().first);
  const auto found =
      std::lower_bound(faces_.begin(), faces_.end(), at,
                       [](const auto& entry, double value) { return entry.first < value; });
  const auto face = static_cast<std::size_t>(std::min(found, faces_.end() - 1) - faces_.begin());
  double u = uniform(0, 1), v = uniform(0, 1);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto& [a, b, c] = corners_[face];
  const double side = !sheets_ || uniform(0, 1) < 0.5 ? 1 : -1;
  return {a + u * (b - a) + v * (c - a), side * faces_[face].second.normal};
}

TouchPaths::Place TouchPaths::placeByACrease() {
  if (creases_.empty()) return place();
  const Crease& crease = creases_[random_() % creases_.size()];
  const double along = uniform(0, 1);
  const double which = uniform(0, 1), side = !sheets_ || uniform(0, 1) < 0.5 ? 1 : -1;
  const Vec3 normal = which < 0.4   ? crease.left
                      : which < 0.8 ? crease.right
                                    : Vec3((crease.left + crease.right).normalized());
  const Vec3 on = crease.a + along * (crease.b - crease.a) + uniform(0, 2e-3) * direction();
  const ExactSurface::Nearest near = surface_.nearest(on);
  return {near.point, side * normal};
}

bool TouchPaths::isFree(const Vec3& from, const Vec3& to, double room) const {
  const double length = (to - from).norm();
  for (double t = 0;;) {
    const double left = surface_.distance(from + t / std::max(length, 1e-12) * (to - from)) - iso_;
    if (left < room) return false;
    if (t >= length) return true;
    t = std::min(length, t + std::max(left, 1e-5));
  }
}

bool TouchPaths::reachable(const Place& place) const {
  if (!(place.normal.norm() > 0.5)) return false;
  const double above = iso_ + kAbove, end = iso_ + 0.3e-3;
  if (sheets_ && std::abs(sheets_->at(place.point + above * place.normal)) > kShutIn) return false;
  return isFree(place.point + above * place.normal, place.point + end * place.normal, 0.05e-3);
}

TouchPaths::Touch TouchPaths::touch() {
  Touch touch;
  Place begin;
  Vec3 start = Vec3::Zero();
  // Starts at the end of the last touch if possible, otherwise anywhere.
  bool chosen = false;
  for (int i = 0; i < 40 && has_last_ && !chosen; ++i) {
    begin = uniform(0, 1) < 0.3 ? placeByACrease() : place();
    if (!reachable(begin)) continue;
    start = begin.point + (iso_ + kAbove) * begin.normal;
    chosen = isFree(last_, start, 0.2e-3);
  }
  touch.fresh = !chosen;
  for (int i = 0; i < 2000 && !chosen; ++i) {
    begin = uniform(0, 1) < 0.3 ? placeByACrease() : place();
    if (!reachable(begin)) continue;
    start = begin.point + (iso_ + kAbove) * begin.normal;
    chosen = true;
  }
  const double speed = 0.01 * std::exp(uniform(0, std::log(50))); // [m/s]
  std::vector<Vec3>& path = touch.tips;
  path.push_back(touch.fresh ? start : last_);
  walk(path, start, 0.5 * kTick);

  const double most = uniform(0.5e-3, 6e-3), least = uniform(0, 1) < 0.3 ? -2e-3 : 0.2 * most;
  const Vec3 slanted = (begin.normal + uniform(0, 0.6) * direction()).normalized();
  Vec3 guide = begin.point + iso_ * begin.normal, normal = slanted;
  walk(path, guide - most * normal, speed * kTick);

  Vec3 heading = direction();
  const double turn = uniform(-60, 60), waves = uniform(5, 60); // [rad/m] of path length
  const double length = uniform(0.01, 0.06);
  const int ticks = static_cast<int>(std::clamp(length / (speed * kTick), 100.0, 500.0));
  for (int i = 0; i < ticks; ++i) {
    const double way = speed * kTick * i;
    const ExactSurface::Nearest near = surface_.nearest(guide);
    const Vec3 out = outOf(near, guide);
    guide += (iso_ - near.distance) * out;
    normal = (normal + std::min(1.0, speed * kTick / 2e-3) * (out - normal)).normalized();
    heading = Eigen::AngleAxisd(turn * speed * kTick, out) * heading;
    heading = (heading - heading.dot(out) * out).normalized();
    guide += speed * kTick * heading;
    const double depth = least + (most - least) * (0.5 + 0.5 * std::cos(waves * way));
    const Vec3 wanted = guide - depth * normal - path.back();
    const double far = wanted.norm(), reach = (1.3 * speed + 0.02) * kTick;
    path.push_back(path.back() + (far > reach ? reach / far : 1.0) * wanted);
  }
  const Vec3 up = guide + kAbove * normal;
  walk(path, up, std::max(speed, 0.1) * kTick);
  last_ = up;
  has_last_ = surface_.distance(up) > iso_ + 0.5e-3;
  return touch;
}

std::vector<Vec3> TouchPaths::loop(const Place& place) {
  const Vec3 above = place.point + (iso_ + kAbove) * place.normal;
  const Vec3 centre = place.point + (iso_ - uniform(0.5e-3, 5e-3)) * place.normal;
  const double radius = 0.3e-3 * std::exp(uniform(0, std::log(10)));
  std::vector<Vec3> corners(3 + random_() % 4);
  for (Vec3& corner : corners) corner = centre + radius * uniform(0.3, 1) * direction();
  std::vector<Vec3> path = {above};
  const double step = 1e-5;
  walk(path, corners[0], step);
  for (int lap = 0; lap < 2; ++lap)
    for (std::size_t i = 1; i <= corners.size(); ++i) walk(path, corners[i % corners.size()], step);
  walk(path, above, step);
  return path;
}

} // namespace patina
