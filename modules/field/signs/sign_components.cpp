#include "field/signs/sign_components.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "geometry/mesh/holes.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina::signs {
namespace {

constexpr std::array<std::size_t, 3> kStride{1, kBlockSide, kBlockSide* kBlockSide};
constexpr std::uint16_t kUnlabelled = 0xFFFF;

// Edges between nodes at such distances connect them.
struct SafeEdge {
  float margin;
  bool operator()(float d1, float d2) const { return d1 + d2 > 1 + margin; }
};

std::uint16_t rootOf(Labels& parent, std::uint16_t label) {
  while (parent[label] != label) label = parent[label] = parent[parent[label]];
  return label;
}

// Labels the nodes in two passes: with equivalences, then without.
void labelNodes(const float* d, SafeEdge safe, Labels& label, std::vector<Part>& parts) {
  Labels parent;
  std::uint16_t count = 0;
  std::size_t i = 0;
  for (std::size_t z = 0; z < kBlockSide; ++z) {
    for (std::size_t y = 0; y < kBlockSide; ++y) {
      for (std::size_t x = 0; x < kBlockSide; ++x, ++i) {
        std::uint16_t mine = kUnlabelled;
        const auto meet = [&](std::size_t before) {
          if (!safe(d[i], d[before])) return;
          const std::uint16_t other = rootOf(parent, label[before]);
          if (mine == other) return;
          if (mine != kUnlabelled) parent[std::max(mine, other)] = std::min(mine, other);
          mine = std::min(mine, other);
        };
        if (x > 0) meet(i - kStride[0]);
        if (y > 0) meet(i - kStride[1]);
        if (z > 0) meet(i - kStride[2]);
        if (mine == kUnlabelled) {
          mine = count++;
          parent[mine] = mine;
        }
        label[i] = mine;
      }
    }
  }
  Labels number;
  for (std::uint16_t l = 0; l < count; ++l) { // A root precedes all labels that refer to it.
    if (parent[l] != l) continue;
    number[l] = static_cast<std::uint16_t>(parts.size());
    parts.emplace_back();
  }
  for (std::uint16_t& l : label) l = number[rootOf(parent, l)];
}

struct BlockParts {
  std::vector<Part> parts;
  std::unique_ptr<Labels> labels;
};

BlockParts partsOfBlock(const float* d, SafeEdge safe, std::int32_t slot, float most) {
  BlockParts block;
  float nearest = d[0];
  for (std::size_t i = 1; i < kBlockNodes; ++i) nearest = d[i] < nearest ? d[i] : nearest;
  if (safe(nearest, nearest)) {
    block.parts.emplace_back();
  } else {
    block.labels = std::make_unique<Labels>();
    labelNodes(d, safe, *block.labels, block.parts);
    if (block.parts.size() == 1) block.labels.reset();
  }
  for (Part& part : block.parts) {
    part.slot = slot;
    part.depth = -1;
  }
  for (std::size_t i = 0; i < kBlockNodes; ++i) {
    Part& part = block.parts[block.labels ? (*block.labels)[i] : 0];
    ++part.nodes;
    if (d[i] <= part.depth) continue;
    part.depth = d[i];
    part.deepest = static_cast<std::uint16_t>(i);
  }
  for (Part& part : block.parts) part.depth = std::min(part.depth, most);
  return block;
}

void addEdge(std::vector<Link>& links, std::size_t since, std::uint32_t a, std::uint32_t b) {
  for (std::size_t i = links.size(); i-- > since;) {
    if (links[i].a != a || links[i].b != b) continue;
    ++links[i].edges;
    return;
  }
  links.push_back({a, b, 1});
}

struct Linker {
  const FieldBuilder& builder;
  const Components& components;
  SafeEdge safe;

  // Returns -1 outside the grid.
  std::ptrdiff_t topIndex(const std::array<int, 3>& at) const {
    const auto& n = builder.field.blocks;
    for (std::size_t a = 0; a < 3; ++a)
      if (at[a] < 0 || at[a] >= n[a]) return -1;
    return (static_cast<std::ptrdiff_t>(at[2]) * n[1] + at[1]) * n[0] + at[0];
  }

