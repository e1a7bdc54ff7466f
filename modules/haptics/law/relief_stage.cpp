#include "haptics/law/relief_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "haptics/contact/pull_back.h"
#include "haptics/law/contact_memory.h"

namespace patina {
namespace {

constexpr double kLostVoxels = 0.25;

void notTouching(Contact& contact) noexcept {
  contact.touching = contact.deep = contact.snap = false;
  contact.frictionless_point = contact.vcp = contact.surface = contact.tip;
  contact.normal.setZero();
  contact.slope.setZero();
  contact.depth = 0;
  contact.walls = 0;
}

// Returns |n - slope|.
double slopeLength(const Contact& contact) noexcept {
  const double square = contact.slope.squaredNorm();
  return square > 0 ? std::sqrt(1 + square) : 1; // the first stage finds slope 0
}

// Sets the depth along n to `depth` and tilts the normal by `slope`. Because |n - slope| > 1, the
// potential's depth along the tilted normal is not the distance. slope_length: |n - slope| before.
[[gnu::always_inline]] inline void setDepth(Contact& contact, double depth, const Vec3& slope,
                                            double slope_length) noexcept {
  if (!(depth > 0)) {
    notTouching(contact);
    return;
  }
  const Vec3 outward = slope_length * contact.normal - slope; // n minus all slopes
  contact.slope += slope;
  // The root and both quotients run in parallel: the latency is the longest, not the sum.
  const double square = 1 + contact.slope.squaredNorm(), length = std::sqrt(square),
               per_square = 1 / square, more = length * (depth / contact.depth);
  for (int i = 0; i < contact.walls; ++i)
    contact.wall[static_cast<std::size_t>(i)].multiplier *= more;
  contact.depth = depth * length;
  contact.normal = length * per_square * outward;
  if (contact.walls == 1) contact.wall[0].normal = contact.normal;
  contact.frictionless_point = contact.tip + depth * outward;
  contact.vcp = contact.frictionless_point;
}

// Lowers the depth by `gap`.
[[gnu::always_inline]] inline void lower(Contact& contact, double gap, const Vec3& slope) noexcept {
  if (gap == 0 && slope.isZero(0)) return;
  const double slope_length = slopeLength(contact);
  setDepth(contact, contact.depth / slope_length - gap, slope, slope_length);
}

// Returns true if no texture applies; the envelope is removed all the same.
[[gnu::always_inline]] inline bool isBare(Contact& contact, double envelope,
                                          TextureMemory& memory) noexcept {
  if (contact.touching && !contact.normal.isZero(0)) return false;
  memory.last.reset();
  if (contact.touching) lower(contact, envelope, Vec3::Zero());
  return true;
}

// Adds the largest movement of the contact point by relief since the last tick.
void announceStep(Contact& contact, TextureMemory& memory, double height,
                  const Vec3& slope) noexcept {
  TextureMemory::Sample now{height, contact.depth, slope, slope.squaredNorm()};
  if (!contact.touching) {
    now.slope.setZero();
    now.steep = 0;
  }
  if (const auto& last = memory.last)
    contact.relief_jump +=
        std::abs(now.height - last->height) * std::sqrt(1 + std::max(now.steep, last->steep)) +
        std::max(now.depth, last->depth) * (now.slope - last->slope).norm();
  memory.last = now;
}

} // namespace

Reliefs::Reliefs(const FieldSampler& sampler, std::span<const HapticObject> objects, Part part)
    : sampler_(sampler), lost_(kLostVoxels * sampler.grid().voxel) {
  for (const HapticObject& object : objects) {
    reliefs_.push_back({object.*part, object.highest, object.first_face, {}});
    if (const auto& surface = reliefs_.back().surface) reliefs_.back().reader.emplace(*surface);
  }
}

// Handles points that the walk has lost, and cubic interpolation beyond the texels' heights.
void Reliefs::correct(const ObjectRelief& relief, const Vec3& c, ReliefAt& at,
                      Eigen::Matrix3d* hessian) const noexcept {
  const ReliefSurface& surface = *relief.surface;
  if (at.face < 0 || at.distance > lost_) {
    // Restarts at the field's nearest face and keeps the result if it is closer.
    const std::int32_t near = sampler_.faceNear(c);
    Eigen::Matrix3d new_hessian;
    const ReliefAt restarted = reliefAt(surface, c, near < 0 ? -1 : near - relief.first_face,
                                        hessian ? &new_hessian : nullptr);
    if (restarted.face >= 0 && (at.face < 0 || restarted.distance < at.distance)) {
      at = restarted;
      if (hessian) *hessian = new_hessian;
    }
  }
  if (surface.image && std::abs(at.height) > relief.highest) {
    at.height = std::copysign(relief.highest, at.height);
    at.rate = 0;
    if (hessian) hessian->setZero();
  }
}

std::size_t Reliefs::bytes() const {
  std::size_t sum = 0;
  for (const ObjectRelief& relief : reliefs_)
    if (relief.surface) {
      sum += patina::bytes(*relief.surface->faces);
      if (relief.surface->textures) sum += relief.surface->textures->bytes();
    }
  return sum;
}

void ReliefStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (isBare(contact, envelope_, memory.relief)) return;
  const ReliefAt at =
      reliefs_->at(contact.object, contact.surface + contact.lateral_offset, memory.walk);
  Vec3 slope = Vec3::Zero();
  if (form_ == ForceForm::conservative)
    slope = at.rate * pulledBack(reliefs_->sampler(), contact, at.along);
  lower(contact, envelope_ - at.height, slope);
  announceStep(contact, memory.relief, at.height, slope);
}

void TextureLayerStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (isBare(contact, envelope_, memory.layer)) return;
  const ReliefAt at = reliefs_->at(contact.object, contact.surface, memory.walk);
  const double low = at.texture.texture ? at.texture.texture->value.low : 0,
               height = at.height - at.texture.weight * low, slope_length = slopeLength(contact),
               depth = contact.depth / slope_length - envelope_, rigid = std::max(depth, 0.0),
               pressed = gain_ * std::max(depth + height, 0.0);
  Vec3 slope = Vec3::Zero();
  if (form_ == ForceForm::conservative && pressed > 0)
    slope = pressed / (rigid + pressed) *
            pulledBack(reliefs_->sampler(), contact, at.slope() - low * at.texture.slope);
  setDepth(contact, rigid + pressed, slope, slope_length);
  announceStep(contact, memory.layer, gain_ * height, slope);
}

RoughPattern roughPattern(const Vec3& p, Eigen::Matrix3d* hessian) noexcept {
  // Rotated tetrahedron directions; wavelengths about 1 mm without simple ratios.
  struct Wave {
    double x, y, z, phase;
  };
  static constexpr std::array<Wave, 4> kWaves = {{{4931.2, 3021.7, 1987.3, 0.3},
                                                  {-1264.9, -2718.6, 6012.4, 1.9},
                                                  {2307.5, -5671.8, -2413.6, 4.1},
                                                  {-5377.3, 2988.1, -1902.7, 5.2}}};
  const double amplitude = std::numbers::sqrt2 / 2; // 4 a^2 / 2 = 1
  RoughPattern pattern;
  if (hessian) hessian->setZero();
  for (const Wave& wave : kWaves) {
    const Vec3 k(wave.x, wave.y, wave.z); // [rad/m]
    const double angle = k.dot(p) + wave.phase;
    pattern.height += amplitude * std::cos(angle);
    pattern.slope -= amplitude * std::sin(angle) * k;
    if (hessian) *hessian -= amplitude * std::cos(angle) * k * k.transpose();
  }
  return pattern;
}

void RoughnessStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (!contact.touching) {
    memory.roughness.last.reset();
    return;
  }
  double height = 0;
  Vec3 slope = Vec3::Zero();
  const double roughness = contact.material.roughness;
  const auto i = static_cast<std::size_t>(contact.object);
  const bool rough = roughness > 0 && i < objects_.size() && !contact.normal.isZero(0);
  if (rough) {
    const Pose& object_from_world = objects_[i].object_from_world;
    const RoughPattern pattern =
        roughPattern(object_from_world * (contact.surface + contact.lateral_offset));
    height = roughness * pattern.height;
    if (form_ == ForceForm::conservative)
      slope = pulledBack(sampler_, contact,
                         roughness * (object_from_world.linear().transpose() * pattern.slope) +
                             pattern.height * contact.gradients.roughness);
  }
  lower(contact, envelope_ - height, slope);
  announceStep(contact, memory.roughness, height, slope);
}

} // namespace patina
