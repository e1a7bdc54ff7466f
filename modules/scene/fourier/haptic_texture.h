// A Fourier texture with the data computed from it once, for any number of faces.
#pragma once

#include <memory>

#include "scene/fourier/fourier_texture.h"
#include "scene/fourier/texture_evaluator.h"

namespace patina {

struct HapticTexture {
  FourierTexture value;
  TextureEvaluator evaluator;
  double stiffness = 0; // [N/m] of the material underneath, from its compliance; 0: unknown
  // Sampled maxima with a margin: of |h| [m], of the gradient's length and of the second derivative
  // along any direction [1/m].
  double highest = 0, steepest = 0, max_curvature = 0;
};

// Throws Error naming the fault of the texture.
std::shared_ptr<const HapticTexture> hapticTexture(FourierTexture texture);

std::size_t bytes(const HapticTexture& texture); // coefficients and tables

// Returns the Hessian by x and y at a point [1/m], from differences of the gradient.
Eigen::Matrix2d hessianAt(const HapticTexture& texture, double x, double y) noexcept;

} // namespace patina
