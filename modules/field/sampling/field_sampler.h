// Value and direction of a field at any point, in constant time and without allocation.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "field/build/band_cell.h"

namespace patina {

// kim: trilinear value and the trilinear blend of nodal gradients (K05, F1: direction O(h^2), value
// O(h^2)). high: same direction, value = average of trilinear and gradient-Taylor blend (F15:
// O(h^3)).
enum class Sampler : std::uint8_t { kim, high };

struct SamplerEntry {
  Sampler sampler;
  std::string_view name, caption;
};
// All of them, in the order of the enum; commands and scenes know no other list.
inline constexpr SamplerEntry kSamplers[] = {{Sampler::kim, "kim", "as in the paper"},
                                             {Sampler::high, "high", "of higher order"}};

Sampler parseSampler(std::string_view text); // throws Error naming the choices
std::string_view name(Sampler sampler);

enum class FieldRegion : std::uint8_t {
  band,    // all eight nodes stored
  outside, // farther than the band: phi is a lower bound of the distance, gradient zero
  deep,    // inside, deeper than band - 2.75 voxels (at least 0.25): from the coarse nodes
  nowhere, // a NaN point: phi = +infinity
};

// In voxels; the gradient is dimensionless and not normalised.
struct GridSample {
  double phi = 0;
  Vec3 gradient = Vec3::Zero();
  FieldRegion region = FieldRegion::outside;
};

// As GridSample, for what follows the surface itself (P02). Where the eight nodes agree about the
// direction the gradient is their blend; across a crease, where a blend is the direction of neither
// side, it is the derivative of the sampler's own value.
struct SurfaceSample {
  double phi = 0;
  Vec3 gradient = Vec3::Zero();
  double spread = 0; // of the nodes' directions: 0 = one, 1 = opposite ones; 0 where they agree
  FieldRegion region = FieldRegion::outside;
};

// Spread of the nodes' directions up to which they are one.
inline constexpr double kAgreedSpread = 0.0006;

// A view: the field must outlive it and must have its sample layer. Any thread.
//
// From band to deep the value passes over one voxel of depth to the coarse one, which is held at
// band - 1.75 or deeper: in bands of 3 voxels or more depth is continuous and never falls on the
// way in. Without a coarse layer points deeper than the band report phi = -band and a zero
// gradient.
class FieldSampler {
 public:
  FieldSampler(const SurfaceField& field, Sampler sampler); // invalid_argument without samples

  GridSample atGrid(const Vec3& q) const noexcept; // q in grid coordinates
  // own: share of the value's own derivative in the gradient also where the nodes agree, 0 .. 1.
  // With 0 a crease is told only where the blend's length is not 1 either, as beside every crease
  // of a distance; between baked flanks of one slope it may be.
  // seen, where asked for, becomes the cell about q, if that is in the band.
  SurfaceSample surfaceAtGrid(const Vec3& q, double own = 0,
                              BandCell* seen = nullptr) const noexcept;
  // The cell about q; false outside of the band.
  bool cellAt(const Vec3& q, BandCell& cell) const noexcept {
    return findCell(*field_, last_node_, q, cell);
  }
  // Only the value, for root finding along a ray.
  double phiAtGrid(const Vec3& q) const noexcept;
  // In metres: phi [m].
  GridSample at(const Vec3& p) const noexcept {
    GridSample sample = atGrid(grid_.toGrid(p));
    sample.phi *= grid_.voxel;
    return sample;
  }
  // Deep inside: what the eight coarse nodes about q know of the surface. Not for every tick.
  struct DeepFeet {
    Vec3 nearest = Vec3::Zero(); // of their nearest surface points the one nearest to q
    bool opposed = false; // another, on about the opposite side, is as near within a coarse cell
  };
  // In grid coordinates; exact to second order in q's distance from a node. Nothing where no coarse
  // node about is inside and has one nearest point.
  std::optional<DeepFeet> deepFeet(const Vec3& q) const noexcept;
  // Nearest face of the nearest stored node of p's cell; -1 if none.
  std::int32_t faceNear(const Vec3& p) const noexcept;

  const FieldGrid& grid() const noexcept { return grid_; }
  double perVoxel() const noexcept { return per_voxel_; } // [1/m]
  // By a product: quicker than the grid's own division, from which its last bit may differ.
  Vec3 toGrid(const Vec3& p) const noexcept { return per_voxel_ * (p - grid_.origin); }
  Sampler sampler() const noexcept { return sampler_; }

 private:
  Blend blended(const BandCell& cell) const noexcept {
    return sampler_ == Sampler::high ? blend<true>(cell) : blend<false>(cell);
  }
  void followCrease(const BandCell& cell, double own, SurfaceSample& sample) const noexcept;
  GridSample beyondBand(const Vec3& q) const noexcept;
  GridSample deepSample(const Vec3& q) const noexcept;
  GridSample handOver(const Vec3& q, const GridSample& sample) const noexcept;

  const SurfaceField* field_;
  FieldGrid grid_;
  double per_voxel_;
  Sampler sampler_;
  Vec3 last_node_;   // grid coordinates; cells lie in [0, last_node_)
  double hand_over_; // phi below which the coarse nodes are blended in
};

inline SurfaceSample FieldSampler::surfaceAtGrid(const Vec3& q, double own,
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
  if (std::abs(squared - 1) > kAgreedSpread || own > 0) [[unlikely]]
    followCrease(cell, own, sample);
  return sample;
}

} // namespace patina
