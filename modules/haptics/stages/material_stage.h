// What the contact is made of: painted values at the closest point of the surface (K12, K22, K23).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "field/sampling/field_sampler.h"
#include "haptics/servo/felt_object.h"
#include "haptics/stages/relief_stage.h"
#include "haptics/stages/stage.h"
#include "scene/paint/material_reader.h"

namespace patina {

// Which object a contact belongs to: that of the face nearest to it. Only where there are several
// and paint on one of them.
class OwnerStage final : public ForceStage {
 public:
  OwnerStage(const FieldSampler& sampler, std::span<const FeltObject> objects)
      : sampler_(sampler), objects_(objects) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::int32_t ownerAt(const Vec3& p) const noexcept; // 0 where nothing is known

 private:
  FieldSampler sampler_;
  std::span<const FeltObject> objects_;
};

// Sets Contact::material and how it changes over the surface; of stiffness only with `gradients`.
// Objects without paint keep the snapshot's base.
class MaterialStage final : public ForceStage {
 public:
  MaterialStage(std::span<const FeltObject> objects, bool gradients);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::vector<std::optional<MaterialReader>> readers_; // of each object
  bool gradients_;
};

// Where a Fourier texture lies that was scanned with its compliance, the surface is as stiff as
// that says (A22); where it fades out, in part. Behind what knows the material.
class TextureStiffnessStage final : public ForceStage {
 public:
  TextureStiffnessStage(std::shared_ptr<const Reliefs> reliefs, bool gradients)
      : reliefs_(std::move(reliefs)), gradients_(gradients) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::shared_ptr<const Reliefs> reliefs_;
  bool gradients_;
};

struct StiffnessSlopeMemory {
  double force = 0; // [N], a tick ago
};

// F6: K d along the normal alone does work round a loop where K changes along the surface. Behind
// the law's own stage this one adds what makes the force the gradient of U = 1/2 K(c) d^2:
// -1/2 d^2 grad K, through the coupling where there is one, whose k = K k_c / (K + k_c) takes the
// place of K. Part of the surface and not of friction's grip.
class StiffnessSlopeStage final : public ForceStage {
 public:
  explicit StiffnessSlopeStage(const FieldSampler& sampler) : sampler_(sampler) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
};

} // namespace patina
