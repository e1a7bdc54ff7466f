// What a tick of the servo asks of a Fourier texture: height and gradient, from a table that is
// made once.
#pragma once

#include <memory>

#include "scene/fourier/fourier_texture.h"
#include "scene/fourier/series_cells.h"

namespace patina {

struct TextureValue {
  double height = 0;            // above the mean [m]
  Vec2 gradient = Vec2::Zero(); // by x and y
};

// Copies share their tables, which never change: as many threads as please may ask.
class TextureEvaluator {
 public:
  // Within `tolerance` of the sum of all terms: of the height relative to its rms, of the gradient
  // relative to its own; planes that are asked for more than 2e-6, but at rare places. Rounding
  // leaves 2e-13 whatever is asked for. 0 adds up all terms. Tables of 128 harmonics answer in 9
  // ns for a line, for a plane in 0.3 us at 1e-12, in 20 ns at 1e-5 (from up to 64 MB). Throws
  // Error naming what is wrong with the texture, or with a tolerance outside of [0, 1).
  explicit TextureEvaluator(const FourierTexture& texture, double tolerance = 1e-12);

  // x, y [m], of any size: beyond 1e9 periods or more, or where they are no numbers, the value at
  // 0. Neither locks nor allocates.
  TextureValue at(double x, double y = 0) const noexcept {
    if (!line_) return ofForm(x, y);
    const SeriesValue value = line_->at(x);
    return {value.value, Vec2(omega_ * value.slope, 0)};
  }

  // Where that is all there is to it, its line: a view, slopes by x [m]. Else one without cells.
  SeriesTable line() const noexcept {
    if (!line_) return {};
    SeriesTable table = line_->table();
    table.slope_scale *= omega_;
    return table;
  }
  double omega() const { return omega_; } // [rad/m]
  double low() const { return low_; }     // at(...).height - low() >= 0, but for the tolerance [m]
  std::size_t bytes() const;              // of its tables

  struct Form; // how it is summed
 private:
  TextureValue ofForm(double x, double y) const noexcept;

  double omega_ = 0, low_ = 0;
  std::shared_ptr<const Form> form_;
  const SeriesCells* line_ = nullptr; // of form_, where that is all there is to it
};

} // namespace patina
