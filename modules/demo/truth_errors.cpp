#include "demo/truth_errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/error.h"

namespace patina {
namespace {

constexpr int kGridPoints = 8;   // grid points to each side before the best one is refined
constexpr double kFinest = 1e-9; // [m]

} // namespace

Vec3 referenceForce(const HeightOver& surface, const Vec3& tip, double stiffness, double reach) {
  const Vec2 under = tip.head<2>();
  if (tip.z() >= surface(under)) return Vec3::Zero();
  const auto pointAt = [&](const Vec2& place) {
    return Vec3(place.x(), place.y(), surface(place));
  };
  Vec3 best = pointAt(under);
  double least = (best - tip).squaredNorm();
  const auto look = [&](const Vec2& place) {
    const Vec3 point = pointAt(place);
    const double square = (point - tip).squaredNorm();
    if (!(square < least)) return false;
    least = square;
    best = point;
    return true;
  };
  double step = reach / kGridPoints;
  for (int i = -kGridPoints; i <= kGridPoints; ++i)
    for (int j = -kGridPoints; j <= kGridPoints; ++j) look(under + step * Vec2(i, j));
  while (step > kFinest) {
    const Vec2 here = best.head<2>();
    bool nearer = false;
    for (const Vec2& way : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
      nearer |= look(here + step * way);
    if (!nearer) step /= 2;
  }
  return stiffness * (best - tip);
}

namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr int kSamplesPerWave = 8;      // min samples per wave
constexpr double kMaxScaleError = 0.01; // larger scale errors belong to another wave

// Heights over one period, multiplied by a Hann window.
class WindowedHeights {
 public:
  WindowedHeights(const std::function<double(double)>& height, double period, int count)
      : period_(period) {
    double weights = 0, mean = 0;
    std::vector<double> weight, heights;
    for (int i = 0; i < count; ++i) {
      const double part = (i + 0.5) / count;
      weight.push_back(1 - std::cos(kFullTurn * part));
      heights.push_back(height(part * period));
      weights += weight.back();
      mean += weight.back() * heights.back();
    }
    for (std::size_t i = 0; i < heights.size(); ++i)
      windowed_.push_back(2 / weights * weight[i] * (heights[i] - mean / weights));
  }

  // Amplitude of a wave with `harmonic` cycles per period, not necessarily an integer.
  double amplitude(double harmonic) const {
    double cosine = 0, sine = 0;
    const double step = kFullTurn * harmonic / static_cast<double>(windowed_.size());
    for (std::size_t i = 0; i < windowed_.size(); ++i) {
      const double angle = step * (static_cast<double>(i) + 0.5);
      cosine += windowed_[i] * std::cos(angle);
      sine += windowed_[i] * std::sin(angle);
    }
    return std::hypot(cosine, sine);
  }
  double wavelength(double harmonic) const { return period_ / harmonic; }

 private:
  double period_;
  std::vector<double> windowed_;
};

struct Peak {
  double harmonic = 0, amplitude = 0;
};

// Finds the strongest harmonic from `first` to `last` and refines it between integers.
Peak strongest(const WindowedHeights& seen, int first, int last) {
  Peak peak;
  const auto look = [&](double harmonic) {
    const double amplitude = seen.amplitude(harmonic);
    if (amplitude > peak.amplitude) peak = {harmonic, amplitude};
  };
  for (int j = first; j <= last; ++j) look(j);
  for (double step = 0.5; step > 1e-4; step /= 2) {
    const double here = peak.harmonic;
    look(here - step);
    look(here + step);
  }
  return peak;
}

} // namespace

SpectrumError spectrumError(const FourierTexture& texture, const std::vector<ProfilePoint>& truth,
                            double longest, double floor) {
  if (texture.kind != TextureKind::line) throw std::invalid_argument("spectrumError: no line");
  if (truth.size() < 2) throw std::invalid_argument("spectrumError: fewer than two heights");
  const double length = period(texture);
  const int last = harmonics(texture), count = kSamplesPerWave * last,
            first = static_cast<int>(std::ceil(length / longest));
  const auto trueHeight = [&](double along) {
    const auto next = std::lower_bound(
        truth.begin() + 1, truth.end() - 1, along + truth.front().arc_length,
        [](const ProfilePoint& point, double way) { return point.arc_length < way; });
    const ProfilePoint &a = *(next - 1), &b = *next;
    const double way = b.arc_length - a.arc_length,
                 share = way > 0 ? (along + truth.front().arc_length - a.arc_length) / way : 1;
    return a.height + std::clamp(share, 0., 1.) * (b.height - a.height);
  };
  const WindowedHeights real(trueHeight, length, count),
      found([&](double along) { return height(texture, along); }, length, count);
  const Peak true_peak = strongest(real, first, last), peak = strongest(found, first, last);
  SpectrumError error;
  error.wavelength = found.wavelength(peak.harmonic);
  error.true_wavelength = real.wavelength(true_peak.harmonic);
  error.amplitude = peak.amplitude;
  error.true_amplitude = true_peak.amplitude;
  const auto most = static_cast<int>(std::lround(true_peak.harmonic));
  const double stretch =
      std::clamp(peak.harmonic / true_peak.harmonic, 1 - kMaxScaleError, 1 + kMaxScaleError);
  for (int j = first; j <= last; ++j) {
    const double expected = real.amplitude(j), wavelength = real.wavelength(j);
    if (!(expected > floor * wavelength * wavelength) && j != most) continue;
    ++error.harmonic_count;
    const auto judge = [&](double& worst, double harmonic) {
      const double off = std::abs(20 * std::log10(found.amplitude(harmonic) / expected));
      if (!(off <= worst)) worst = std::isfinite(off) ? off : INFINITY;
    };
    judge(error.decibels, stretch * j);
    judge(error.with_scale_error, j);
  }
  return error;
}

namespace {

constexpr double kLagStep = 0.02e-3; // [m]

struct Window {
  double lag = 0;
  double whole = 0, variation = 0, truth = 0, varied = 0; // sums of squares
};

class Felt {
 public:
  explicit Felt(const std::vector<ForcePoint>& points) : points_(points) {}

