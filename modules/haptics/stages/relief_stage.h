// Relief read at the contact's closest point: not a voxel of it is in the field (K21, F6, F8).
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/sampling/field_sampler.h"
#include "haptics/servo/felt_object.h"
#include "haptics/stages/stage.h"
#include "scene/paint/relief_settings.h"
#include "scene/paint/texture_reader.h"

namespace patina {

// Where the next look-up begins.
struct ReliefWalk {
  std::int32_t object = -1, face = -1;
};

// Of relief and of roughness, each its own.
struct TextureMemory {
  struct Felt {
    double height = 0; // [m]
    double depth = 0;  // [m]
    Vec3 slope = Vec3::Zero();
    double steep = 0; // its square
  };
  std::optional<Felt> last; // a tick ago
};

// The reliefs of a scene's objects, each |height| <= its `highest`.
class Reliefs {
 public:
  // Which of an object's surfaces.
  using Part = std::shared_ptr<const ReliefSurface> FeltObject::*;
  Reliefs(const FieldSampler& sampler, std::span<const FeltObject> objects,
          Part part = &FeltObject::relief);
  // At the closest point c [m, world] of the object, cut off at `highest`; flat where the object
  // has none. The walk over its faces goes on from walk. bend: as of reliefAt().
  ReliefAt at(std::int32_t object, const Vec3& c, ReliefWalk& walk,
              Eigen::Matrix3d* bend = nullptr) const noexcept {
    ReliefAt found;
    const auto i = static_cast<std::size_t>(object);
    const ReliefSurface* surface = i < felt_.size() ? felt_[i].surface.get() : nullptr;
    if (!surface) {
      if (bend) bend->setZero();
      return found;
    }
    const std::int32_t near = walk.object == object ? walk.face : -1;
    if (bend || !felt_[i].reader->read(c, near, found)) readClosest(*surface, c, near, found, bend);
    if (found.face < 0 || found.distance > lost_ ||
        (surface->image && std::abs(found.height) > felt_[i].highest)) [[unlikely]]
      mend(felt_[i], c, found, bend);
    walk = {object, found.face};
    return found;
  }
  const FieldSampler& sampler() const noexcept { return sampler_; }
  std::size_t bytes() const; // of the packed faces

 private:
  struct Felt {
    std::shared_ptr<const ReliefSurface> surface;
    double highest;
    std::int32_t first_face;
    std::optional<TextureReader> reader; // with a surface
  };
  void mend(const Felt& felt, const Vec3& c, ReliefAt& at, Eigen::Matrix3d* bend) const noexcept;

  FieldSampler sampler_;
  std::vector<Felt> felt_; // of each object
  double lost_;            // [m] from the mesh, where the walk begins afresh
};

// Behind a contact with a shell `shell` [m] outside everything, this lowers it to the relief:
// d -= shell - h, and where nothing is left of d the tip does not touch. conservative: the force is
// the gradient of 1/2 K d^2, K d (n - J^T grad h); literal: K d n (F6). The VCP is x + d (n - J^T
// grad h): on the slope's own normal, beyond the relief itself by d |grad h|^2.
//
// Where the relief is as high as the shell, the image flat and the contact nothing but the contact
// stage's, its bits stay as they are. Cliffs: the slope is not cut, since that would leave the
// height without its gradient; the force they make is the limit stage's to bound, and what they
// make it change in a tick is announced, so that it is no jump (Contact::relief_step).
class ReliefStage final : public ForceStage {
 public:
  ReliefStage(std::shared_ptr<const Reliefs> reliefs, double shell, ForceForm form)
      : reliefs_(std::move(reliefs)), shell_(shell), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::shared_ptr<const Reliefs> reliefs_;
  double shell_;
  ForceForm form_;
};

// Fourier textures as a layer over the surface that all else makes (A22, A23): with z the tip's
// height over it and h the texture's over its own lowest point,
//   F = K max(0, -z) n + k_t K max(0, h - z) (n - J^T grad h),
// the last factor n where the form is literal. 0 < z < h: the texture alone is felt. Friction is
// that of the sum. shell: the highest h there is, by which the contact was found too far out.
class TextureLayerStage final : public ForceStage {
 public:
  TextureLayerStage(std::shared_ptr<const Reliefs> reliefs, double shell, double gain,
                    ForceForm form)
      : reliefs_(std::move(reliefs)), shell_(shell), gain_(gain), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::shared_ptr<const Reliefs> reliefs_;
  double shell_, gain_;
  ForceForm form_;
};

// The rough pattern of a unit rms height is nowhere higher.
inline constexpr double kRoughnessPeak = 2.8284271247461903; // sqrt(2 waves)

// The material's roughness [m rms] as a fine solid pattern, fixed in the object: four plane waves
// of about 1 mm in directions that no face is likely to have, so that on every surface
// rms(h) = roughness in closed form: sqrt(sum a_i^2 / 2) with a_i = roughness / sqrt(2). Felt as
// relief is; h = roughness(c) w(c), and the gradient is that of both.
class RoughnessStage final : public ForceStage {
 public:
  // shell = kRoughnessPeak times the roughest there is [m].
  RoughnessStage(const FieldSampler& sampler, std::span<const FeltObject> objects, double shell,
                 ForceForm form)
      : sampler_(sampler), objects_(objects), shell_(shell), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  std::span<const FeltObject> objects_;
  double shell_;
  ForceForm form_;
};

// w of the pattern and its gradient [1/m] at p [m, object frame]; bend, where asked for, becomes
// its second derivative [1/m^2], nowhere above kRoughnessBend.
struct RoughPattern {
  double height = 0;
  Vec3 slope = Vec3::Zero();
};
RoughPattern roughPattern(const Vec3& p, Eigen::Matrix3d* bend = nullptr) noexcept;
inline constexpr double kRoughnessBend = 5.08e7; // [1/m^2], of the sum of a k k^T

} // namespace patina