  void linkStored(std::int32_t slot, std::vector<Link>& links) const {
    const auto here = phiOf(builder, static_cast<std::size_t>(slot));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = kStride[(axis + 1) % 3], v = kStride[(axis + 2) % 3];
      for (int side : {-1, 1}) {
        std::array<int, 3> at = builder.field.block_at[static_cast<std::size_t>(slot)];
        at[axis] += side;
        const std::ptrdiff_t index = topIndex(at);
        if (index < 0) continue;
        const std::int32_t other = builder.field.block_index[static_cast<std::size_t>(index)];
        if (other >= 0 && side < 0) continue; // left to the other block
        const bool there = other >= 0;
        const auto beyond = there ? phiOf(builder, static_cast<std::size_t>(other))
                                  : std::array<float, kBlockNodes>();
        const std::size_t last = (kBlockSide - 1) * kStride[axis];
        const std::size_t from = side > 0 ? last : 0;
        const std::size_t since = links.size();
        for (std::size_t j = 0; j < kBlockSide; ++j) {
          for (std::size_t i = 0; i < kBlockSide; ++i) {
            const std::size_t node = from + i * u + j * v;
            const std::size_t opposite = last - from + i * u + j * v;
            const float d = there ? beyond[opposite] : static_cast<float>(builder.field.band);
            if (!safe(here[node], d)) continue;
            addEdge(links, since, components.partOf(slot, node),
                    there ? components.partOf(other, opposite)
                          : components.partOfBlock(static_cast<std::size_t>(index)));
          }
        }
      }
    }
  }

  // Calls visit(other) for unstored neighbours with a higher index.
  template <typename Visit> void besideUnstored(std::size_t index, const Visit& visit) const {
    const auto& top = builder.field.block_index;
    const auto& n = builder.field.blocks;
    const auto i = static_cast<std::ptrdiff_t>(index);
    const std::array<int, 3> at{static_cast<int>(i % n[0]), static_cast<int>(i / n[0] % n[1]),
                                static_cast<int>(i / n[0] / n[1])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<int, 3> next = at;
      ++next[axis];
      const std::ptrdiff_t other = topIndex(next);
      if (other < 0 || top[static_cast<std::size_t>(other)] >= 0) continue;
      visit(static_cast<std::size_t>(other));
    }
  }
};

// Collects links in chunks of fixed size, so that their order does not depend on the threads.
template <typename Body>
void collectLinks(std::size_t count, std::vector<Link>& links, const Body& body) {
  constexpr std::size_t kChunk = 128;
  std::vector<std::vector<Link>> chunks((count + kChunk - 1) / kChunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    for (std::size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) body(i, chunks[c]);
  });
  for (const auto& chunk : chunks) links.insert(links.end(), chunk.begin(), chunk.end());
}

std::vector<std::uint32_t> rootsOf(const Linker& linker) {
  const std::size_t parts = linker.components.parts.size();
  std::vector<std::uint32_t> root(parts);
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t part) {
    while (root[part] != part) part = root[part] = root[root[part]];
    return part;
  };
  const auto join = [&](std::uint32_t one, std::uint32_t other) {
    const std::uint32_t a = find(one), b = find(other);
    root[std::max(a, b)] = std::min(a, b);
  };
  for (const Link& link : linker.components.links) join(link.a, link.b);
  for (std::size_t i = 0; i < linker.builder.field.block_index.size(); ++i)
    if (linker.builder.field.block_index[i] < 0)
      linker.besideUnstored(i, [&](std::size_t other) {
        join(linker.components.partOfBlock(i), linker.components.partOfBlock(other));
      });
  for (std::uint32_t part = 0; part < parts; ++part) root[part] = root[root[part]]; // root <= part
  return root;
}

} // namespace

