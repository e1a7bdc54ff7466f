// Tests the components of signs against brute force over single nodes.
#include "field/signs/sign_components.h"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace patina::signs {
namespace {

constexpr float kBand = 0.7F; // narrow, so that not every edge past the last block is safe
constexpr Index3 kBlocks{3, 2, 2};

bool isSafe(float a, float b) {
  return a + b > 1 + kMargin;
}

// Some blocks are stored with random distances; `dense` of the nodes are near the surface.
FieldBuilder randomBuilder(unsigned seed, double dense) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> near(0, 0.5F), far(0.3F, 1.1F);
  FieldBuilder builder;
  builder.field.band = static_cast<double>(kBand);
  builder.field.blocks = kBlocks;
  for (int z = 0; z < kBlocks[2]; ++z)
    for (int y = 0; y < kBlocks[1]; ++y)
      for (int x = 0; x < kBlocks[0]; ++x) {
        builder.field.block_index.push_back(SurfaceField::kOutside);
        if (random() % 4 == 0) continue;
        builder.field.block_index.back() = static_cast<std::int32_t>(builder.distance.size());
        builder.field.block_at.push_back({x, y, z});
        DistanceNodes nodes;
        for (float& d : nodes.phi)
          d = std::bernoulli_distribution(dense)(random) ? near(random) : far(random);
        if (random() % 8 == 0) // now and then beyond the band
          nodes.phi[random() % kBlockNodes] = kBackground;
        builder.distance.push_back(std::make_shared<const DistanceBlock>(nodes));
      }
  return builder;
}

// Connectivity of all nodes of stored blocks and of all unstored blocks.
class Places {
 public:
  explicit Places(const FieldBuilder& builder) : builder_(builder) {
    group_.assign(builder.field.block_index.size() * kBlockNodes, -1);
    within_ = group_;
    int group = 0;
    for (std::size_t i = 0; i < group_.size(); ++i) {
      if (group_[i] < 0) flood(i, group++, false, group_);
      if (within_[i] < 0) flood(i, static_cast<int>(i), true, within_);
    }
  }

  std::int32_t slotOf(std::size_t place) const {
    return builder_.field.block_index[place / kBlockNodes];
  }
  int group(std::size_t place) const { return group_[place]; }
  int within(std::size_t place) const { return within_[place]; } // connected inside its block

  // The six neighbours, and whether the edge is safe.
  template <class Visit> void forEdges(std::size_t place, const Visit& visit) const {
    const std::size_t top = place / kBlockNodes, node = place % kBlockNodes;
    const Index3 block{static_cast<int>(top) % kBlocks[0],
                       static_cast<int>(top) / kBlocks[0] % kBlocks[1],
                       static_cast<int>(top) / kBlocks[0] / kBlocks[1]};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Index3 at = BlockNode{block, node}.at();
        at[axis] += step;
        if (at[axis] < 0 || at[axis] >= kBlockSide * kBlocks[axis]) continue;
        const BlockNode to = BlockNode::of(at);
        const std::size_t other = static_cast<std::size_t>(
            (to.block[2] * kBlocks[1] + to.block[1]) * kBlocks[0] + to.block[0]);
        visit(other * kBlockNodes + to.node);
      }
  }
  bool connected(std::size_t a, std::size_t b) const {
    const bool stored = slotOf(a) >= 0 || slotOf(b) >= 0;
    return !stored || isSafe(distance(a), distance(b));
  }

 private:
  float distance(std::size_t place) const {
    const std::int32_t slot = slotOf(place);
    return slot < 0 ? kBand
                    : builder_.distance[static_cast<std::size_t>(slot)]->phi()[place % kBlockNodes];
  }
  void flood(std::size_t from, int group, bool one_block, std::vector<int>& into) const {
    std::vector<std::size_t> todo{from};
    into[from] = group;
    while (!todo.empty()) {
      const std::size_t a = todo.back();
      todo.pop_back();
      forEdges(a, [&](std::size_t b) {
        if (into[b] >= 0 || !connected(a, b)) return;
        if (one_block && b / kBlockNodes != a / kBlockNodes) return;
        into[b] = group;
        todo.push_back(b);
      });
    }
  }

  const FieldBuilder& builder_;
  std::vector<int> group_, within_;
};

std::uint32_t partAt(const Components& components, const Places& places, std::size_t place) {
  const std::int32_t slot = places.slotOf(place);
  return slot < 0 ? components.partOfBlock(place / kBlockNodes)
                  : components.partOf(slot, place % kBlockNodes);
}

void expectBruteForce(const FieldBuilder& builder) {
  Components components = connectedComponents(builder);
  const Places places(builder);
  const std::size_t count = builder.field.block_index.size() * kBlockNodes;
  ASSERT_EQ(components.parts.size(), components.first.back() + builder.field.block_index.size());
  ASSERT_EQ(components.first.size(), builder.distance.size() + 1);

  std::map<int, std::uint32_t> part_of, root_of;
  std::vector<Part> parts(components.parts.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
  for (std::size_t place = 0; place < count; ++place) {
    const std::uint32_t part = partAt(components, places, place);
    ASSERT_EQ(part_of.try_emplace(places.within(place), part).first->second, part);
    ASSERT_EQ(root_of.try_emplace(places.group(place), components.root[part]).first->second,
              components.root[part]);
    ASSERT_LE(components.root[part], part);
    places.forEdges(place, [&](std::size_t other) {
      if (other / kBlockNodes == place / kBlockNodes || !places.connected(place, other)) return;
      const std::uint32_t to = partAt(components, places, other);
      if (part < to) ++edges[{part, to}];
    });
    if (places.slotOf(place) < 0) continue;
    Part& own = parts[part];
    const auto node = static_cast<std::uint16_t>(place % kBlockNodes);
    const auto slot = static_cast<std::size_t>(places.slotOf(place));
    const float d = builder.distance[slot]->phi()[node];
    if (own.nodes++ == 0 || d > own.depth) {
      own.depth = d;
      own.deepest = node;
    }
    own.slot = places.slotOf(place);
  }
  // There are as many parts as groups: only connected nodes are joined.
  std::set<std::uint32_t> stored_parts, roots;
  for (const auto& [place, part] : part_of)
    ASSERT_TRUE(stored_parts.insert(part).second || part >= components.first.back());
  for (const auto& [group, root] : root_of) ASSERT_TRUE(roots.insert(root).second);

  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part &part = components.parts[i], &expected = parts[i];
    ASSERT_EQ(part.slot, expected.slot);
    ASSERT_EQ(part.nodes, expected.nodes);
    ASSERT_EQ(part.deepest, expected.deepest);
    ASSERT_EQ(part.depth, std::min(expected.depth, kBand + 1));
  }
  linkUnstored(builder, components);
  ASSERT_EQ(components.links.size(), edges.size());
  for (const Link& link : components.links) {
    const auto pair = std::minmax(link.a, link.b);
    ASSERT_EQ(link.edges, edges.at(pair)) << link.a << ' ' << link.b;
  }
}

TEST(SignComponents, AreNodesConnectedBySafeEdges) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const double dense : {0.0, 0.15, 0.35, 0.6, 1.0})
      expectBruteForce(randomBuilder(seed, dense));
}

} // namespace
} // namespace patina::signs
