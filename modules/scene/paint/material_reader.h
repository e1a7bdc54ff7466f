// Painted material read at a point of the world (K22, K23).
#pragma once

#include "scene/paint/material_samples.h"
#include "scene/paint/material_view.h"

namespace patina {

// A view: the samples must outlive it.
class MaterialReader {
 public:
  MaterialReader(const MaterialSamples& samples, const Pose& object_from_world);

  // Servo thread: constant time, no allocation. p in metres, world. Channels that are painted
  // somewhere come into `material`, which is the base, and into `gradients`, which are
  // MaterialGradients{}.
  void read(const Vec3& p, Material& material, MaterialGradients& gradients) const noexcept {
    double* const into[] = {gradients.stiffness.data(), gradients.roughness.data()};
    look_(view_, p.data(), &material.stiffness, into);
  }

  const MaterialView& view() const noexcept { return view_; }

 private:
  MaterialView view_;
  MaterialLook look_; // for this processor
};

} // namespace patina
