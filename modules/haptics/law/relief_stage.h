// Relief evaluated at the contact's closest point, without changing the field (K21, F6, F8).
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/sampling/field_sampler.h"
#include "haptics/law/haptic_object.h"
#include "haptics/law/stage.h"
#include "scene/paint/relief_settings.h"
#include "scene/paint/texture_reader.h"

namespace patina {

// Start of the next lookup.
struct ReliefWalk {
  std::int32_t object = -1, face = -1;
};

// State of the relief stage; the roughness stage has its own.
struct TextureMemory {
  struct Sample {
    double height = 0; // [m]
    double depth = 0;  // [m]
    Vec3 slope = Vec3::Zero();
    double steep = 0; // squared slope
  };
  std::optional<Sample> last; // last tick
};

// Reliefs of a scene's objects, each with |height| <= its `highest`.
class Reliefs {
 public:
  // Selects one of an object's surfaces.
  using Part = std::shared_ptr<const ReliefSurface> HapticObject::*;
  Reliefs(const FieldSampler& sampler, std::span<const HapticObject> objects,
          Part part = &HapticObject::relief);
  // Evaluates the relief at the closest point c [m, world] of the object, clamped to `highest`;
  // flat without relief. Continues the walk over its faces. hessian: as in reliefAt().
  ReliefAt at(std::int32_t object, const Vec3& c, ReliefWalk& walk,
              Eigen::Matrix3d* hessian = nullptr) const noexcept {
    ReliefAt found;
    const auto i = static_cast<std::size_t>(object);
    const ReliefSurface* surface = i < reliefs_.size() ? reliefs_[i].surface.get() : nullptr;
    if (!surface) {
      if (hessian) hessian->setZero();
      return found;
    }
    const std::int32_t near = walk.object == object ? walk.face : -1;
    if (hessian || !reliefs_[i].reader->read(c, near, found))
      readClosest(*surface, c, near, found, hessian);
    if (found.face < 0 || found.distance > lost_ ||
        (surface->image && std::abs(found.height) > reliefs_[i].highest)) [[unlikely]]
      correct(reliefs_[i], c, found, hessian);
    walk = {object, found.face};
    return found;
  }
  const FieldSampler& sampler() const noexcept { return sampler_; }
  std::size_t bytes() const; // bytes of the packed faces

 private:
  struct ObjectRelief {
    std::shared_ptr<const ReliefSurface> surface;
    double highest;
    std::int32_t first_face;
    std::optional<TextureReader> reader; // present with a surface
  };
  void correct(const ObjectRelief& relief, const Vec3& c, ReliefAt& at,
               Eigen::Matrix3d* hessian) const noexcept;

  FieldSampler sampler_;
  std::vector<ObjectRelief> reliefs_; // index: object
  double lost_;                       // distance from the mesh that restarts the walk [m]
};

// Follows a contact with an offset envelope `envelope` [m] and lowers it to the relief: d -=
// envelope - h; without depth there is no contact. conservative: the force is the gradient of 1/2 K
// d^2, K d (n - J^T grad h); literal: K d n (F6). The contact point is x + d (n - J^T grad h): on
// the slope's normal, beyond the relief by d |grad h|^2.  Relief at the height of the envelope with
// a flat image leaves the contact stage's bits unchanged. Slopes at cliffs are not clamped, because
// the height would lose its gradient; the limit stage bounds their force, and their change per tick
// is announced in Contact::relief_jump so that it is no fault.
class ReliefStage final : public ForceStage {
 public:
  ReliefStage(std::shared_ptr<const Reliefs> reliefs, double envelope, ForceForm form)
      : reliefs_(std::move(reliefs)), envelope_(envelope), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::shared_ptr<const Reliefs> reliefs_;
  double envelope_;
  ForceForm form_;
};

// Fourier textures as a layer above the surface (A22, A23): with z the tip's height above the
// surface and h the texture's above its lowest point,
//   F = K max(0, -z) n + k_t K max(0, h - z) (n - J^T grad h),
// with the last factor n in the literal form. At 0 < z < h only the texture acts. Friction uses the
// sum. envelope: largest h, the offset at which contact was found.
class TextureLayerStage final : public ForceStage {
 public:
  TextureLayerStage(std::shared_ptr<const Reliefs> reliefs, double envelope, double gain,
                    ForceForm form)
      : reliefs_(std::move(reliefs)), envelope_(envelope), gain_(gain), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  std::shared_ptr<const Reliefs> reliefs_;
  double envelope_, gain_;
  ForceForm form_;
};

// Largest height of the rough pattern of unit RMS height.
inline constexpr double kRoughnessPeak = 2.8284271247461903; // sqrt(2 waves)

// Roughness of the material [m RMS] as a fine solid pattern in the object's frame: four plane waves
// of about 1 mm in directions that faces are unlikely to have, so that rms(h) = roughness on every
// surface: sqrt(sum a_i^2 / 2) with a_i = roughness / sqrt(2). Acts like relief; h = roughness(c)
// w(c) with the gradient of both factors.
class RoughnessStage final : public ForceStage {
 public:
  // envelope = kRoughnessPeak times the largest roughness [m].
  RoughnessStage(const FieldSampler& sampler, std::span<const HapticObject> objects,
                 double envelope, ForceForm form)
      : sampler_(sampler), objects_(objects), envelope_(envelope), form_(form) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
  std::span<const HapticObject> objects_;
  double envelope_;
  ForceForm form_;
};

// Pattern w and its gradient [1/m] at p [m, object frame]; if given, `hessian` receives the Hessian
// [1/m^2], whose norm never exceeds kRoughnessMaxCurvature.
struct RoughPattern {
  double height = 0;
  Vec3 slope = Vec3::Zero();
};
RoughPattern roughPattern(const Vec3& p, Eigen::Matrix3d* hessian = nullptr) noexcept;
inline constexpr double kRoughnessMaxCurvature = 5.08e7; // [1/m^2], norm of the sum of a k k^T

} // namespace patina
