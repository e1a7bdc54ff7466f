#include "scene/fourier/felt_texture.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr int kLineSamples = 16, kPlaneSamples = 8;    // a shortest wavelength
constexpr double kBetween = 1.05, kBetweenPlane = 1.2; // what lies between samples may be more
constexpr double kStraight = 1. / 256; // of a shortest wavelength: the gradient is all but straight

bool dependsOnY(const FourierTexture& texture) {
  return texture.kind == TextureKind::products || texture.kind == TextureKind::plane;
}

} // namespace

std::shared_ptr<const FeltTexture> feltTexture(FourierTexture texture) {
  if (const std::string problem = problemOf(texture); !problem.empty()) throw Error(problem);
  TextureEvaluator at(texture);
  auto made = std::make_shared<FeltTexture>(FeltTexture{std::move(texture), std::move(at)});
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
      here = made->at.at(i * step, j * step);
      made->highest = std::max(made->highest, std::abs(here.height));
      lowest = std::min(lowest, here.height);
      made->steepest = std::max(made->steepest, here.gradient.norm());
      const auto bendFrom = [&](const TextureValue& other) {
        return (here.gradient - other.gradient).norm() / step;
      };
      // No direction bends more than both columns together.
      made->bend = std::max(made->bend,
                            std::hypot(i > 0 ? bendFrom(row[static_cast<std::size_t>(i - 1)]) : 0,
                                       j > 0 ? bendFrom(before[static_cast<std::size_t>(i)]) : 0));
    }
    before = row;
  }
  for (double* most : {&made->highest, &made->steepest, &made->bend})
    *most *= plane ? kBetweenPlane : kBetween;
  // A layer stands on its lowest point: one that is not there would be a wall, or a hole.
  if (-value.low > made->highest || value.low > lowest + (kBetweenPlane - 1) * made->highest)
    throw Error("low is " + formatLength(value.low) + ", the texture's lowest height about " +
                formatLength(lowest));
  return made;
}

std::size_t bytes(const FeltTexture& texture) {
  std::size_t numbers = texture.value.plane.size();
  const auto add = [&](const FourierSeries& series) {
    numbers += series.a.size() + series.b.size();
  };
  add(texture.value.series);
  for (const FourierProduct& product : texture.value.products) {
    add(product.along_x);
    add(product.along_y);
  }
  return sizeof texture + numbers * sizeof(double) + texture.at.bytes();
}

Eigen::Matrix2d bendAt(const FeltTexture& texture, double x, double y) noexcept {
  const double d = kStraight * period(texture.value) / harmonics(texture.value);
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();
  bend.col(0) = (texture.at.at(x + d, y).gradient - texture.at.at(x - d, y).gradient) / (2 * d);
  if (!dependsOnY(texture.value)) return bend;
  bend.col(1) = (texture.at.at(x, y + d).gradient - texture.at.at(x, y - d).gradient) / (2 * d);
  return 0.5 * (bend + bend.transpose());
}

} // namespace patina
