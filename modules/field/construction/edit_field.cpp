#include "field/construction/edit_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/store/node_reader.h"
#include "field/store/sample_block.h"

namespace patina {
namespace {

// Calls visit(slot) for a block and its stored neighbours until it returns false.
template <class Visit>
bool whileAbout(const SurfaceField& field, std::size_t slot, const Visit& visit) {
  const std::array<int, 3>& at = field.block_at[slot];
  for (int z = at[2] - 1; z <= at[2] + 1; ++z)
    for (int y = at[1] - 1; y <= at[1] + 1; ++y)
      for (int x = at[0] - 1; x <= at[0] + 1; ++x) {
        if (x < 0 || y < 0 || z < 0 || x >= field.blocks[0] || y >= field.blocks[1] ||
            z >= field.blocks[2])
          continue;
        const std::int32_t other = field.slotOf(x, y, z);
        if (other >= 0 && !visit(static_cast<std::size_t>(other))) return false;
      }
  return true;
}

} // namespace

void updateSamples(SurfaceField& field, std::span<const std::int32_t> changed,
                   const SurfaceField& original) {
  std::vector<std::uint8_t> seen(field.blockCount());
  std::vector<std::size_t> affected;
  for (const std::int32_t slot : changed)
    whileAbout(field, static_cast<std::size_t>(slot), [&](std::size_t other) {
      if (!seen[other]) affected.push_back(other);
      seen[other] = 1;
      return true;
    });
  const NodeReader nodes(field);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, affected.size(), 8),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const std::size_t slot = affected[i];
                        const bool as_original = whileAbout(field, slot, [&](std::size_t other) {
                          return field.distance[other] == original.distance[other];
                        });
                        field.sample[slot] =
                            as_original ? original.sample[slot] : sampleBlock(nodes, slot);
                      }
                    });
}

} // namespace patina
