#include "haptics/stages/relief_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "haptics/contact/contact_memory.h"
#include "haptics/contact/pull_back.h"

namespace patina {
namespace {

constexpr double kLostVoxels = 0.25;

void notTouching(Contact& contact) noexcept {
  contact.touching = contact.deep = contact.snap = false;
  contact.candidate = contact.vcp = contact.surface = contact.tip;
  contact.normal.setZero();
  contact.slope.setZero();
  contact.depth = 0;
  contact.walls = 0;
}

// Length of n - slope.
double steepnessOf(const Contact& contact) noexcept {
  const double square = contact.slope.squaredNorm();
  return square > 0 ? std::sqrt(1 + square) : 1; // of the first stage it is 0
}

// `depth` becomes that along n, and the normal leans by `slope` more. n - slope is longer than 1:
// of a potential, the depth along the leaning normal is not the distance. steepness: as it was.
[[gnu::always_inline]] inline void settle(Contact& contact, double depth, const Vec3& slope,
                                          double steepness) noexcept {
  if (!(depth > 0)) {
    notTouching(contact);
    return;
  }
  const Vec3 outward = steepness * contact.normal - slope; // n - all slopes
  contact.slope += slope;
  // The root and both quotients at one time: a tick waits for the longest, not for their sum.
  const double square = 1 + contact.slope.squaredNorm(), length = std::sqrt(square),
               per_square = 1 / square, more = length * (depth / contact.depth);
  for (int i = 0; i < contact.walls; ++i) contact.wall[static_cast<std::size_t>(i)].load *= more;
  contact.depth = depth * length;
  contact.normal = length * per_square * outward;
  if (contact.walls == 1) contact.wall[0].normal = contact.normal;
  contact.candidate = contact.tip + depth * outward;
  contact.vcp = contact.candidate;
}

// d -= gap.
[[gnu::always_inline]] inline void lower(Contact& contact, double gap, const Vec3& slope) noexcept {
  if (gap == 0 && slope.isZero(0)) return;
  const double steepness = steepnessOf(contact);
  settle(contact, contact.depth / steepness - gap, slope, steepness);
}

// Where no surface is to be read; the shell is taken off all the same.
[[gnu::always_inline]] inline bool isBare(Contact& contact, double shell,
                                          TextureMemory& memory) noexcept {
  if (contact.touching && !contact.normal.isZero(0)) return false;
  memory.last.reset();
  if (contact.touching) lower(contact, shell, Vec3::Zero());
  return true;
}

// By how much the relief itself has moved the VCP since the last tick, at most.
void announceStep(Contact& contact, TextureMemory& memory, double height,
                  const Vec3& slope) noexcept {
  TextureMemory::Felt now{height, contact.depth, slope, slope.squaredNorm()};
  if (!contact.touching) {
    now.slope.setZero();
    now.steep = 0;
  }
  if (const auto& last = memory.last)
    contact.relief_step +=
        std::abs(now.height - last->height) * std::sqrt(1 + std::max(now.steep, last->steep)) +
        std::max(now.depth, last->depth) * (now.slope - last->slope).norm();
  memory.last = now;
}

} // namespace

Reliefs::Reliefs(const FieldSampler& sampler, std::span<const FeltObject> objects, Part part)
    : sampler_(sampler), lost_(kLostVoxels * sampler.grid().voxel) {
  for (const FeltObject& object : objects) {
    felt_.push_back({object.*part, object.highest, object.first_face, {}});
    if (const auto& surface = felt_.back().surface) felt_.back().reader.emplace(*surface);
  }
}

// What is rare: a point that the walk has lost, and heights between texels, where a cubic
// overshoots.
void Reliefs::mend(const Felt& felt, const Vec3& c, ReliefAt& at,
                   Eigen::Matrix3d* bend) const noexcept {
  const ReliefSurface& surface = *felt.surface;
  if (at.face < 0 || at.distance > lost_) {
    // From the face that the field knows, if that is nearer.
    const std::int32_t near = sampler_.faceNear(c);
    Eigen::Matrix3d bent;
    const ReliefAt afresh =
        reliefAt(surface, c, near < 0 ? -1 : near - felt.first_face, bend ? &bent : nullptr);
    if (afresh.face >= 0 && (at.face < 0 || afresh.distance < at.distance)) {
      at = afresh;
      if (bend) *bend = bent;
    }
  }
  if (surface.image && std::abs(at.height) > felt.highest) {
    at.height = std::copysign(felt.highest, at.height);
    at.rate = 0;
    if (bend) bend->setZero();
  }
}

std::size_t Reliefs::bytes() const {
  std::size_t sum = 0;
  for (const Felt& felt : felt_)
    if (felt.surface) {
      sum += patina::bytes(*felt.surface->faces);
      if (felt.surface->textures) sum += felt.surface->textures->bytes();
    }
  return sum;
}

void ReliefStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (isBare(contact, shell_, memory.relief)) return;
  const ReliefAt at = reliefs_->at(contact.object, contact.surface + contact.aside, memory.walk);
  Vec3 slope = Vec3::Zero();
  if (form_ == ForceForm::conservative)
    slope = at.rate * pulledBack(reliefs_->sampler(), contact, at.along);
  lower(contact, shell_ - at.height, slope);
  announceStep(contact, memory.relief, at.height, slope);
}

void TextureLayerStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  if (isBare(contact, shell_, memory.layer)) return;
  const ReliefAt at = reliefs_->at(contact.object, contact.surface, memory.walk);
  const double low = at.texture.of ? at.texture.of->value.low : 0,
               height = at.height - at.texture.share * low, steepness = steepnessOf(contact),
               depth = contact.depth / steepness - shell_, rigid = std::max(depth, 0.0),
               pressed = gain_ * std::max(depth + height, 0.0);
  Vec3 slope = Vec3::Zero();
  if (form_ == ForceForm::conservative && pressed > 0)
    slope = pressed / (rigid + pressed) *
            pulledBack(reliefs_->sampler(), contact, at.slope() - low * at.texture.slope);
  settle(contact, rigid + pressed, slope, steepness);
  announceStep(contact, memory.layer, gain_ * height, slope);
}

RoughPattern roughPattern(const Vec3& p, Eigen::Matrix3d* bend) noexcept {
  // Directions of a tetrahedron, turned; wavelengths about 1 mm whose ratios are no small
  // fractions.
  struct Wave {
    double x, y, z, phase;
  };
  static constexpr std::array<Wave, 4> kWaves = {{{4931.2, 3021.7, 1987.3, 0.3},
                                                  {-1264.9, -2718.6, 6012.4, 1.9},
                                                  {2307.5, -5671.8, -2413.6, 4.1},
                                                  {-5377.3, 2988.1, -1902.7, 5.2}}};
  const double amplitude = std::numbers::sqrt2 / 2; // 4 a^2 / 2 = 1
  RoughPattern pattern;
  if (bend) bend->setZero();
  for (const Wave& wave : kWaves) {
    const Vec3 k(wave.x, wave.y, wave.z); // [rad/m]
    const double angle = k.dot(p) + wave.phase;
    pattern.height += amplitude * std::cos(angle);
    pattern.slope -= amplitude * std::sin(angle) * k;
    if (bend) *bend -= amplitude * std::cos(angle) * k * k.transpose();
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
        roughPattern(object_from_world * (contact.surface + contact.aside));
    height = roughness * pattern.height;
    if (form_ == ForceForm::conservative)
      slope = pulledBack(sampler_, contact,
                         roughness * (object_from_world.linear().transpose() * pattern.slope) +
                             pattern.height * contact.gradients.roughness);
  }
  lower(contact, shell_ - height, slope);
  announceStep(contact, memory.roughness, height, slope);
}

} // namespace patina
