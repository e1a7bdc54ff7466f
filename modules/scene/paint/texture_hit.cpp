#include "core/processor.h"

#define PATINA_KERNEL texture_plain
#include "scene/paint/texture_kernel.h"
#undef PATINA_KERNEL

namespace patina {
namespace texture_avx2 {
void findTextureHit(const FaceTable& faces, const PatchTable& patches, double x, double y, double z,
                    std::int32_t near_face, TextureHit& foot,
                    double* result) noexcept; // texture_avx2.cpp
}

TextureKernel textureKernel() noexcept {
#if defined(__x86_64__)
  if (hasAvx2()) return &texture_avx2::findTextureHit;
#endif
  return &texture_plain::findTextureHit;
}

} // namespace patina
