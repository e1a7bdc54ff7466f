#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "geometry/winding/winding_number_tree.h"

namespace patina::winding {

namespace {

constexpr std::size_t kGrain = 2048;

template <typename Body> void parallel(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

std::uint32_t spread(std::uint32_t x) { // inserts two zero bits after each of ten
  x = (x | x << 16) & 0x030000FF;
  x = (x | x << 8) & 0x0300F00F;
  x = (x | x << 4) & 0x030C30C3;
  return (x | x << 2) & 0x09249249;
}

// Stable: equal codes keep the order of their triangles.
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

// Vertices in tree coordinates, padded to one vector.
using LocalVertices = std::vector<Float4>;

std::vector<Item> sortedItems(const TriangleMesh& mesh, const LocalVertices& vertices) {
  std::vector<Item> items(mesh.triangles.size());
  constexpr std::uint32_t kUnusable = std::numeric_limits<std::uint32_t>::max();
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
    items[t] = {finite ? code : kUnusable, static_cast<std::uint32_t>(t) & 0x7FFFFFFFU, 0U};
  });
  std::erase_if(items, [](const Item& item) { return item.code == kUnusable; });
  sortByCode(items);
  return items;
}

struct Range {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t size() const { return end - begin; }
};

// Returns where the highest differing bit changes, so that both halves are compact, or the middle
// if all codes are equal.
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
  std::uint32_t node;
  int lane;
};

// Makes nodes with links but without moments; a parent comes before its children.
std::vector<Leaf> divide(const std::vector<Item>& items, std::vector<ClusterNode4>& nodes,
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
    ClusterNode4& node = nodes.emplace_back();
    for (std::size_t lane = 0; lane < 4; ++lane) {
      node.children[lane] = -1;
      node.first_packet[lane] = static_cast<std::uint32_t>(packets);
      node.packet_count[lane] = 0;
      if (parts[lane].size() > kLeafTriangles) {
        node.children[lane] = static_cast<std::int32_t>(of_quad.size());
        of_quad.push_back(parts[lane]);
      } else if (parts[lane].size() > 0) {
        leaves.push_back({parts[lane], node.first_packet[lane], static_cast<std::uint32_t>(q),
                          static_cast<int>(lane)});
        node.packet_count[lane] = (parts[lane].size() + 3) / 4;
        packets += node.packet_count[lane];
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

// Ignores triangles with a non-finite corner, which must not determine the scale.
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
  const std::vector<Leaf> leaves = divide(items, tree.nodes, packets);
  tree.packets.resize(packets);
  std::vector<std::array<Moments, 4>> clusters(tree.nodes.size());
  parallel(leaves.size(), [&](std::size_t i) {
    const Leaf& leaf = leaves[i];
    pack(mesh, vertices, items, leaf, &tree.packets[leaf.first_packet]);
    clusters[leaf.node][static_cast<std::size_t>(leaf.lane)] =
        leafMoments(&tree.packets[leaf.first_packet], (leaf.items.size() + 3) / 4);
  });
  for (std::size_t q = tree.nodes.size(); q-- > 0;) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::int32_t child = tree.nodes[q].children[lane];
      if (child >= 0) clusters[q][lane] = parentOf(clusters[static_cast<std::size_t>(child)]);
      store(clusters[q][lane], static_cast<float>(accuracy), tree.nodes[q], static_cast<int>(lane));
    }
  }
  return tree;
}

} // namespace patina::winding
