#include "scene/fourier/haptic_texture.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr int kLineSamples = 16, kPlaneSamples = 8;    // samples per shortest wavelength
constexpr double kBetween = 1.05, kBetweenPlane = 1.2; // margin for values between samples
constexpr double kStraight = 1. / 256;                 // step of a gradient [wavelengths]

bool dependsOnY(const FourierTexture& texture) {
  return texture.kind == TextureKind::products || texture.kind == TextureKind::plane;
}

} // namespace

std::shared_ptr<const HapticTexture> hapticTexture(FourierTexture texture) {
  if (const std::string problem = problemOf(texture); !problem.empty()) throw Error(problem);
  TextureEvaluator at(texture);
  auto made = std::make_shared<HapticTexture>(HapticTexture{std::move(texture), std::move(at)});
  const FourierTexture& value = made->value;
  if (value.compliance) made->stiffness = 1 / *value.compliance;
  const bool plane = dependsOnY(value);
  const int n = harmonics(value) * (plane ? kPlaneSamples : kLineSamples);
  const double step = period(value) / n;
  double lowest = 0;
  std::vector<TextureValue> row(static_cast<std::size_t>(n)), before;
  for (int j = 0; j <= (plane ? n : 0); ++j) {
    for (int i = 0; i < n; ++i) {
      TextureValue& here = row[static_cast<std::size_t>(i)];
      here = made->evaluator.at(i * step, j * step);
      made->highest = std::max(made->highest, std::abs(here.height));
      lowest = std::min(lowest, here.height);
      made->steepest = std::max(made->steepest, here.gradient.norm());
      const auto curvatureFrom = [&](const TextureValue& other) {
        return (here.gradient - other.gradient).norm() / step;
      };
      // The second derivative along any direction is at most the norm of both columns.
      made->max_curvature =
          std::max(made->max_curvature,
                   std::hypot(i > 0 ? curvatureFrom(row[static_cast<std::size_t>(i - 1)]) : 0,
                              j > 0 ? curvatureFrom(before[static_cast<std::size_t>(i)]) : 0));
    }
    before = row;
  }
  for (double* most : {&made->highest, &made->steepest, &made->max_curvature})
    *most *= plane ? kBetweenPlane : kBetween;
  // A layer stands on its minimum: a wrong one would make a wall or a hole.
  if (-value.low > made->highest || value.low > lowest + (kBetweenPlane - 1) * made->highest)
    throw Error("low is " + formatLength(value.low) + ", the texture's lowest height about " +
                formatLength(lowest));
  return made;
}

std::size_t bytes(const HapticTexture& texture) {
  std::size_t numbers = texture.value.plane.size();
  const auto add = [&](const FourierSeries& series) {
    numbers += series.a.size() + series.b.size();
  };
  add(texture.value.series);
  for (const FourierProduct& product : texture.value.products) {
    add(product.along_x);
    add(product.along_y);
  }
  return sizeof texture + numbers * sizeof(double) + texture.evaluator.bytes();
}

Eigen::Matrix2d hessianAt(const HapticTexture& texture, double x, double y) noexcept {
  const double d = kStraight * period(texture.value) / harmonics(texture.value);
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  hessian.col(0) =
      (texture.evaluator.at(x + d, y).gradient - texture.evaluator.at(x - d, y).gradient) / (2 * d);
  if (!dependsOnY(texture.value)) return hessian;
  hessian.col(1) =
      (texture.evaluator.at(x, y + d).gradient - texture.evaluator.at(x, y - d).gradient) / (2 * d);
  return 0.5 * (hessian + hessian.transpose());
}

} // namespace patina
