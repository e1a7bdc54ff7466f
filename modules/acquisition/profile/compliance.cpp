#include "acquisition/profile/compliance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patina {
namespace {

constexpr std::size_t kSmooth = 7; // samples on each side
constexpr double kPause = 0.05;    // longer pauses between samples start another press [s]

struct Loading {
  std::size_t begin, end;
};

std::vector<double> smoothedForces(const std::vector<PressSample>& samples) {
  std::vector<double> sums{0};
  for (const PressSample& sample : samples) sums.push_back(sums.back() + sample.force);
  std::vector<double> smooth(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t reach = std::min({kSmooth, i, samples.size() - 1 - i});
    smooth[i] = (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return smooth;
}

double forceRange(const std::vector<PressSample>& samples, const Loading& loading) {
  const auto [lowest, highest] =
      std::minmax_element(samples.begin() + static_cast<std::ptrdiff_t>(loading.begin),
                          samples.begin() + static_cast<std::ptrdiff_t>(loading.end),
                          [](const auto& a, const auto& b) { return a.force < b.force; });
  return highest->force - lowest->force;
}

// Returns rises of the force from a minimum to the next maximum. They are chosen by the force
// alone, because a choice by displacement would favour its noise. A rise that only the smoothing
// shows, such as that of a single sample, has no slope and is left out.
std::vector<Loading> loadingsOf(const std::vector<PressSample>& samples, double min_force_rise) {
  std::vector<Loading> loadings;
  if (samples.empty()) return loadings;
  const std::vector<double> force = smoothedForces(samples);
  const double back = 0.1 * min_force_rise; // smaller drops are noise
  std::size_t low = 0, high = 0;
  const auto close = [&] {
    if (force[high] - force[low] < min_force_rise) return;
    // Leaves out the first and last 2 % of the rise.
    const double rise = force[high] - force[low];
    std::size_t begin = low, end = high;
    while (begin < end && force[begin] < force[low] + 0.02 * rise) ++begin;
    while (end > begin && force[end] > force[high] - 0.02 * rise) --end;
    const Loading loading{begin, end + 1};
    if (forceRange(samples, loading) > 0) loadings.push_back(loading);
  };
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].t - samples[i - 1].t > kPause) {
      close();
      low = high = i;
      continue;
    }
    if (force[i] >= force[high]) high = i;
    const bool falls = force[i] < force[high] - back;
    if (falls && high > low) {
      close();
      low = high = i;
    } else if (force[i] < force[low]) {
      low = high = i;
    }
  }
  close();
  return loadings;
}

// Returns half the quantile of Student's t within +- which lies the probability of two normal
// deviations; few values need a wider interval. One and two degrees of freedom have a closed form.
// More are expanded about infinitely many (Cornish & Fisher 1938), to 0.2 %.
double studentQuantile(double freedom) {
  const double share = std::erf(std::numbers::sqrt2);
  if (freedom == 1) return std::tan(std::numbers::pi / 2 * share) / 2;
  if (freedom == 2) return share * std::sqrt(2 / (1 - share * share)) / 2;
  const double v = 1 / freedom;
  return 1 + v * (1.25 + v * (1.53125 + v * (1.4297 + v * 0.922)));
}

// The variance that a path states is worth as many presses as this.
constexpr double kStatedFreedom = 4;

struct Moments {
  double forces = 0, mixed = 0, displacements = 0, freedom = 0;
};

} // namespace

