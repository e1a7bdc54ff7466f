#include "acquisition/filtering/fusion_readings.h"

#include <algorithm>
#include <cmath>

#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kWindow = 8e-3;         // readings that the coarse passes take together [s]
constexpr std::size_t kNoiseWindow = 64; // samples over which the probe's process noise is measured
constexpr double kLeastNoise = 0.01;     // no accelerometer has less [m/s^2]
constexpr double kRateDelay = 0.5e-3;    // deviation of the delay of a gyroscope's readings [s]

std::vector<const ProbeSample*> usable(const std::vector<ProbeSample>& samples) {
  std::vector<const ProbeSample*> kept;
  for (const ProbeSample& sample : samples) {
    const bool finite = std::isfinite(sample.t) && std::isfinite(sample.force) &&
                        std::all_of(sample.acceleration.begin(), sample.acceleration.end(),
                                    [](double a) { return std::isfinite(a); });
    if (finite && (kept.empty() || sample.t > kept.back()->t)) kept.push_back(&sample);
  }
  return kept;
}

// Returns the process noise of the acceleration in the probe's frame, from differences of
// successive samples. Texture raises it, motion in the air hardly does.
std::vector<Vec3> processNoise(const std::vector<const ProbeSample*>& samples,
                               const ProbeModel& probe) {
  Vec3 weights = Vec3::Zero();
  for (const AccelerometerAxis& axis : probe.axes) weights += axis.direction.cwiseAbs2();
  std::vector<Vec3> jerks(samples.size(), Vec3::Zero());
  for (std::size_t begin = 0; begin + 1 < samples.size(); begin += kNoiseWindow) {
    const std::size_t end = std::min(begin + kNoiseWindow, samples.size() - 1);
    Vec3 jerk = Vec3::Zero();
    for (std::size_t k = 0; k < probe.axes.size(); ++k) {
      double squares = 0, seconds = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const double change = samples[i + 1]->acceleration[k] - samples[i]->acceleration[k];
        squares += change * change - 2 * probe.accelerationVariance();
        seconds += samples[i + 1]->t - samples[i]->t;
      }
      jerk += std::max(squares / seconds, 0.) * probe.axes[k].direction.cwiseAbs2();
    }
    jerk = jerk.cwiseQuotient(weights.cwiseMax(1e-3));
    std::fill(jerks.begin() + static_cast<std::ptrdiff_t>(begin),
              jerks.begin() + static_cast<std::ptrdiff_t>(end + 1), jerk);
  }
  return jerks;
}

// Returns the rms over the axes of the angular acceleration at a reading [rad/s^2]; 0 in gaps.
double turnRateChange(const std::vector<RateSample>& rates, std::size_t i) {
  constexpr double kLongest = 0.05; // [s]
  const RateSample &before = rates[i - std::min<std::size_t>(i, 1)],
                   &after = rates[std::min(i + 1, rates.size() - 1)];
  const double seconds = after.t - before.t, change = (after.rate - before.rate).norm();
  return seconds > 0 && seconds < kLongest && std::isfinite(change)
             ? change / seconds / std::sqrt(3.)
             : 0;
}

// Returns the variance of the velocity by peaks of the acceleration that are as narrow as the
// samples are apart: an impact, which is sampled too coarsely and may leave the sensor's range.
// Textures, whose peaks resemble one another, have none.
std::vector<double> peakVariances(const std::vector<const ProbeSample*>& samples,
                                  const ProbeModel& probe) {
  constexpr std::size_t kAround = 128; // samples on each side that show the usual change
  constexpr double kPeak = 10;         // smallest ratio of a peak to the usual change
  constexpr double kUnknown = 0.1;     // part of a peak's integral that is unknown
  std::vector<double> changes(samples.size(), 0), variances(samples.size(), 0);
  for (std::size_t i = 1; i + 1 < samples.size(); ++i)
    for (std::size_t k = 0; k < probe.axes.size(); ++k)
      changes[i] = std::max(changes[i], std::abs(samples[i]->acceleration[k] -
                                                 0.5 * (samples[i - 1]->acceleration[k] +
                                                        samples[i + 1]->acceleration[k])));
  for (std::size_t begin = 0; begin < samples.size(); begin += kAround) {
    const std::size_t from = begin - std::min(begin, kAround),
                      to = std::min(begin + 2 * kAround, samples.size());
    std::vector<double> around(changes.begin() + static_cast<std::ptrdiff_t>(from),
                               changes.begin() + static_cast<std::ptrdiff_t>(to));
    const double usual = percentiles(std::move(around)).p50;
    for (std::size_t i = std::max<std::size_t>(begin, 1);
         i < std::min(begin + kAround, samples.size() - 1); ++i)
      if (changes[i] > kPeak * usual) {
        const double dt =
            std::min(samples[i]->t - samples[i - 1]->t, samples[i + 1]->t - samples[i]->t);
        variances[i] = std::pow(kUnknown * dt * changes[i], 2);
      }
  }
  return variances;
}

} // namespace

