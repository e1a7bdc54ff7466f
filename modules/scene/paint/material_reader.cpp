#include "scene/paint/material_reader.h"

#include "core/processor.h"

#define PATINA_KERNEL material_plain
#include "scene/paint/material_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace material_avx2 {
void lookUp(const MaterialView& view, const double* p, double* material,
            double* const* gradients) noexcept; // material_avx2.cpp
}
namespace {

// Assumptions of material_kernel.h.
static_assert(kMaterialSide == 8);
static_assert(MaterialView::kMaxChannels == kMaterialChannels);
static_assert(sizeof(Material) == kMaterialChannels * sizeof(double));

MaterialKernel kernelOfThisProcessor() {
#if defined(__x86_64__)
  if (hasAvx2()) return &material_avx2::lookUp;
#endif
  return &material_plain::lookUp;
}

} // namespace

MaterialReader::MaterialReader(const MaterialSamples& samples, const Pose& object_from_world)
    : view_{}, kernel_(kernelOfThisProcessor()) {
  const Eigen::Matrix3d by = samples.per_voxel * object_from_world.linear();
  const Vec3 at = samples.per_voxel * (object_from_world.translation() - samples.origin);
  const auto right = static_cast<std::int32_t>(samples.channels);
  std::int32_t block_step = 1, step = right;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    for (int of = 0; of < 3; ++of) {
      view_.node_of_world[of][a] = by(a, of);
      view_.by_world[a][of] = by(a, of);
    }
    view_.node_of_world[3][a] = at[a] - kMaterialSide * samples.first[i];
    view_.count[a] = kMaterialSide * samples.blocks[i];
    view_.block_step[a] = block_step;
    view_.step[a] = step;
    if (a < 2) {
      block_step *= samples.blocks[i];
      step *= kMaterialSide + 1;
    }
  }
  view_.count[3] = 1;
  view_.block_index = samples.block_index.data();
  view_.nodes = samples.nodes.data();
  view_.channels = samples.channels;
  std::size_t c = 0;
  for (const MaterialChannel channel : kAllMaterialChannels)
    if (samples.painted[static_cast<std::size_t>(channel)])
      view_.channel[c++] = {static_cast<std::int32_t>(channel),
                            channel == MaterialChannel::stiffness   ? 0
                            : channel == MaterialChannel::roughness ? 1
                                                                    : -1};
}

} // namespace patina