std::optional<ComplianceEstimate> estimateCompliance(const std::vector<PressSample>& samples,
                                                     double force_sigma,
                                                     bool correlated_within_press,
                                                     double min_force_rise) {
  const std::vector<Loading> loadings = loadingsOf(samples, min_force_rise);
  if (loadings.empty()) return std::nullopt;
  ComplianceEstimate estimate;
  Moments m;
  std::vector<double> f, x; // deviations from the mean of their loading
  std::vector<bool> first;
  double stated = 0; // variance of the sum of the influences by the samples' own `sigma`
  for (const Loading& loading : loadings) {
    const double n = static_cast<double>(loading.end - loading.begin);
    double mean_f = 0, mean_x = 0;
    for (std::size_t i = loading.begin; i < loading.end; ++i) {
      mean_f += samples[i].force / n;
      mean_x += samples[i].displacement / n;
    }
    for (std::size_t i = loading.begin; i < loading.end; ++i) {
      f.push_back(samples[i].force - mean_f);
      x.push_back(samples[i].displacement - mean_x);
      first.push_back(i == loading.begin);
      m.forces += f.back() * f.back();
      m.mixed += f.back() * x.back();
      m.displacements += x.back() * x.back();
    }
    m.freedom += n - 1;
    double squares_of_sigma = 0, forces = 0;
    for (std::size_t i = loading.begin; i < loading.end; ++i) {
      const double force = samples[i].force - mean_f;
      squares_of_sigma += samples[i].sigma * samples[i].sigma / n;
      forces += force * force;
    }
    stated += 2 * squares_of_sigma * std::pow(forces / forceRange(samples, loading), 2);
  }
  const double force_variance = force_sigma * force_sigma;
  const double true_forces = m.forces - m.freedom * force_variance;
  if (!(true_forces > 0) || !(m.mixed > 0) || m.freedom < 3) return std::nullopt;
  const double C = m.mixed / true_forces;
  double squares = 0, lagged = 0, pairs = 0;
  std::vector<double> influences; // influence of each loading on the slope
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double residual = x[i] - C * f[i];
    squares += residual * residual;
    if (first[i]) influences.push_back(0);
    influences.back() += f[i] * residual;
    if (first[i]) continue;
    lagged += residual * (x[i - 1] - C * f[i - 1]);
    pairs += 1;
  }
  const double residual_variance = squares / (m.freedom - 1);
  // Autocorrelated residuals count for fewer, as for a first-order autoregressive noise.
  const double n = static_cast<double>(f.size());
  const double autocorrelation = std::clamp(lagged / pairs / (squares / n) + 1 / n, -0.95, 0.995);
  const double samples_per_independent =
      std::max((1 + autocorrelation) / (1 - autocorrelation), 1e-3);
  estimate.compliance = C;
  // The second term is the noise of the forces, also in the sum that was corrected for it.
  estimate.standard_deviation =
      std::sqrt(samples_per_independent * residual_variance / true_forces +
                m.freedom * force_variance * (residual_variance + C * C * force_variance) /
                    (true_forces * true_forces));
  // The scatter of few presses is averaged with what the path states of them.
  const double presses = static_cast<double>(influences.size());
  double variance = 0, freedom = 0;
  if (correlated_within_press && presses > 1) {
    for (const double pull : influences) variance += pull * pull * presses;
    freedom = presses - 1;
  }
  if (correlated_within_press && stated > 0) {
    variance += kStatedFreedom * stated;
    freedom += kStatedFreedom;
  }
  estimate.compliance_deviation = estimate.standard_deviation;
  if (freedom > 0) {
    const double scatter = std::sqrt(variance / freedom) / true_forces;
    estimate.compliance_deviation =
        std::max(estimate.standard_deviation, studentQuantile(freedom) * scatter);
    estimate.standard_deviation = std::max(estimate.standard_deviation, scatter);
  }
  // The mean of 1 / C is too large by the square of C's relative standard deviation.
  const double relative = estimate.standard_deviation / C;
  estimate.stiffness = 1 / (C * (1 + relative * relative));
  estimate.stiffness_deviation = estimate.stiffness * estimate.compliance_deviation / C;
  estimate.displacement_noise = std::sqrt(std::max(residual_variance - C * C * force_variance, 0.));
  estimate.samples = f.size();
  estimate.loadings = loadings.size();
  return estimate;
}

} // namespace patina