std::vector<InertialReading> inertialReadings(const std::vector<ProbeSample>& all,
                                              const std::vector<RateSample>& rates,
                                              const ProbeModel& probe) {
  const std::vector<const ProbeSample*> samples = usable(all);
  const std::vector<Vec3> jerks = processNoise(samples, probe);
  const std::vector<double> peaks = peakVariances(samples, probe);
  std::vector<InertialReading> readings;
  readings.reserve(std::max(samples.size(), rates.size()));
  std::size_t next = 0;
  const auto addRate = [&](const RateSample& rate) {
    if (!std::isfinite(rate.t) || !rate.rate.allFinite()) return;
    if (readings.empty() || readings.back().t != rate.t) {
      if (!readings.empty() && rate.t < readings.back().t) return;
      readings.emplace_back();
      readings.back().t = rate.t;
      readings.back().jerk =
          jerks.empty() ? Vec3(0, 0, 0) : jerks[std::min(readings.size() - 1, jerks.size() - 1)];
    }
    InertialReading& reading = readings.back();
    reading.rate = rate.rate;
    reading.rate_variance =
        probe.rate_noise * probe.rate_noise +
        std::pow(kRateDelay * turnRateChange(rates, static_cast<std::size_t>(&rate - rates.data())),
                 2);
    reading.has_rate = true;
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ProbeSample& sample = *samples[i];
    while (next < rates.size() && rates[next].t < sample.t) addRate(rates[next++]);
    InertialReading reading;
    reading.t = sample.t;
    reading.acceleration = sample.acceleration;
    reading.acceleration_variance =
        std::max(probe.accelerationVariance(), kLeastNoise * kLeastNoise);
    reading.jerk = jerks[i];
    reading.velocity_variance = peaks[i];
    reading.force = sample.force;
    reading.has_acceleration = reading.is_sample = true;
    readings.push_back(reading);
    while (next < rates.size() && !(rates[next].t > sample.t)) addRate(rates[next++]);
  }
  while (next < rates.size()) addRate(rates[next++]);
  return readings;
}

std::vector<InertialReading> meansOverWindows(const std::vector<InertialReading>& readings) {
  std::vector<InertialReading> windows;
  for (std::size_t begin = 0; begin < readings.size();) {
    std::size_t end = begin;
    InertialReading mean;
    double count = 0, accelerations = 0, rates = 0;
    for (; end < readings.size() && readings[end].t - readings[begin].t < kWindow; ++end) {
      const InertialReading& reading = readings[end];
      mean.t += reading.t - readings[begin].t;
      mean.jerk += reading.jerk;
      mean.velocity_variance += reading.velocity_variance;
      count += 1;
      if (reading.has_acceleration) {
        for (std::size_t i = 0; i < 4; ++i) mean.acceleration[i] += reading.acceleration[i];
        mean.acceleration_variance += reading.acceleration_variance;
        accelerations += 1;
      }
      if (reading.has_rate) {
        mean.rate += reading.rate;
        mean.rate_variance += reading.rate_variance;
        rates += 1;
      }
    }
    mean.t = readings[begin].t + mean.t / count;
    mean.jerk /= count;
    mean.has_acceleration = accelerations > 0;
    mean.has_rate = rates > 0;
    if (accelerations > 0) {
      for (double& value : mean.acceleration) value /= accelerations;
      mean.acceleration_variance /= accelerations * accelerations;
      // The mean of a random walk differs from its value at the middle.
      mean.acceleration_variance +=
          mean.jerk.mean() * (readings[end - 1].t - readings[begin].t) / 12;
    }
    if (rates > 0) {
      mean.rate /= rates;
      mean.rate_variance /= rates * rates;
    }
    windows.push_back(mean);
    begin = end;
  }
  return windows;
}

ReferenceMotion firstReference(const CameraTrack& track,
                               const std::vector<InertialReading>& windows) {
  std::vector<double> times;
  std::vector<TipMotion> nodes;
  for (const InertialReading& window : windows) {
    if (!window.has_rate) continue;
    times.push_back(window.t);
    nodes.push_back(motionAt(track, window.t));
  }
  std::vector<Vec3> rates;
  for (const InertialReading& window : windows)
    if (window.has_rate) rates.push_back(window.rate);
  constexpr double kDrift = 0.02; // deviation of the turned orientation [rad]
  for (std::size_t begin = 1; begin < nodes.size(); ++begin) {
    if (!nodes[begin].gap) continue;
    std::size_t end = begin; // first node after the gap
    while (end < nodes.size() && nodes[end].gap) ++end;
    std::vector<Eigen::Quaterniond> turned{nodes[begin - 1].orientation};
    for (std::size_t k = begin; k <= end && k < nodes.size(); ++k) {
      const Vec3 turn = 0.5 * (times[k] - times[k - 1]) * (rates[k - 1] + rates[k]);
      turned.push_back(turned.back() * rotationOf(turn));
    }
    const Vec3 missed = end < nodes.size()
                            ? rotationVector(turned.back().conjugate() * nodes[end].orientation)
                            : Vec3(0, 0, 0);
    for (std::size_t k = begin; k < end; ++k) {
      const double share =
          end < nodes.size() ? (times[k] - times[begin - 1]) / (times[end] - times[begin - 1]) : 0;
      nodes[k].orientation = turned[k - begin + 1] * rotationOf(share * missed);
      nodes[k].rate = rates[k];
      nodes[k].rate_of_rate.setZero();
      nodes[k].sigma_angle = std::min(nodes[k].sigma_angle, kDrift);
    }
    begin = end;
  }
  return ReferenceMotion(track, std::move(times), std::move(nodes));
}

} // namespace patina
