// Material of the contact: painted values at the closest surface point (K12, K22, K23).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "field/sampling/field_sampler.h"
#include "haptics/law/haptic_object.h"
#include "haptics/law/relief_stage.h"
#include "haptics/law/stage.h"
#include "scene/paint/material_reader.h"

namespace patina {

// Sets the object of a contact by its nearest face, if one of several objects is painted.
class OwnerStage final : public ForceStage {
 public:
  OwnerStage(const FieldSampler& sampler, std::span<const HapticObject> objects)
      : sampler_(sampler), objects_(objects) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::int32_t ownerAt(const Vec3& p) const noexcept; // 0 if unknown

 private:
  FieldSampler sampler_;
  std::span<const HapticObject> objects_;
};

// Sets Contact::material and its gradients along the surface, stiffness only with `gradients`.
// Objects without paint keep the snapshot's base.
class MaterialStage final : public ForceStage {
 public:
  MaterialStage(std::span<const HapticObject> objects, bool gradients);
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::vector<std::optional<MaterialReader>> readers_; // index: object
  bool gradients_;
};

// A Fourier texture that was scanned with its compliance sets the stiffness of the surface (A22),
// blended where the texture fades out. Runs after the material.
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
  double force = 0; // [N], last tick
};

// F6: the normal force K d alone generates energy on a closed path if K varies along the surface.
// This stage adds the missing gradient term of U = 1/2 K(c) d^2, -1/2 d^2 grad K; with a coupling k
// = K k_c / (K + k_c) replaces K. The term belongs to the surface and does not change stiction.
// Runs after the stage that applies the spring.
class StiffnessGradientStage final : public ForceStage {
 public:
  explicit StiffnessGradientStage(const FieldSampler& sampler) : sampler_(sampler) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
};

} // namespace patina