  Vec3 at(double along) const {
    const auto next =
        std::lower_bound(points_.begin() + 1, points_.end() - 1, along,
                         [](const ForcePoint& point, double x) { return point.along < x; });
    const ForcePoint &a = *(next - 1), &b = *next;
    const double share = std::clamp((along - a.along) / (b.along - a.along), 0., 1.);
    return (1 - share) * a.felt + share * b.felt;
  }

 private:
  const std::vector<ForcePoint>& points_;
};

Window compared(const std::vector<ForcePoint>& points, std::size_t first, std::size_t last,
                double lag) {
  const Felt felt(points);
  const double n = static_cast<double>(last - first);
  double mean_felt = 0, mean_true = 0;
  std::vector<double> outward, truth;
  Window window;
  window.lag = lag;
  for (std::size_t i = first; i < last; ++i) {
    const ForcePoint& point = points[i];
    const Vec3 here = felt.at(point.along + lag);
    window.whole += (here - point.truth).squaredNorm();
    window.truth += point.truth.squaredNorm();
    outward.push_back(here.dot(point.outward));
    truth.push_back(point.truth.dot(point.outward));
    mean_felt += outward.back() / n;
    mean_true += truth.back() / n;
  }
  for (std::size_t i = 0; i < outward.size(); ++i) {
    const double varied = truth[i] - mean_true;
    window.variation += std::pow(outward[i] - mean_felt - varied, 2);
    window.varied += varied * varied;
  }
  return window;
}

} // namespace

ForceError forceError(const std::vector<ForcePoint>& points, double window, double max_lag) {
  ForceError error;
  Window sum;
  double count = 0;
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    while (last < points.size() && points[last].along - points[first].along < window) ++last;
    if (last == points.size()) break;
    Window best;
    best.variation = std::numeric_limits<double>::infinity();
    for (double lag = -max_lag; lag <= max_lag; lag += kLagStep)
      if (const Window tried = compared(points, first, last, lag); tried.variation < best.variation)
        best = tried;
    error.spatial_lag = std::max(error.spatial_lag, std::abs(best.lag));
    sum.whole += best.whole;
    sum.truth += best.truth;
    sum.variation += best.variation;
    sum.varied += best.varied;
    count += static_cast<double>(last - first);
    ++error.windows;
  }
  if (error.windows == 0) throw Error("the path is shorter than one window");
  error.relative_error = std::sqrt(sum.whole / sum.truth);
  error.texture_error = std::sqrt(sum.variation / sum.varied);
  error.true_variation = std::sqrt(sum.varied / count);
  return error;
}

} // namespace patina
