// Moments of clusters, computed from triangles and from smaller clusters.
#include <algorithm>
#include <cmath>

#include "geometry/winding/winding_number_tree.h"

namespace patina::winding {

namespace {

float sum(Float4 x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

} // namespace

Moments leafMoments(const Packet* packets, std::size_t count) {
  struct Areas {
    Float4 nx, ny, nz, area;
  };
  std::array<Areas, kLeafTriangles / 4> areas;
  Moments leaf;
  std::array<Float4, 3> weighted{};
  Float4 total{};
  for (std::size_t i = 0; i < count; ++i) {
    const Packet& p = packets[i];
    const Float4 ux = p.b[0] - p.a[0], uy = p.b[1] - p.a[1], uz = p.b[2] - p.a[2];
    const Float4 vx = p.c[0] - p.a[0], vy = p.c[1] - p.a[1], vz = p.c[2] - p.a[2];
    Areas& a = areas[i];
    a.nx = 0.5F * (uy * vz - uz * vy);
    a.ny = 0.5F * (uz * vx - ux * vz);
    a.nz = 0.5F * (ux * vy - uy * vx);
    const Float4 squared = a.nx * a.nx + a.ny * a.ny + a.nz * a.nz;
    for (int l = 0; l < 4; ++l) a.area[l] = std::sqrt(squared[l]);
    total += a.area;
    for (std::size_t k = 0; k < 3; ++k) weighted[k] += a.area * (p.a[k] + p.b[k] + p.c[k]);
  }
  leaf.area = sum(total);
  for (std::size_t k = 0; k < 3; ++k)
    leaf.centre[k] = leaf.area > 0 ? sum(weighted[k]) / (3 * leaf.area) : packets[0].a[k][0];

  std::array<Float4, 3> n{};
  std::array<Float4, 6> m{};
  std::array<Float4, 10> s{};
  Float4 radius_squared{};
  std::array<Float4, 3> low{}, high{}; // relative to the centre, which lies in the box
  for (std::size_t i = 0; i < count; ++i) {
    const Packet& p = packets[i];
    std::array<Float4, 3> a, b, c, g;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = p.a[k] - leaf.centre[k];
      b[k] = p.b[k] - leaf.centre[k];
      c[k] = p.c[k] - leaf.centre[k];
      g[k] = a[k] + b[k] + c[k];
    }
    for (const auto& corner : {a, b, c}) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = corner[k] < low[k] ? corner[k] : low[k];
        high[k] = corner[k] > high[k] ? corner[k] : high[k];
      }
      const Float4 squared = corner[0] * corner[0] + corner[1] * corner[1] + corner[2] * corner[2];
      radius_squared = squared > radius_squared ? squared : radius_squared;
    }
    const Float4 nx = areas[i].nx, ny = areas[i].ny, nz = areas[i].nz;
    n[0] += nx;
    n[1] += ny;
    n[2] += nz;
    constexpr float kThird = 1.0F / 3;
    const Float4 gx = g[0] * kThird, gy = g[1] * kThird, gz = g[2] * kThird;
    m[0] += nx * gx;
    m[1] += ny * gy;
    m[2] += nz * gz;
    m[3] += 0.5F * (nx * gy + ny * gx);
    m[4] += 0.5F * (nx * gz + nz * gx);
    m[5] += 0.5F * (ny * gz + nz * gy);
    // Mean of d (x) d over a triangle.
    const auto mean = [&](std::size_t j, std::size_t k) {
      return (a[j] * a[k] + b[j] * b[k] + c[j] * c[k] + g[j] * g[k]) * (1.0F / 12);
    };
    const Float4 xx = mean(0, 0), yy = mean(1, 1), zz = mean(2, 2);
    const Float4 xy = mean(0, 1), xz = mean(0, 2), yz = mean(1, 2);
    s[0] += nx * xx;
    s[1] += ny * yy;
    s[2] += nz * zz;
    s[3] += (2 * nx * xy + ny * xx) * kThird;
    s[4] += (2 * nx * xz + nz * xx) * kThird;
    s[5] += (2 * ny * xy + nx * yy) * kThird;
    s[6] += (2 * ny * yz + nz * yy) * kThird;
    s[7] += (2 * nz * xz + nx * zz) * kThird;
    s[8] += (2 * nz * yz + ny * zz) * kThird;
    s[9] += (nx * yz + ny * xz + nz * xy) * kThird;
  }
  for (std::size_t k = 0; k < n.size(); ++k) leaf.n[k] = sum(n[k]);
  for (std::size_t k = 0; k < m.size(); ++k) leaf.m[k] = sum(m[k]);
  for (std::size_t k = 0; k < s.size(); ++k) leaf.s[k] = sum(s[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    for (int l = 0; l < 4; ++l) {
      leaf.low[static_cast<int>(k)] =
          std::min(leaf.low[static_cast<int>(k)], leaf.centre[k] + low[k][l]);
      leaf.high[static_cast<int>(k)] =
          std::max(leaf.high[static_cast<int>(k)], leaf.centre[k] + high[k][l]);
    }
  }
  leaf.radius = std::sqrt(std::max(std::max(radius_squared[0], radius_squared[1]),
                                   std::max(radius_squared[2], radius_squared[3])));
  return leaf;
}

