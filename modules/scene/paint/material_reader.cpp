#include "scene/paint/material_reader.h"

#define PATINA_KERNEL material_plain
#include "scene/paint/material_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace material_avx2 {
bool lookUp(const MaterialView& view, const double* p,
            double (*found)[4]) noexcept; // material_avx2.cpp
}
namespace {

static_assert(kMaterialSide == 8); // material_kernel.h

MaterialLook lookOfThisProcessor() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return &material_avx2::lookUp;
#endif
  return &material_plain::lookUp;
}

} // namespace

MaterialReader::MaterialReader(const MaterialSamples& samples, const Pose& object_from_world)
    : view_{}, value_(samples.value), gradient_{} {
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
  view_.top = samples.top.data();
  view_.nodes = samples.nodes.data();
  view_.channels = samples.channels;
  for (std::size_t c = 0; c < samples.channels; ++c)
    gradient_[c] = value_[c] == &Material::stiffness   ? &MaterialGradients::stiffness
                   : value_[c] == &Material::roughness ? &MaterialGradients::roughness
                                                       : nullptr;
}

void MaterialReader::read(const Vec3& p, Material& material,
                          MaterialGradients& gradients) const noexcept {
  static const MaterialLook kLook = lookOfThisProcessor();
  alignas(32) double found[kMaterialChannels][4];
  if (!kLook(view_, p.data(), found)) return;
  for (std::size_t c = 0; c < view_.channels; ++c) {
    material.*value_[c] = found[c][3];
    if (const auto gradient = gradient_[c]) gradients.*gradient = Vec3(found[c]);
  }
}

} // namespace patina
