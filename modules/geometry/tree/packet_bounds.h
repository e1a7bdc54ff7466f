// Part of the packet kernel (see triangle_packet_kernel.h): how near points can be to what a node
// bounds.
#pragma once

#include "geometry/tree/packet_lanes.h"
#include "geometry/tree/triangle_packet.h"

namespace patina::PATINA_KERNEL {

constexpr float kPadding = 2.5e-7f; // of boxes, against float's rounding of coordinates

struct Points {
  Lanes x, y, z;
};

PATINA_INLINE Lanes lengthSquared(const Lanes& x, const Lanes& y, const Lanes& z) {
  return madd(x, x, madd(y, y, z * z));
}

// An axis-aligned box, every coordinate in all lanes.
struct Box {
  Lanes centre[3], half[3];
};

PATINA_INLINE Box boxOf(const float (&lo)[3], const float (&hi)[3]) {
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.centre[a] = spread(0.5f * (lo[a] + hi[a]));
    box.half[a] = spread(0.5f * (hi[a] - lo[a]) + kPadding);
  }
  return box;
}

PATINA_INLINE Lanes gap(const Lanes& offset, const Lanes& half) {
  return larger(magnitude(offset) - half, spread(0.0f));
}

// Squared distances of eight boxes from one.
template <typename Rows>
PATINA_INLINE Lanes boxDistances(const Rows& centre, const Rows& half, const Box& box) {
  return lengthSquared(gap(load(centre[0]) - box.centre[0], load(half[0]) + box.half[0]),
                       gap(load(centre[1]) - box.centre[1], load(half[1]) + box.half[1]),
                       gap(load(centre[2]) - box.centre[2], load(half[2]) + box.half[2]));
}

// Lower bounds of squared distances of points at (x, y, z) from the centres.
PATINA_INLINE Lanes cylinderDistance(const Lanes& x, const Lanes& y, const Lanes& z,
                                     const Lanes& nx, const Lanes& ny, const Lanes& nz,
                                     const Lanes& low, const Lanes& high, const Lanes& radius) {
  const Lanes zero = spread(0.0f);
  const Lanes along = madd(x, nx, madd(y, ny, z * nz));
  const Lanes across = root(larger(lengthSquared(x, y, z) - along * along, zero));
  const Lanes over = larger(larger(along - high, low - along), zero);
  const Lanes out = larger(across - radius, zero);
  return spread(1 - 1e-5f) * madd(over, over, out * out);
}

// Of eight points from one child.
PATINA_INLINE Lanes childDistance(const WideNode& node, int place, const Points& p) {
  const Lanes x = p.x - spread(node.centre[0][place]);
  const Lanes y = p.y - spread(node.centre[1][place]);
  const Lanes z = p.z - spread(node.centre[2][place]);
  const Lanes box =
      lengthSquared(gap(x, spread(node.half[0][place])), gap(y, spread(node.half[1][place])),
                    gap(z, spread(node.half[2][place])));
  return larger(box, cylinderDistance(x, y, z, spread(node.normal[0][place]),
                                      spread(node.normal[1][place]), spread(node.normal[2][place]),
                                      spread(node.low[place]), spread(node.high[place]),
                                      spread(node.radius[place])));
}

// Of one point, in every lane, from eight children.
PATINA_INLINE Lanes childDistances(const WideNode& node, const Points& p) {
  const Lanes x = p.x - load(node.centre[0]);
  const Lanes y = p.y - load(node.centre[1]);
  const Lanes z = p.z - load(node.centre[2]);
  const Lanes box = lengthSquared(gap(x, load(node.half[0])), gap(y, load(node.half[1])),
                                  gap(z, load(node.half[2])));
  const Lanes radius = load(node.radius);
  if (!any(radius < spread(__builtin_inff()))) return box;
  return larger(box,
                cylinderDistance(x, y, z, load(node.normal[0]), load(node.normal[1]),
                                 load(node.normal[2]), load(node.low), load(node.high), radius));
}

} // namespace patina::PATINA_KERNEL
