// Interpolates a field at any point, in constant time and without allocation.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "field/sampling/band_cell.h"

namespace patina {

// kim: trilinear value and trilinear blend of nodal gradients (K05, F1: both O(h^2)). high: the
// same direction, and the average of the trilinear value and the gradient-Taylor blend (F15:
// O(h^3)).
enum class Sampler : std::uint8_t { kim, high };

struct SamplerEntry {
  Sampler sampler;
  std::string_view name, caption;
};
// All samplers, in the order of the enum. Commands and scenes use this list.
inline constexpr SamplerEntry kSamplers[] = {{Sampler::kim, "kim", "as in the paper"},
                                             {Sampler::high, "high", "of higher order"}};

Sampler parseSampler(std::string_view text); // throws Error naming the choices
std::string_view name(Sampler sampler);

enum class FieldRegion : std::uint8_t {
  band,     // all eight nodes stored
  outside,  // farther than the band: phi is a lower bound of the distance, gradient zero
  interior, // inside, deeper than band - 2.75 voxels (at least 0.25): read from the coarse nodes
  invalid,  // NaN point: phi = +infinity
};

// Values in voxels; the gradient is dimensionless and not normalised.
struct GridSample {
  double phi = 0;
  Vec3 gradient = Vec3::Zero();
  FieldRegion region = FieldRegion::outside;
};

// Sample for methods that follow the surface (P02). The gradient is the blend of the eight nodal
// directions if they agree. Across a crease, where the blend is the direction of neither side, it
// is the derivative of the sampler's own value.
struct SurfaceSample {
  double phi = 0;
  Vec3 gradient = Vec3::Zero();
  double normal_dispersion = 0; // nodal directions: 0 = equal, 1 = opposite; small values become 0
  FieldRegion region = FieldRegion::outside;
};

// Largest dispersion of the nodal directions that counts as agreement.
inline constexpr double kMaxNormalDispersion = 0.0006;

// View of a field, which must outlive it and have its sample layer. Any thread.
// Between band and interior the value changes over one voxel of depth to the coarse one, which is
// clamped to band - 1.75 or deeper: in bands of at least 3 voxels depth is continuous and
// monotonic. Without a coarse layer points deeper than the band get phi = -band and a zero
// gradient.
class FieldSampler {
 public:
  FieldSampler(const SurfaceField& field,
               Sampler sampler); // throws

  GridSample atGrid(const Vec3& q) const noexcept; // q is in grid coordinates
  // `exact_gradient_weight` (0 .. 1) blends the interpolant's exact derivative into the gradient
  // even if the nodal directions agree. With 0 a crease is detected only if the blended gradient is
  // not of unit length, which may miss one between baked slopes. `seen` receives the cell of q if
  // that is in the band.
  SurfaceSample surfaceAtGrid(const Vec3& q, double exact_gradient_weight = 0,
                              BandCell* seen = nullptr) const noexcept;
  // Finds the cell of q. Returns false outside the band.
  bool cellAt(const Vec3& q, BandCell& cell) const noexcept {
    return findCell(*field_, last_node_, q, cell);
  }
  // Returns only the value, for root finding along a ray.
  double phiAtGrid(const Vec3& q) const noexcept;
  // The same in metres: p [m] to phi [m].
  GridSample at(const Vec3& p) const noexcept {
    GridSample sample = atGrid(grid_.toGrid(p));
    sample.phi *= grid_.voxel;
    return sample;
  }
  // Estimate from the eight coarse nodes about a deep point. Too slow for every tick.
  struct InteriorClosestPoints {
    Vec3 nearest = Vec3::Zero(); // surface point nearest to q
    bool opposed = false;        // an opposite one is as near
  };
  // q in grid coordinates; exact to second order in q's distance from a node. Returns nullopt
  // unless a neighbouring coarse node is inside with a unique nearest point.
  std::optional<InteriorClosestPoints> interiorClosestPoints(const Vec3& q) const noexcept;
  // Returns the nearest face of the nearest stored node of p's cell, or -1.
  std::int32_t faceNear(const Vec3& p) const noexcept;

  const FieldGrid& grid() const noexcept { return grid_; }
  double perVoxel() const noexcept { return per_voxel_; } // [1/m]
  // Multiplies, which is faster than the grid's own division; the last bit may differ.
  Vec3 toGrid(const Vec3& p) const noexcept { return per_voxel_ * (p - grid_.origin); }
  Sampler sampler() const noexcept { return sampler_; }

 private:
  Blend blended(const BandCell& cell) const noexcept {
    return sampler_ == Sampler::high ? blend<true>(cell) : blend<false>(cell);
  }
  void applyExactGradient(const BandCell& cell, double exact_gradient_weight,
                          SurfaceSample& sample) const noexcept;
  GridSample beyondBand(const Vec3& q) const noexcept;
  GridSample interiorSample(const Vec3& q) const noexcept;
  GridSample blendToCoarse(const Vec3& q, const GridSample& sample) const noexcept;

  const SurfaceField* field_;
  FieldGrid grid_;
  double per_voxel_;
  Sampler sampler_;
  Vec3 last_node_;        // grid coordinates; cells lie in [0, last_node_)
  double transition_phi_; // phi below which the coarse nodes are blended in
};

inline SurfaceSample FieldSampler::surfaceAtGrid(const Vec3& q, double exact_gradient_weight,
                                                 BandCell* seen) const noexcept {
  SurfaceSample sample;
  BandCell cell;
  if (!findCell(*field_, last_node_, q, cell)) [[unlikely]] {
    const GridSample beyond = beyondBand(q);
    return {beyond.phi, beyond.gradient, 0, beyond.region};
  }
  if (seen) *seen = cell;
  const Blend value = blended(cell);
  sample.phi = static_cast<double>(value.sum[0] + value.taylor_half);
  sample.region = FieldRegion::band;
  const float squared =
      value.sum[1] * value.sum[1] + value.sum[2] * value.sum[2] + value.sum[3] * value.sum[3];
  sample.gradient = Vec3(value.sum[1], value.sum[2], value.sum[3]);
  if (std::abs(squared - 1) > kMaxNormalDispersion || exact_gradient_weight > 0) [[unlikely]]
    applyExactGradient(cell, exact_gradient_weight, sample);
  return sample;
}

} // namespace patina