Components connectedComponents(const FieldBuilder& builder, float margin) {
  const SafeEdge safe{margin};
  const std::size_t slots = builder.distance.size();
  const auto most = static_cast<float>(builder.field.band) + 1;
  std::vector<BlockParts> blocks(slots);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots, 16), [&](const auto& range) {
    for (std::size_t s = range.begin(); s < range.end(); ++s)
      blocks[s] = partsOfBlock(phiOf(builder, s).data(), safe, static_cast<std::int32_t>(s), most);
  });

  Components components;
  components.first.reserve(slots + 1);
  components.labels.reserve(slots);
  for (BlockParts& block : blocks) {
    components.first.push_back(static_cast<std::uint32_t>(components.parts.size()));
    components.parts.insert(components.parts.end(), block.parts.begin(), block.parts.end());
    components.labels.push_back(std::move(block.labels));
    block.parts = {};
  }
  components.first.push_back(static_cast<std::uint32_t>(components.parts.size()));
  components.parts.resize(components.parts.size() + builder.field.block_index.size());

  const Linker linker{builder, components, safe};
  collectLinks(slots, components.links, [&](std::size_t s, std::vector<Link>& links) {
    linker.linkStored(static_cast<std::int32_t>(s), links);
  });
  components.root = rootsOf(linker);
  return components;
}

void linkUnstored(const FieldBuilder& builder, Components& components) {
  const Linker linker{builder, components, {kMargin}};
  for (std::size_t i = 0; i < builder.field.block_index.size(); ++i)
    if (builder.field.block_index[i] < 0)
      linker.besideUnstored(i, [&](std::size_t other) {
        components.links.push_back(
            {components.partOfBlock(i), components.partOfBlock(other), kBlockSide * kBlockSide});
      });
}

bool isClosed(const TriangleMesh& mesh, const OpenParts& open) {
  for (const PartSides& part : open.decided)
    if (part.sides == OpenSides::closed && part.rim_edges > 0) return false;
  const std::vector<Triangle> welded = weldedTriangles(mesh);
  TriangleMesh closed{mesh.positions, {}, {}};
  for (std::size_t f = 0; f < welded.size(); ++f) {
    const auto& [a, b, c] = welded[f];
    const bool counts = a != b && b != c && c != a;
    if (counts && (!open.any() || !open.open[f])) closed.triangles.push_back(welded[f]);
  }
  return connectedParts(closed, 0).rims.empty();
}

std::vector<std::int8_t> cutLeaks(const Components& components,
                                  const std::vector<float>& inside_confidence) {
  // Probability that the walk ends at a node, relative to a step along an edge.
  constexpr float kTrust = 0.1F;
  constexpr int kSweeps = 40;
  const std::size_t parts = components.parts.size();
  std::vector<std::uint32_t> offset(parts + 1);
  for (const Link& link : components.links) {
    if (std::isnan(inside_confidence[link.a])) continue;
    ++offset[link.a + 1];
    ++offset[link.b + 1];
  }
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  struct Neighbour {
    std::uint32_t part;
    float edges;
  };
  std::vector<Neighbour> neighbours(offset.back());
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (const Link& link : components.links) {
    if (std::isnan(inside_confidence[link.a])) continue;
    neighbours[next[link.a]++] = {link.b, static_cast<float>(link.edges)};
    neighbours[next[link.b]++] = {link.a, static_cast<float>(link.edges)};
  }

  std::vector<float> value = inside_confidence;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < parts; ++i) {
      if (std::isnan(inside_confidence[i])) continue;
      const Part& part = components.parts[i];
      const float own = kTrust * static_cast<float>(part.slot < 0 ? kBlockNodes : part.nodes) *
                        std::abs(inside_confidence[i]);
      float sum = inside_confidence[i] < 0 ? -own : own;
      float weight = own;
      for (std::uint32_t n = offset[i]; n < offset[i + 1]; ++n) {
        sum += neighbours[n].edges * value[neighbours[n].part];
        weight += neighbours[n].edges;
      }
      if (weight > 0) value[i] = sum / weight;
    }
  }
  std::vector<std::int8_t> sign(parts);
  for (std::size_t i = 0; i < parts; ++i)
    if (!std::isnan(inside_confidence[i])) sign[i] = value[i] > 0 ? -1 : 1;
  return sign;
}

} // namespace patina::signs
