#include "scene/fourier/texture_evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/types.h"
#include "scene/fourier/piecewise_series.h"
#include "scene/fourier/reduced_phase.h"
#include "scene/fourier/series_sum.h"

namespace patina {

// Value and slopes by the phases.
struct PlaneValue {
  double value = 0, slope_x = 0, slope_y = 0;
};

struct TextureEvaluator::Form {
  virtual ~Form() = default;
  virtual PlaneValue at(double x, double y) const noexcept = 0; // x, y [m]
  virtual std::size_t bytes() const = 0;
};

namespace {

// Errors of height and gradient over their rms, of which a table takes half and rounding the rest.
constexpr double kTolerance = 1e-12, kOfTable = 0.5 * kTolerance;

// A plane of harmonics by the non-uniform FFT, type 2 (Potts, Steidl & Tasche 2001), with a
// Kaiser-Bessel window: coefficients are divided by the window's spectrum and summed on an
// oversampled grid once; a value is the weighted sum of the few samples around its point.
class PlaneNufft final : public TextureEvaluator::Form {
 public:
  // `plane` as in FourierTexture; its mean is ignored. Uses a window of 14 samples if it keeps
  // aliases below kOfTable of the sum of all terms, else of 16.
  PlaneNufft(const std::vector<double>& plane, int harmonics, double omega);

  PlaneValue at(double x, double y) const noexcept override;
  std::size_t bytes() const override { return sizeof(double) * (grid_.size() + weights_.size()); }

 private:
  template <int kWidth> PlaneValue through(double x, double y) const noexcept;

  int width_ = 0;
  PeriodicCells ring_; // period in samples
  std::size_t stride_ = 0;
  std::vector<double> grid_;    // rows along x, periodically extended by a window's width
  std::vector<double> weights_; // polynomial of each sample's weight in -1 .. 1 over a step
};

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr int kSamplesPerHarmonic = 4;
constexpr int kMinSamples = 16;

// Number of coefficients of a weight's polynomial for this window width.
constexpr int coefficientsOf(int width) {
  return width + 4;
}

struct Window {
  int width;
  double beta = 0.98 * std::numbers::pi * width * (1 - 0.5 / (kSamplesPerHarmonic / 2.0));

