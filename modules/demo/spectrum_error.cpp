#include "demo/spectrum_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace patina {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;
constexpr int kSamplesAWave = 8;    // of the shortest
constexpr double kStretched = 0.01; // what is longer or shorter than that is another wave

// Heights over one period through a window that is zero and level at both ends.
class Seen {
 public:
  Seen(const std::function<double(double)>& height, double period, int count) : period_(period) {
    double weights = 0, mean = 0;
    std::vector<double> weight, heights;
    for (int i = 0; i < count; ++i) {
      const double part = (i + 0.5) / count;
      weight.push_back(1 - std::cos(kWholeTurn * part));
      heights.push_back(height(part * period));
      weights += weight.back();
      mean += weight.back() * heights.back();
    }
    for (std::size_t i = 0; i < heights.size(); ++i)
      windowed_.push_back(2 / weights * weight[i] * (heights[i] - mean / weights));
  }

  // Of a wave that fits the period so many times, whole or not.
  double amplitude(double harmonic) const {
    double cosine = 0, sine = 0;
    const double step = kWholeTurn * harmonic / static_cast<double>(windowed_.size());
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

// From the strongest of `first` to `last` to where between it and its neighbours it is highest.
Peak strongest(const Seen& seen, int first, int last) {
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
  const int last = harmonics(texture), count = kSamplesAWave * last,
            first = static_cast<int>(std::ceil(length / longest));
  const auto trueHeight = [&](double along) {
    const auto next =
        std::lower_bound(truth.begin() + 1, truth.end() - 1, along + truth.front().along,
                         [](const ProfilePoint& point, double way) { return point.along < way; });
    const ProfilePoint &a = *(next - 1), &b = *next;
    const double way = b.along - a.along,
                 share = way > 0 ? (along + truth.front().along - a.along) / way : 1;
    return a.height + std::clamp(share, 0., 1.) * (b.height - a.height);
  };
  const Seen real(trueHeight, length, count),
      found([&](double along) { return height(texture, along); }, length, count);
  const Peak true_peak = strongest(real, first, last), peak = strongest(found, first, last);
  SpectrumError error;
  error.wavelength = found.wavelength(peak.harmonic);
  error.true_wavelength = real.wavelength(true_peak.harmonic);
  error.amplitude = peak.amplitude;
  error.true_amplitude = true_peak.amplitude;
  const auto most = static_cast<int>(std::lround(true_peak.harmonic));
  const double stretch =
      std::clamp(peak.harmonic / true_peak.harmonic, 1 - kStretched, 1 + kStretched);
  for (int j = first; j <= last; ++j) {
    const double expected = real.amplitude(j), wavelength = real.wavelength(j);
    if (!(expected > floor * wavelength * wavelength) && j != most) continue;
    ++error.compared;
    const auto judge = [&](double& worst, double harmonic) {
      const double off = std::abs(20 * std::log10(found.amplitude(harmonic) / expected));
      if (!(off <= worst)) worst = std::isfinite(off) ? off : INFINITY;
    };
    judge(error.decibels, stretch * j);
    judge(error.stretched, j);
  }
  return error;
}

} // namespace patina
