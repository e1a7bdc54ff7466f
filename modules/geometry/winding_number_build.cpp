#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "geometry/winding_number_tree.h"

namespace patina::winding {

namespace {

constexpr std::size_t kGrain = 2048;

template <typename Body> void parallel(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

// Symmetric parts of the integrals of n, n (x) d and n (x) d (x) d over a cluster, d = x - centre.
struct Moments {
  std::array<float, 3> centre{};
  float radius = -1; // of a ball about the centre that holds the cluster; -1 = no cluster
  float area = 0;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(2), high = Eigen::Vector3f::Constant(-2); // box
  std::array<float, 3> n{};
  std::array<float, 6> m{};  // in the order of Quad::second
  std::array<float, 10> s{}; // in the order of Quad::third
};

std::uint32_t spread(std::uint32_t x) { // two zero bits after each of ten
  x = (x | x << 16) & 0x030000FF;
  x = (x | x << 8) & 0x0300F00F;
  x = (x | x << 4) & 0x030C30C3;
  return (x | x << 2) & 0x09249249;
}

// Stable, so that equal codes stay in the order of their triangles.
void sortByCode(std::vector<Item>& items) {
  constexpr std::size_t kDigits = 1U << 10;
  std::vector<Item> other(items.size());
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<std::uint32_t, kDigits + 1> start{};
    for (const Item& item : items) ++start[(item.code >> shift) % kDigits + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const Item& item : items) other[start[(item.code >> shift) % kDigits]++] = item;
    items.swap(other);
  }
}

float sum(Float4 x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

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
  std::array<Float4, 3> low{}, high{}; // about the centre, which lies in the box
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

// The coefficients that Quad describes, into one lane.
void store(const Moments& cluster, float accuracy, Quad& quad, int l) {
  if (cluster.radius < 0) { // far from everywhere, adding nothing
    for (auto& coordinate : quad.centre) coordinate[l] = 1e3F;
    quad.far_squared[l] = -1;
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) quad.centre[k][l] = cluster.centre[k];
  for (std::size_t k = 0; k < 3; ++k) quad.dipole[k][l] = cluster.n[k];
  const float far = accuracy * cluster.radius;
  quad.far_squared[l] = far * far;
  const auto& m = cluster.m;
  const auto& s = cluster.s;
  const float trace = (m[0] + m[1] + m[2]) / 3;
  for (std::size_t k = 0; k < 3; ++k) quad.second[k][l] = -3 * (m[k] - trace);
  for (std::size_t k = 3; k < 6; ++k) quad.second[k][l] = -6 * m[k];
  const float tx = (s[0] + s[5] + s[7]) / 5;
  const float ty = (s[1] + s[3] + s[8]) / 5;
  const float tz = (s[2] + s[4] + s[6]) / 5;
  quad.third[0][l] = 7.5F * (s[0] - 3 * tx);
  quad.third[1][l] = 7.5F * (s[1] - 3 * ty);
  quad.third[2][l] = 7.5F * (s[2] - 3 * tz);
  quad.third[3][l] = 22.5F * (s[3] - ty);
  quad.third[4][l] = 22.5F * (s[4] - tz);
  quad.third[5][l] = 22.5F * (s[5] - tx);
  quad.third[6][l] = 22.5F * (s[6] - tz);
  quad.third[7][l] = 22.5F * (s[7] - tx);
  quad.third[8][l] = 22.5F * (s[8] - ty);
  quad.third[9][l] = 45.0F * s[9];
}

// Vertices in tree coordinates, padded to one vector.
using LocalVertices = std::vector<Float4>;

std::vector<Item> sortedItems(const TriangleMesh& mesh, const LocalVertices& vertices) {
  std::vector<Item> items(mesh.triangles.size());
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  parallel(items.size(), [&](std::size_t t) {
    const auto corner = [&](std::size_t k) {
      return vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const Float4 a = corner(0), b = corner(1), c = corner(2);
    // The box's centre, unlike the mean, does not depend on the order of the corners.
    Float4 low = a < b ? a : b, high = a < b ? b : a;
    low = low < c ? low : c;
    high = high < c ? c : high;
    const Float4 all = a + b + c;
    const Float4 cell = (low + high) * 512.0F + 512.0F;
    std::uint32_t code = 0;
    for (int k = 0; k < 3; ++k)
      code |= spread(static_cast<std::uint32_t>(std::clamp(cell[k], 0.0F, 1023.0F))) << k;
    const bool finite = std::isfinite(all[0] + all[1] + all[2]);
    items[t] = {finite ? code : kNone, static_cast<std::uint32_t>(t) & 0x7FFFFFFFU, 0U};
  });
  std::erase_if(items, [](const Item& item) { return item.code == kNone; });
  sortByCode(items);
  return items;
}

struct Range {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t size() const { return end - begin; }
};

// Where the highest bit that differs changes, so that both halves are compact; the middle if all
// codes are equal.
std::uint32_t splitOf(const std::vector<Item>& items, Range range) {
  const std::uint32_t differing = items[range.begin].code ^ items[range.end - 1].code;
  if (differing == 0) return range.begin + range.size() / 2;
  const std::uint32_t bit = std::bit_floor(differing);
  const auto at = std::partition_point(items.begin() + range.begin, items.begin() + range.end,
                                       [&](const Item& item) { return !(item.code & bit); });
  return static_cast<std::uint32_t>(at - items.begin());
}

struct Leaf {
  Range items;
  std::uint32_t first_packet;
  std::uint32_t quad;
  int lane;
};

// Quads with links, without moments; a parent comes before its children.
std::vector<Leaf> divide(const std::vector<Item>& items, std::vector<Quad>& quads,
                         std::size_t& packets) {
  std::vector<Leaf> leaves;
  std::vector<Range> of_quad{{0, static_cast<std::uint32_t>(items.size())}};
  packets = 0;
  for (std::size_t q = 0; q < of_quad.size(); ++q) {
    std::array<Range, 4> parts{of_quad[q]};
    for (std::size_t count = 1; count < 4; ++count) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                           [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() <= kLeafTriangles) break;
      const std::uint32_t split = splitOf(items, *largest);
      parts[count] = {split, largest->end};
      largest->end = split;
    }
    Quad& quad = quads.emplace_back();
    for (std::size_t lane = 0; lane < 4; ++lane) {
      quad.children[lane] = -1;
      quad.first_packet[lane] = static_cast<std::uint32_t>(packets);
      quad.packet_count[lane] = 0;
      if (parts[lane].size() > kLeafTriangles) {
        quad.children[lane] = static_cast<std::int32_t>(of_quad.size());
        of_quad.push_back(parts[lane]);
      } else if (parts[lane].size() > 0) {
        leaves.push_back({parts[lane], quad.first_packet[lane], static_cast<std::uint32_t>(q),
                          static_cast<int>(lane)});
        quad.packet_count[lane] = (parts[lane].size() + 3) / 4;
        packets += quad.packet_count[lane];
      }
    }
  }
  return leaves;
}

void pack(const TriangleMesh& mesh, const LocalVertices& vertices, const std::vector<Item>& items,
          const Leaf& leaf, Packet* packets) {
  for (std::uint32_t i = 0; i < (leaf.items.size() + 3) / 4; ++i) {
    std::array<Float4, 4> a, b, c;
    for (std::uint32_t l = 0; l < 4; ++l) {
      const std::uint32_t place = leaf.items.begin + 4 * i + l;
      const bool absent = place >= leaf.items.end;
      const Item item = items[absent ? leaf.items.begin : place];
      const Triangle& corners = mesh.triangles[item.triangle];
      const auto local = [&](std::size_t corner) {
        return vertices[static_cast<std::size_t>(corners[absent ? 0 : corner])];
      };
      a[l] = local(0);
      b[l] = local(item.flip ? 2 : 1);
      c[l] = local(item.flip ? 1 : 2);
    }
    const auto transpose = [](const std::array<Float4, 4>& v, std::array<Float4, 3>& out) {
      for (int k = 0; k < 3; ++k)
        out[static_cast<std::size_t>(k)] = Float4{v[0][k], v[1][k], v[2][k], v[3][k]};
    };
    transpose(a, packets[i].a);
    transpose(b, packets[i].b);
    transpose(c, packets[i].c);
  }
}

// Of the triangles with finite corners: one that has none must not set the scale.
Box3 finiteBounds(const TriangleMesh& mesh) {
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (std::int32_t v : t) {
      const Vec3& p = mesh.positions[static_cast<std::size_t>(v)];
      if (std::isfinite(p.x() + p.y() + p.z())) box.extend(p);
    }
  }
  return box;
}

} // namespace

Tree build(const TriangleMesh& mesh, double accuracy) {
  Tree tree;
  const Box3 box = finiteBounds(mesh);
  if (box.isEmpty()) return tree;
  tree.origin = box.center();
  const double size = box.sizes().maxCoeff();
  tree.scale = size > 0 ? 1 / size : 1;

  LocalVertices vertices(mesh.positions.size());
  parallel(vertices.size(), [&](std::size_t v) {
    const Vec3 p = (mesh.positions[v] - tree.origin) * tree.scale;
    vertices[v] =
        Float4{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0};
  });
  const std::vector<Item> items = withoutCoincident(mesh, sortedItems(mesh, vertices));
  if (items.empty()) return tree;
  std::size_t packets = 0;
  const std::vector<Leaf> leaves = divide(items, tree.quads, packets);
  tree.packets.resize(packets);
  std::vector<std::array<Moments, 4>> clusters(tree.quads.size());
  parallel(leaves.size(), [&](std::size_t i) {
    const Leaf& leaf = leaves[i];
    pack(mesh, vertices, items, leaf, &tree.packets[leaf.first_packet]);
    clusters[leaf.quad][static_cast<std::size_t>(leaf.lane)] =
        leafMoments(&tree.packets[leaf.first_packet], (leaf.items.size() + 3) / 4);
  });
  for (std::size_t q = tree.quads.size(); q-- > 0;) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::int32_t child = tree.quads[q].children[lane];
      if (child >= 0) clusters[q][lane] = parentOf(clusters[static_cast<std::size_t>(child)]);
      store(clusters[q][lane], static_cast<float>(accuracy), tree.quads[q], static_cast<int>(lane));
    }
  }
  return tree;
}

} // namespace patina::winding