namespace {

// Adds a child's moments, moved by t from its centre to the parent's.
void addMoved(Moments& parent, const Moments& child) {
  const float x = child.centre[0] - parent.centre[0];
  const float y = child.centre[1] - parent.centre[1];
  const float z = child.centre[2] - parent.centre[2];
  parent.radius = std::max(parent.radius, std::sqrt(x * x + y * y + z * z) + child.radius);
  const auto& n = child.n;
  const auto& m = child.m;
  const auto& s = child.s;
  for (std::size_t k = 0; k < 3; ++k) parent.n[k] += n[k];
  parent.m[0] += m[0] + n[0] * x;
  parent.m[1] += m[1] + n[1] * y;
  parent.m[2] += m[2] + n[2] * z;
  parent.m[3] += m[3] + (n[0] * y + n[1] * x) / 2;
  parent.m[4] += m[4] + (n[0] * z + n[2] * x) / 2;
  parent.m[5] += m[5] + (n[1] * z + n[2] * y) / 2;
  parent.s[0] += s[0] + 2 * m[0] * x + n[0] * x * x;
  parent.s[1] += s[1] + 2 * m[1] * y + n[1] * y * y;
  parent.s[2] += s[2] + 2 * m[2] * z + n[2] * z * z;
  const auto twice = [](float s_iij, float m_ii, float m_ij, float n_i, float n_j, float t_i,
                        float t_j) {
    return s_iij + (2 * (m_ii * t_j + 2 * m_ij * t_i) + 2 * n_i * t_i * t_j + n_j * t_i * t_i) / 3;
  };
  parent.s[3] += twice(s[3], m[0], m[3], n[0], n[1], x, y);
  parent.s[4] += twice(s[4], m[0], m[4], n[0], n[2], x, z);
  parent.s[5] += twice(s[5], m[1], m[3], n[1], n[0], y, x);
  parent.s[6] += twice(s[6], m[1], m[5], n[1], n[2], y, z);
  parent.s[7] += twice(s[7], m[2], m[4], n[2], n[0], z, x);
  parent.s[8] += twice(s[8], m[2], m[5], n[2], n[1], z, y);
  parent.s[9] +=
      s[9] +
      (2 * (m[3] * z + m[4] * y + m[5] * x) + n[0] * y * z + n[1] * x * z + n[2] * x * y) / 3;
}

} // namespace

Moments parentOf(const std::array<Moments, 4>& children) {
  Moments parent;
  int count = 0;
  for (const Moments& child : children) {
    if (child.radius < 0) continue;
    ++count;
    parent.area += child.area;
    parent.low = parent.low.cwiseMin(child.low);
    parent.high = parent.high.cwiseMax(child.high);
  }
  for (const Moments& child : children) {
    if (child.radius < 0) continue;
    const float weight =
        parent.area > 0 ? child.area / parent.area : 1.0F / static_cast<float>(count);
    for (std::size_t k = 0; k < 3; ++k) parent.centre[k] += weight * child.centre[k];
  }
  for (const Moments& child : children)
    if (child.radius >= 0) addMoved(parent, child);
  const Eigen::Vector3f centre(parent.centre[0], parent.centre[1], parent.centre[2]);
  const float corner = (parent.high - centre).cwiseMax(centre - parent.low).norm();
  parent.radius = std::min(parent.radius, corner);
  return parent;
}

// Stores the coefficients of ClusterNode4 in one lane.
void store(const Moments& cluster, float accuracy, ClusterNode4& node, int l) {
  if (cluster.radius < 0) { // far from everywhere and without effect
    for (auto& coordinate : node.centre) coordinate[l] = 1e3F;
    node.far_squared[l] = -1;
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) node.centre[k][l] = cluster.centre[k];
  for (std::size_t k = 0; k < 3; ++k) node.dipole[k][l] = cluster.n[k];
  const float far = accuracy * cluster.radius;
  node.far_squared[l] = far * far;
  const auto& m = cluster.m;
  const auto& s = cluster.s;
  const float trace = (m[0] + m[1] + m[2]) / 3;
  for (std::size_t k = 0; k < 3; ++k) node.second[k][l] = -3 * (m[k] - trace);
  for (std::size_t k = 3; k < 6; ++k) node.second[k][l] = -6 * m[k];
  const float tx = (s[0] + s[5] + s[7]) / 5;
  const float ty = (s[1] + s[3] + s[8]) / 5;
  const float tz = (s[2] + s[4] + s[6]) / 5;
  node.third[0][l] = 7.5F * (s[0] - 3 * tx);
  node.third[1][l] = 7.5F * (s[1] - 3 * ty);
  node.third[2][l] = 7.5F * (s[2] - 3 * tz);
  node.third[3][l] = 22.5F * (s[3] - ty);
  node.third[4][l] = 22.5F * (s[4] - tz);
  node.third[5][l] = 22.5F * (s[5] - tx);
  node.third[6][l] = 22.5F * (s[6] - tz);
  node.third[7][l] = 22.5F * (s[7] - tx);
  node.third[8][l] = 22.5F * (s[8] - ty);
  node.third[9][l] = 45.0F * s[9];
}

} // namespace patina::winding
