#include "geometry/measure/face_strip.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

double crossOf(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Place in the plane of a point at given distances from two placed ones, on the side of `turn`.
Vec2 unfolded(const Vec2& a2, const Vec2& b2, const Vec3& a, const Vec3& b, const Vec3& p,
              double turn) {
  const Vec3 along = b - a;
  const double length = along.norm();
  if (length <= 0) return a2;
  const double x = (p - a).dot(along) / length;
  const double y = ((p - a) - x / length * along).norm();
  const Vec2 way = (b2 - a2) / length;
  return a2 + x * way + turn * y * Vec2(-way.y(), way.x());
}

// The edge between two faces of a strip, seen along it.
struct Portal {
  std::int32_t left = -1, right = -1; // vertices
  Vec2 left2 = Vec2::Zero(), right2 = Vec2::Zero();
};

std::int32_t thirdOf(const Triangle& face, std::int32_t a, std::int32_t b) {
  for (const std::int32_t v : face)
    if (v != a && v != b) return v;
  return face[0];
}

// The edge of `face` that `next` has too, from corner to corner; {-1, -1}: none.
std::array<std::int32_t, 2> sharedEdge(const Triangle& face, const Triangle& next) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t a = face[k], b = face[(k + 1) % 3];
    const bool both = std::count(next.begin(), next.end(), a) == 1 &&
                      std::count(next.begin(), next.end(), b) == 1;
    if (both) return {a, b};
  }
  return {-1, -1};
}

struct Unfolding {
  std::vector<Portal> portals;
  Vec2 start = Vec2::Zero(), end = Vec2::Zero();
};

Unfolding unfold(const TriangleMesh& mesh, const FaceStrip& strip, const Vec3& start,
                 const Vec3& end) {
  const auto at = [&](std::int32_t v) { return mesh.positions[static_cast<std::size_t>(v)]; };
  const auto face = [&](std::size_t i) {
    return mesh.triangles[static_cast<std::size_t>(strip[i])];
  };
  Unfolding flat;
  // Corners of the first face counter-clockwise: the path leaves by an edge a to b with the face on
  // its left, so a is on the right.
  const auto [a, b] = sharedEdge(face(0), face(1));
  Portal portal{b, a, Vec2((at(b) - at(a)).norm(), 0), Vec2::Zero()};
  flat.start = unfolded(portal.right2, portal.left2, at(a), at(b), start, 1);
  flat.portals.push_back(portal);
  for (std::size_t i = 1; i + 1 < strip.size(); ++i) {
    const std::int32_t third = thirdOf(face(i), portal.left, portal.right);
    const Vec2 third2 =
        unfolded(portal.right2, portal.left2, at(portal.right), at(portal.left), at(third), -1);
    const auto edge = sharedEdge(face(i), face(i + 1));
    const bool keeps_left = edge[0] == portal.left || edge[1] == portal.left;
    if (keeps_left)
      portal.right = third, portal.right2 = third2;
    else
      portal.left = third, portal.left2 = third2;
    flat.portals.push_back(portal);
  }
  flat.end = unfolded(portal.right2, portal.left2, at(portal.right), at(portal.left), end, -1);
  return flat;
}

} // namespace

StripPath shortestInStrip(const TriangleMesh& mesh, const FaceStrip& strip, const Vec3& start,
                          const Vec3& end) {
  StripPath path;
  if (strip.size() < 2) {
    path.points = {start, end};
    path.length = (end - start).norm();
    return path;
  }
  const Unfolding flat = unfold(mesh, strip, start, end);
  const std::size_t count = flat.portals.size();
  const auto left = [&](std::size_t i) { return i < count ? flat.portals[i].left2 : flat.end; };
  const auto right = [&](std::size_t i) { return i < count ? flat.portals[i].right2 : flat.end; };

  // Corners of the path with the portal at which each stands.
  struct Bend {
    Vec2 at;
    std::size_t portal;
    bool is_left;
  };
  std::vector<Bend> bends;
  Vec2 apex = flat.start, to_left = left(0), to_right = right(0);
  std::size_t left_at = 0, right_at = 0;
  for (std::size_t i = 1; i <= count; ++i) {
    const auto restart = [&](const Vec2& corner, std::size_t portal, bool is_left) {
      if (portal < count) bends.push_back({corner, portal, is_left}); // the end is no bend
      apex = to_left = to_right = corner;
      left_at = right_at = i = portal;
    };
    const Vec2 new_left = left(i), new_right = right(i);
    // Each portal moves one side. Testing the other too would fail for a start on an edge, where
    // the funnel is a half plane.
    const bool ends = i == count;
    const bool right_moves = ends || flat.portals[i].right != flat.portals[i - 1].right;
    const bool left_moves = ends || flat.portals[i].left != flat.portals[i - 1].left;
    // The right side narrows the funnel, unless it passes the left side.
    if ((right_moves || apex == to_right) && crossOf(to_right - apex, new_right - apex) >= 0) {
      if (apex == to_right || crossOf(to_left - apex, new_right - apex) < 0) {
        to_right = new_right;
        right_at = i;
      } else {
        restart(to_left, left_at, true);
        continue;
      }
    }
    if ((left_moves || apex == to_left) && crossOf(to_left - apex, new_left - apex) <= 0) {
      if (apex == to_left || crossOf(to_right - apex, new_left - apex) > 0) {
        to_left = new_left;
        left_at = i;
      } else {
        restart(to_right, right_at, false);
        continue;
      }
    }
  }
  // Points where the straight pieces cross the portals.
  path.points.push_back(start);
  std::size_t bend = 0;
  Vec2 from = flat.start;
  for (std::size_t i = 0; i < count; ++i) {
    while (bend < bends.size() && bends[bend].portal < i) from = bends[bend++].at;
    const Vec2 to = bend < bends.size() ? bends[bend].at : flat.end;
    const Portal& portal = flat.portals[i];
    const Vec2 edge = portal.left2 - portal.right2, way = to - from;
    const double slope = crossOf(way, edge);
    double t = crossOf(portal.right2 - from, way) / slope;
    if (!(std::abs(slope) > 1e-12 * way.norm() * edge.norm())) // along the edge
      t = (to - portal.right2).dot(edge) / std::max(edge.squaredNorm(), 1e-300);
    const Vec3& low = mesh.positions[static_cast<std::size_t>(portal.right)];
    const Vec3& high = mesh.positions[static_cast<std::size_t>(portal.left)];
    if (bend < bends.size() && bends[bend].portal == i) t = bends[bend].is_left ? 1 : 0;
    path.points.push_back(low + std::clamp(t, 0.0, 1.0) * (high - low));
  }
  path.points.push_back(end);
  Vec2 last = flat.start;
  for (const Bend& each : bends) {
    path.length += (each.at - last).norm();
    last = each.at;
    const Portal& portal = flat.portals[each.portal];
    path.corners.push_back({each.is_left ? portal.left : portal.right, each.portal});
  }
  path.length += (flat.end - last).norm();
  return path;
}

