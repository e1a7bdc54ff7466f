// A Fourier texture with what is made of it once, however many faces it lies on.
#pragma once

#include <memory>

#include "scene/fourier/fourier_texture.h"
#include "scene/fourier/texture_evaluator.h"

namespace patina {

struct FeltTexture {
  FourierTexture value;
  TextureEvaluator at;
  double stiffness = 0; // [N/m] of what lies under it, by its compliance; 0: it does not say
  // By samples, with room for what lies between them: of |h| [m], of its gradient's length and of
  // its second derivative along any direction [1/m].
  double highest = 0, steepest = 0, bend = 0;
};

// Throws Error naming what is wrong with it.
std::shared_ptr<const FeltTexture> feltTexture(FourierTexture texture);

std::size_t bytes(const FeltTexture& texture); // of its coefficients and tables

// Second derivatives by x and y at a place [1/m], by differences of the gradient.
Eigen::Matrix2d bendAt(const FeltTexture& texture, double x, double y) noexcept;

} // namespace patina
