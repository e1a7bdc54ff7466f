// Where the nodes of a field read their relief: private to the bake.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "authoring/relief/relief_bake.h"

namespace patina {

using NodeUv = std::array<float, 2>;
// Of a node that is nearest to the back or a side of a plate, which no relief moves.
inline constexpr NodeUv kNoFoot{std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::infinity()};

// Of one block; its nodes of the band, in order, have the entries from `first` on.
struct BlockFeet {
  static constexpr std::int32_t kNone = -1;  // nothing in the block has relief: no entries
  static constexpr std::int32_t kMixed = -2; // each entry has its own source, from `first_source`

  std::int32_t source = kNone;
  std::size_t first = 0, first_source = 0;
  NodeUv low{1, 1}, high{0, 0}; // of the entries; not told apart by source
};

struct CoarseFoot {
  static constexpr std::int32_t kFlat = -1;    // where it is nearest to there is no relief
  static constexpr std::int32_t kMean = -2;    // inside, without a foot of its own
  static constexpr std::int32_t kOutside = -3; // of the band

  std::int32_t source = kFlat;
  NodeUv uv{};
};

struct ReliefFeet {
  std::vector<BlockFeet> block; // by slot
  std::vector<NodeUv> uv;
  std::vector<std::int32_t> source; // of entries in mixed blocks; BlockFeet::kNone = no relief
  std::vector<CoarseFoot> coarse;   // as the field's
  std::vector<std::uint8_t> plates; // by source: 1 = some of its faces are fronts of plates

  std::size_t bytes() const;
};

// Parallel; polls `progress` and throws Cancelled.
ReliefFeet reliefFeet(const SurfaceField& field, const TriangleMesh& mesh,
                      std::span<const ReliefSource> sources, Progress& progress);

} // namespace patina
