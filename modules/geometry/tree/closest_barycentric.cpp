#include <algorithm>
#include <limits>

#include "geometry/tree/triangle_tree.h"

namespace patina {

Vec3 closestBarycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Uses areas about the corners nearest to p. Dot products with one corner would cancel on needles
  // and slide the point along the triangle.
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Vec3 normal = bc.cross(ca);
  const double wa = normal.dot(bc.cross(p - b));
  const double wb = normal.dot(ca.cross(p - c));
  const double wc = normal.dot(ab.cross(p - a));
  if (wa > 0 && wb > 0 && wc > 0) return Vec3(wa, wb, wc) / (wa + wb + wc);

  // The nearest edge faces p.
  double best = std::numeric_limits<double>::infinity();
  Vec3 result(1, 0, 0);
  const auto tryEdge = [&](const Vec3& from, const Vec3& edge, int i, int j) {
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - from).dot(edge) / length2, 0.0, 1.0) : 0.0;
    const double d2 = (p - from - t * edge).squaredNorm();
    if (!(d2 < best)) return;
    best = d2;
    result.setZero();
    result[i] = 1 - t;
    result[j] = t;
  };
  if (!(wa > 0)) tryEdge(b, bc, 1, 2);
  if (!(wb > 0)) tryEdge(c, ca, 2, 0);
  if (!(wc > 0)) tryEdge(a, ab, 0, 1);
  return result;
}

} // namespace patina