bool StripWalker::has(std::int32_t face, std::int32_t vertex) const {
  const Triangle& corners = mesh_.triangles[static_cast<std::size_t>(face)];
  return std::count(corners.begin(), corners.end(), vertex) > 0;
}

std::array<std::int32_t, 2> StripWalker::besides(std::int32_t face, std::int32_t vertex) const {
  const auto f = static_cast<std::size_t>(face);
  std::array<std::int32_t, 2> found{-1, -1};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3 && count < 2; ++k)
    if (mesh_.triangles[f][k] == vertex || mesh_.triangles[f][(k + 1) % 3] == vertex)
      found[count++] = neighbours_.face_neighbours[f][k];
  return found;
}

// Faces after `from` up to and with `to`, round the vertex, beginning with `first`.
std::optional<FaceStrip> StripWalker::fan(std::int32_t from, std::int32_t to, std::int32_t vertex,
                                          std::int32_t first) const {
  FaceStrip faces;
  constexpr std::size_t kMaxFan = 10'000;
  for (std::int32_t before = from, now = first; now >= 0 && faces.size() < kMaxFan;) {
    faces.push_back(now);
    if (now == to) return faces;
    if (now == from) return std::nullopt;
    const auto next = besides(now, vertex);
    const std::int32_t then = next[0] == before ? next[1] : next[0];
    before = now;
    now = then;
  }
  return std::nullopt;
}

std::optional<FaceStrip> StripWalker::joined(const FaceStrip& faces) const {
  FaceStrip strip{faces.front()};
  for (std::size_t i = 1; i < faces.size(); ++i) {
    const std::int32_t from = strip.back(), to = faces[i];
    if (from == to) continue;
    const auto& around = neighbours_.face_neighbours[static_cast<std::size_t>(from)];
    if (std::count(around.begin(), around.end(), to) > 0) {
      strip.push_back(to);
      continue;
    }
    std::optional<FaceStrip> shortest;
    for (const std::int32_t vertex : mesh_.triangles[static_cast<std::size_t>(from)]) {
      if (!has(to, vertex)) continue;
      for (const std::int32_t first : besides(from, vertex))
        if (auto found = fan(from, to, vertex, first);
            found && (!shortest || found->size() < shortest->size()))
          shortest = std::move(found);
    }
    if (!shortest) return std::nullopt;
    strip.insert(strip.end(), shortest->begin(), shortest->end());
  }
  // A face that is left and entered again at once is a detour.
  FaceStrip plain;
  for (const std::int32_t face : strip) {
    if (plain.size() >= 2 && plain[plain.size() - 2] == face)
      plain.pop_back();
    else
      plain.push_back(face);
  }
  return plain;
}

std::optional<FaceStrip> StripWalker::passedOnTheOtherSide(const FaceStrip& strip,
                                                           const StripCorner& corner) const {
  std::size_t first = corner.portal, last = corner.portal + 1;
  while (first > 0 && has(strip[first - 1], corner.vertex)) --first;
  while (last + 1 < strip.size() && has(strip[last + 1], corner.vertex)) ++last;
  const auto beside = besides(strip[first], corner.vertex);
  const std::int32_t other = beside[0] == strip[first + 1] ? beside[1] : beside[0];
  const auto round = fan(strip[first], strip[last], corner.vertex, other);
  if (!round) return std::nullopt;
  FaceStrip changed(strip.begin(), strip.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  changed.insert(changed.end(), round->begin(), round->end());
  changed.insert(changed.end(), strip.begin() + static_cast<std::ptrdiff_t>(last) + 1, strip.end());
  return joined(changed);
}

} // namespace patina
