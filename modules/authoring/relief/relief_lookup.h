// Image positions at which a field's nodes read their relief. Internal to the bake.
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
// Marks nodes closest to the back or a side of a sheet, which relief does not move.
inline constexpr NodeUv kNoLookup{std::numeric_limits<float>::infinity(),
                                  std::numeric_limits<float>::infinity()};

// Look-ups of one block: its nodes of the band, in order, have the entries from `first` on.
struct BlockLookups {
  static constexpr std::int32_t kNone = -1;  // no entries: the block has no relief
  static constexpr std::int32_t kMixed = -2; // each entry has its own source, from `first_source`

  std::int32_t source = kNone;
  std::size_t first = 0, first_source = 0;
  NodeUv low{1, 1}, high{0, 0}; // bounds of the entries of all sources
};

struct CoarseLookup {
  static constexpr std::int32_t kFlat = -1;    // no relief at its closest point
  static constexpr std::int32_t kMean = -2;    // inside, without a unique closest point
  static constexpr std::int32_t kOutside = -3; // outside the band

  std::int32_t source = kFlat;
  NodeUv uv{};
};

struct ReliefLookups {
  std::vector<BlockLookups> block; // per slot
  std::vector<NodeUv> uv;
  std::vector<std::int32_t> source; // per entry of mixed blocks
  std::vector<CoarseLookup> coarse; // same order as the field's
  std::vector<std::uint8_t> plates; // per source: 1 = some of its faces are fronts of sheets

  std::size_t bytes() const;
};

// Parallel; polls `progress` and throws Cancelled.
ReliefLookups reliefLookups(const SurfaceField& field, const TriangleMesh& mesh,
                            std::span<const ReliefInput> sources, Progress& progress);

} // namespace patina
