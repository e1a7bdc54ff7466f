#include "acquisition/simulation/simulated_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

double drawn(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.;
}

void takeLineOff(std::vector<double>& heights) {
  const double n = static_cast<double>(heights.size()), middle = (n - 1) / 2;
  double mean = 0, mixed = 0, squares = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    mean += heights[i] / n;
    mixed += x * heights[i];
    squares += x * x;
  }
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] -= mean + mixed / squares * (static_cast<double>(i) - middle);
}

} // namespace

std::function<double(const Vec2&)> roughSurface(std::uint32_t seed, double rms) {
  struct Wave {
    Vec2 number;
    double amplitude, phase;
  };
  std::mt19937 random(seed);
  std::vector<Wave> waves;
  double squares = 0;
  for (int i = 0; i < 30; ++i) {
    const double length = 0.8e-3 * std::pow(8, drawn(random, 0, 1));
    const double angle = drawn(random, 0, 2 * kPi);
    waves.push_back({2 * kPi / length * Vec2(std::cos(angle), std::sin(angle)), length,
                     drawn(random, 0, 2 * kPi)});
    squares += length * length / 2;
  }
  const double scale = rms / std::sqrt(squares);
  return [waves, scale](const Vec2& place) {
    double height = 0;
    for (const Wave& wave : waves)
      height += scale * wave.amplitude * std::sin(wave.number.dot(place) + wave.phase);
    return height;
  };
}

std::vector<double> milledProfile(std::uint32_t seed, double length, double step) {
  std::mt19937 random(seed);
  constexpr double kCutter = 0.8e-3; // radius of the arcs [m]
  std::vector<double> heights(static_cast<std::size_t>(length / step), 1.);
  for (double middle = 0; middle < length + 1e-3; middle += drawn(random, 0.35e-3, 0.65e-3)) {
    const double depth = drawn(random, -15e-6, 15e-6);
    const auto from = static_cast<std::size_t>(std::max(0., (middle - 1e-3) / step));
    const auto to = std::min(heights.size(), static_cast<std::size_t>((middle + 1e-3) / step));
    for (std::size_t i = from; i < to; ++i) {
      const double x = static_cast<double>(i) * step - middle;
      heights[i] = std::min(heights[i], depth + x * x / (2 * kCutter));
    }
  }
  struct Wave {
    double number, height, phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 6; ++i)
    waves.push_back({2 * kPi / drawn(random, 2e-3, 8e-3), drawn(random, 1e-6, 5e-6),
                     drawn(random, 0, 2 * kPi)});
  for (std::size_t i = 0; i < heights.size(); ++i)
    for (const Wave& wave : waves)
      heights[i] +=
          wave.height * std::sin(wave.number * static_cast<double>(i) * step + wave.phase);
  return heights;
}

std::vector<double> envelope(const std::vector<double>& heights, double step, double radius) {
  const auto reach = static_cast<std::ptrdiff_t>(radius / step);
  const auto count = static_cast<std::ptrdiff_t>(heights.size());
  std::vector<double> cap(static_cast<std::size_t>(reach + 1));
  for (std::ptrdiff_t k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) * step;
    cap[static_cast<std::size_t>(k)] = std::sqrt(radius * radius - x * x) - radius;
  }
  std::vector<double> above(heights);
  for (std::ptrdiff_t i = 0; i < count; ++i)
    for (std::ptrdiff_t k = -std::min(reach, i); k <= std::min(reach, count - 1 - i); ++k)
      above[static_cast<std::size_t>(i)] = std::max(above[static_cast<std::size_t>(i)],
                                                    heights[static_cast<std::size_t>(i + k)] +
                                                        cap[static_cast<std::size_t>(std::abs(k))]);
  return above;
}

TraceReading readTrace(const std::vector<double>& heights, double step, double speed, double rate,
                       double acceleration_step, double acceleration_noise, double offset,
                       std::uint32_t seed) {
  // A cosine series needs no period; terms above half the sampling rate are left out.
  std::vector<double> level(heights);
  takeLineOff(level);
  const std::size_t n = level.size();
  const auto count = static_cast<std::size_t>(static_cast<double>(n) * step / speed * rate);
  std::vector<double> cosines(4 * n); // cos(k (i + 1/2) pi / n) from a table of its 4 n values
  for (std::size_t i = 0; i < 4 * n; ++i)
    cosines[i] = std::cos(kPi * static_cast<double>(i) / (2. * static_cast<double>(n)));
  std::vector<double> terms(count, 0);
  for (std::size_t k = 1; k < count; ++k) {
    std::size_t at = k % (4 * n);
    for (std::size_t i = 0; i < n; ++i, at = (at + 2 * k) % (4 * n))
      terms[k] += level[i] * cosines[at];
    terms[k] *= 2 / static_cast<double>(n);
  }
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  TraceReading reading;
  for (std::size_t i = 0; i < count; ++i) {
    double height = 0, acceleration = 0;
    for (std::size_t k = 1; k < count; ++k) {
      const double pulse = kPi * static_cast<double>(k) * rate / static_cast<double>(count);
      const double term =
          terms[k] * std::cos(kPi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) /
                              static_cast<double>(count));
      // Analog anti-aliasing filter, fourth order, at 0.4 of the rate.
      const double passed = 1 / std::sqrt(1 + std::pow(pulse / (2 * kPi * 0.4 * rate), 8));
      height += term;
      acceleration -= pulse * pulse * passed * term;
    }
    acceleration += acceleration_noise * normal(random) + offset;
    TracedSample sample;
    sample.t = static_cast<double>(i) / rate;
    sample.arc_length = sample.t * speed;
    sample.speed = speed;
    sample.acceleration =
        acceleration_step > 0
            ? acceleration_step * std::round(acceleration / acceleration_step) - offset
            : acceleration - offset;
    reading.samples.push_back(sample);
    reading.heights.push_back(height);
  }
  return reading;
}

} // namespace patina
