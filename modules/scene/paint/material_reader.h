// Reads painted material at a point of the world (K22, K23).
#pragma once

#include "scene/paint/material_samples.h"
#include "scene/paint/material_view.h"

namespace patina {

// A view of samples, which must outlive it.
class MaterialReader {
 public:
  MaterialReader(const MaterialSamples& samples, const Pose& object_from_world);

  // Servo thread: constant time, no allocation. p in metres, world. Overwrites the painted channels
  // of `material`, which holds the base, and of `gradients`, which is MaterialGradients{}.
  void read(const Vec3& p, Material& material, MaterialGradients& gradients) const noexcept {
    double* const into[] = {gradients.stiffness.data(), gradients.roughness.data()};
    kernel_(view_, p.data(), &material.stiffness, into);
  }

  const MaterialView& view() const noexcept { return view_; }

 private:
  MaterialView view_;
  MaterialKernel kernel_; // kernel for this processor
};

} // namespace patina