  long double at(long double z) const { // z: samples from the centre
    const long double inside = 1 - 4 * z * z / (width * width);
    return std::cyl_bessel_i(0.0L, beta * std::sqrt(std::max(0.0L, inside)));
  }
  // Returns the window's spectrum at a frequency [rad/sample].
  double spectrum(double frequency) const {
    const double reach = frequency * width / 2, square = beta * beta - reach * reach;
    const double root = std::sqrt(std::abs(square));
    if (root < 1e-8) return width;
    return width * (square > 0 ? std::sinh(root) : std::sin(root)) / root;
  }
};

// Returns the largest relative slope error by aliases, one period of the grid away.
double aliasError(const Window& window, int harmonics, int samples) {
  double most = 0;
  for (int j = 1; j <= harmonics; ++j) {
    const double step = 2 * std::numbers::pi / samples, own = window.spectrum(j * step);
    for (const int beside : {samples - j, samples + j})
      // Uses the envelope of the spectrum, not its zeros.
      most = std::max(
          most, window.width /
                    (own * std::sqrt(std::max(1.0, std::pow(beside * step * window.width / 2, 2) -
                                                       window.beta * window.beta))) *
                    beside / harmonics);
  }
  return most;
}

// Polynomials in t = -1 .. 1 through Chebyshev's points: rows are powers, columns samples. In long
// double, because slopes amplify rounding a hundredfold.
Rows weightsOf(const Window& window) {
  const int count = coefficientsOf(window.width);
  Rows weights(count, window.width);
  for (int k = 0; k < window.width; ++k) {
    Long chebyshev = Long::Zero(count);
    for (int i = 0; i < count; ++i) {
      const long double angle = std::numbers::pi_v<long double> * (i + 0.5L) / count;
      const long double z = (std::cos(angle) + 1) / 2 + window.width / 2 - 1 - k;
      for (int d = 0; d < count; ++d)
        chebyshev[d] += (d == 0 ? 1.0L : 2.0L) / count * window.at(z) * std::cos(d * angle);
    }
    Long before = Long::Zero(count), now = before, sum = before;
    now[0] = 1; // T0; T1 = t T0
    for (int d = 0; d < count; ++d) {
      sum += chebyshev[d] * now;
      Long next = -before;
      next.tail(count - 1) += (d == 0 ? 1.0L : 2.0L) * now.head(count - 1);
      before = now;
      now = next;
    }
    weights.col(k) = sum.cast<double>();
  }
  return weights;
}

template <int kWidth> struct Weights {
  alignas(32) std::array<double, kWidth> value, slope;

  Weights(const double* coefficients, double t) noexcept {
    constexpr int kCount = coefficientsOf(kWidth);
    const double* c = coefficients + (kCount - 1) * kWidth;
    for (int k = 0; k < kWidth; ++k) {
      value[static_cast<std::size_t>(k)] = c[k];
      slope[static_cast<std::size_t>(k)] = 0;
    }
    for (int d = kCount - 2; d >= 0; --d) {
      c -= kWidth;
      for (std::size_t k = 0; k < kWidth; ++k) {
        slope[k] = slope[k] * t + value[k];
        value[k] = value[k] * t + c[k];
      }
    }
  }
};

PlaneNufft::PlaneNufft(const std::vector<double>& plane, int harmonics, double omega)
    : ring_(omega, std::max(kMinSamples, kSamplesPerHarmonic * harmonics)) {
  const int samples = ring_.steps();
  width_ = aliasError({14}, harmonics, samples) <= kOfTable ? 14 : 16;
  const Window window{width_};
  const Rows weights = weightsOf(window);
  weights_.assign(weights.data(), weights.data() + weights.size());

  const int side = 2 * harmonics + 1;
  Rows terms(samples, side), slopes(1, side);
  for (int i = 0; i < samples; ++i)
    fillTerms(2 * std::numbers::pi * i / samples, harmonics, terms.row(i).data(), slopes.data());
  Eigen::VectorXd divided(side);
  for (int r = 0; r < side; ++r)
    divided[r] = 1 / window.spectrum((r + 1) / 2 * 2 * std::numbers::pi / samples);
  terms *= divided.asDiagonal();
  Rows coefficients = Eigen::Map<const Rows>(plane.data(), side, side);
  coefficients(0, 0) = 0;
  const Rows grid = terms * coefficients * terms.transpose();

  const int around = samples + width_;
  stride_ = static_cast<std::size_t>(around);
  grid_.resize(stride_ * stride_);
  const int before = width_ / 2 - 1;
  for (int r = 0; r < around; ++r)
    for (int c = 0; c < around; ++c)
      grid_[static_cast<std::size_t>(r) * stride_ + static_cast<std::size_t>(c)] =
          grid((r - before + samples) % samples, (c - before + samples) % samples);
}

template <int kWidth> PlaneValue PlaneNufft::through(double x, double y) const noexcept {
  const CellPosition column = ring_.at(x), row = ring_.at(y);
  const Weights<kWidth> along_x(weights_.data(), 2 * column.fraction - 1),
      along_y(weights_.data(), 2 * row.fraction - 1);
  alignas(32) std::array<double, kWidth> value{}, slope{};
  const double* samples = grid_.data() + static_cast<std::size_t>(row.step) * stride_ +
                          static_cast<std::size_t>(column.step);
  for (std::size_t r = 0; r < kWidth; ++r, samples += stride_)
    for (std::size_t k = 0; k < kWidth; ++k) {
      value[k] += along_y.value[r] * samples[k];
      slope[k] += along_y.slope[r] * samples[k];
    }
  PlaneValue sum;
  for (std::size_t k = 0; k < kWidth; ++k) {
    sum.value += along_x.value[k] * value[k];
    sum.slope_x += along_x.slope[k] * value[k];
    sum.slope_y += along_x.value[k] * slope[k];
  }
  const double by_phase = ring_.steps() / std::numbers::pi;
  sum.slope_x *= by_phase;
  sum.slope_y *= by_phase;
  return sum;
}

PlaneValue PlaneNufft::at(double x, double y) const noexcept {
  return width_ == 14 ? through<14>(x, y) : through<16>(x, y);
}

// A texture without waves.
struct FlatForm final : TextureEvaluator::Form {
  PlaneValue at(double, double) const noexcept override { return {}; }
  std::size_t bytes() const override { return 0; }
};

struct LineForm final : TextureEvaluator::Form {
  PiecewiseSeries line;

