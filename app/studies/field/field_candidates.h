// Samplers that were weighed against the two of the field module, on the same stored nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/types.h"
#include "field/store/surface_field.h"

namespace patina {

struct CandidateSample {
  double phi = 0; // voxels
  Vec3 gradient = Vec3::Zero();
};

// Trilinear value with the derivative of the trilinear interpolant: first order in direction, with
// a jump at each cell face (F1). 9^3 floats a block.
class TrilinearDerivative {
 public:
  explicit TrilinearDerivative(const SurfaceField& field);
  CandidateSample atGrid(const Vec3& q) const noexcept; // q in a complete cell
  std::size_t bytes() const;

 private:
  const SurfaceField* field_;
  std::vector<float> phi_; // kSampleSide^3 a slot
};

// Quadratic B-spline whose coefficients are filtered so that it interpolates the nodes; the
// gradient is its own derivative, so that forces have a potential. 10^3 floats a block, 27 taps.
// The filter runs along whole rows of the band: an edited node changes coefficients about 8 nodes
// away.
class QuadraticSpline {
 public:
  explicit QuadraticSpline(const SurfaceField& field);
  CandidateSample atGrid(const Vec3& q) const noexcept;
  std::size_t bytes() const;
  double buildSeconds() const { return build_seconds_; }

 private:
  const SurfaceField* field_;
  std::vector<float> coefficient_; // kSide^3 a slot and a little to spare
  double build_seconds_ = 0;
};

} // namespace patina