  explicit LineForm(PiecewiseSeries of) : line(std::move(of)) {}
  PlaneValue at(double x, double) const noexcept override {
    const SeriesValue sum = line.at(x);
    return {sum.value, sum.slope, 0};
  }
  std::size_t bytes() const override { return line.bytes(); }
};

struct ProductsForm final : TextureEvaluator::Form {
  struct Factors {
    PiecewiseSeries along_x, along_y;
  };
  std::vector<Factors> factors;
  double mean = 0;

  PlaneValue at(double x, double y) const noexcept override {
    PlaneValue sum{-mean, 0, 0};
    for (const Factors& f : factors) {
      const SeriesValue q = f.along_x.at(x), p = f.along_y.at(y);
      sum.value += p.value * q.value;
      sum.slope_x += p.value * q.slope;
      sum.slope_y += p.slope * q.value;
    }
    return sum;
  }
  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const Factors& f : factors) sum += f.along_x.bytes() + f.along_y.bytes();
    return sum;
  }
};

// Allowed errors of a table.
struct Errors {
  double height = 0, slope = 0; // slope by the phase
};

double amplitudes(const FourierSeries& series, bool of_slope) {
  double sum = of_slope ? 0 : std::abs(series.mean);
  for (std::size_t i = 0; i < series.a.size(); ++i)
    sum += std::hypot(series.a[i], series.b[i]) * (of_slope ? static_cast<double>(i + 1) : 1);
  return sum;
}

std::shared_ptr<const TextureEvaluator::Form> tableForm(const FourierTexture& texture,
                                                        const Errors& errors) {
  if (texture.kind == TextureKind::products) {
    const double share = 1 / static_cast<double>(2 * texture.products.size());
    const auto factor = [&](const FourierSeries& own, const FourierSeries& other) {
      // An error of this factor is multiplied by the other one and by its slope; if those are 0,
      // any error is allowed.
      const auto over = [&](double error, double by) {
        return by > 0 ? share * error / by : std::numeric_limits<double>::infinity();
      };
      const double most = amplitudes(other, false), steepest = amplitudes(other, true);
      return PiecewiseSeries(own, std::min(over(errors.height, most), over(errors.slope, steepest)),
                             over(errors.slope, most), texture.omega);
    };
    auto form = std::make_shared<ProductsForm>();
    for (const FourierProduct& product : texture.products) {
      form->mean += product.along_x.mean * product.along_y.mean;
      form->factors.push_back(
          {factor(product.along_x, product.along_y), factor(product.along_y, product.along_x)});
    }
    return form;
  }
  FourierSeries series = seriesOf(texture);
  series.mean = 0;
  return std::make_shared<LineForm>(
      PiecewiseSeries(series, errors.height, errors.slope, texture.omega));
}

} // namespace

TextureEvaluator::TextureEvaluator(const FourierTexture& texture) : omega_(texture.omega) {
  if (const std::string problem = problemOf(texture); !problem.empty())
    throw Error("texture '" + texture.name + "': " + problem);
  const Errors errors{kOfTable * rmsHeight(texture), kOfTable * rmsSlope(texture) / omega_};
  if (!(errors.height > 0 && errors.slope > 0))
    form_ = std::make_shared<FlatForm>();
  else if (texture.kind == TextureKind::plane)
    form_ = std::make_shared<PlaneNufft>(texture.plane, harmonics(texture), texture.omega);
  else
    form_ = tableForm(texture, errors);
  if (const auto* tabled = dynamic_cast<const LineForm*>(form_.get())) line_ = &tabled->line;
}

TextureValue TextureEvaluator::ofForm(double x, double y) const noexcept {
  const PlaneValue value = form_->at(x, y);
  return {value.value, omega_ * Vec2(value.slope_x, value.slope_y)};
}

std::size_t TextureEvaluator::bytes() const {
  return form_->bytes();
}

} // namespace patina
