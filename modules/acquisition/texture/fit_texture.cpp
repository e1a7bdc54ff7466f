#include "acquisition/texture/fit_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/texture/drawn_heights.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kLongestGap = 0.05; // of the length
constexpr double kRounding = 1e-13;  // of the heights: what less remains is no profile
constexpr std::size_t kBesideTilt = 16;
constexpr double kMostSamples = 1e6;
constexpr double kSamePlace = 1e-3; // of a step
constexpr double kSameBend = 0.25;  // of one step's

// Sorted by place; those that lie together are one.
std::vector<ProfilePoint> inOrder(std::vector<ProfilePoint> points) {
  for (const ProfilePoint& point : points)
    if (!std::isfinite(point.along) || !std::isfinite(point.height))
      throw Error("a height of the profile is not finite");
  std::sort(points.begin(), points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.along < b.along; });
  return points;
}

double medianStep(const std::vector<ProfilePoint>& points) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].along > points[i - 1].along)
      steps.push_back(points[i].along - points[i - 1].along);
  if (steps.empty()) throw Error("the profile has no length");
  return percentiles(steps).p50;
}

struct EvenHeights {
  std::vector<double> heights;
  std::vector<double> speeds; // empty where not all are known
};

// At from, from + step, ... `count` of them: means of what lies within half a step, or straight
// between neighbours.
EvenHeights evenHeights(const std::vector<ProfilePoint>& points, double from, double step,
                        std::size_t count) {
  std::vector<ProfilePoint> places; // one a step that has any
  std::vector<double> weights;
  const bool weighted =
      std::all_of(points.begin(), points.end(), [](const ProfilePoint& p) { return p.sigma > 0; });
  const bool drawn =
      std::all_of(points.begin(), points.end(), [](const ProfilePoint& p) { return p.speed; });
  std::ptrdiff_t last = -1;
  for (const ProfilePoint& point : points) {
    const auto place = static_cast<std::ptrdiff_t>(std::lround((point.along - from) / step));
    const double weight = weighted ? 1 / (point.sigma * point.sigma) : 1;
    if (place != last) {
      places.push_back({0, 0, 0, 0});
      weights.push_back(0);
      last = place;
    }
    places.back().along += weight * point.along;
    places.back().height += weight * point.height;
    *places.back().speed += weight * point.speed.value_or(0);
    weights.back() += weight;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].along /= weights[i];
    places[i].height /= weights[i];
    *places[i].speed /= weights[i];
  }
  EvenHeights even;
  const auto add = [&](double height, double speed) {
    even.heights.push_back(height);
    if (drawn) even.speeds.push_back(speed);
  };
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = from + step * static_cast<double>(i);
    while (next + 1 < places.size() && places[next].along < x - kSamePlace * step) ++next;
    const ProfilePoint& behind = places[next];
    if (next == 0 || std::abs(behind.along - x) <= kSamePlace * step || behind.along < x) {
      add(behind.height, *behind.speed);
      continue;
    }
    const ProfilePoint& before = places[next - 1];
    const double share = (x - before.along) / (behind.along - before.along);
    add((1 - share) * before.height + share * behind.height,
        (1 - share) * *before.speed + share * *behind.speed);
  }
  return even;
}

// Slope a step of the line that is the best one beside a mean and the lowest harmonics of one
// period, so that whole waves are not taken for a tilt. Takes it off, and the mean.
double flatten(std::vector<double>& heights) {
  const std::size_t m = heights.size() - 1; // the last one begins the next period
  const auto n = static_cast<double>(m);
  std::vector<double> ramp(m); // what of a ramp those cannot be
  for (std::size_t i = 0; i < m; ++i) ramp[i] = static_cast<double>(i) - 0.5 * (n - 1);
  const int low = static_cast<int>(std::min<std::size_t>(kBesideTilt, m / 8));
  if (low > 0) {
    const FourierSeries waves = seriesOf(ramp, low);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < waves.a.size(); ++j) {
        const double angle =
            2 * std::numbers::pi * static_cast<double>((j + 1) * i % m) / static_cast<double>(m);
        ramp[i] -= waves.a[j] * std::cos(angle) + waves.b[j] * std::sin(angle);
      }
  }
  double along = 0, square = 0, mean = 0;
  for (std::size_t i = 0; i < m; ++i) {
    along += ramp[i] * heights[i];
    square += ramp[i] * (static_cast<double>(i) - 0.5 * (n - 1));
    mean += heights[i] / n;
  }
  const double slope = along / square;
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] -= mean + slope * (static_cast<double>(i) - 0.5 * (n - 1));
  return slope;
}

double meanSquare(const std::vector<double>& values, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i] * values[i];
  return sum / static_cast<double>(count);
}

// Mean square of the first `count` values off their least-squares line.
double offLine(const std::vector<double>& values, std::size_t count) {
  const double middle = 0.5 * static_cast<double>(count - 1);
  double mean = 0, along = 0, square = 0, sum = 0;
  for (std::size_t i = 0; i < count; ++i) mean += values[i] / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) - middle;
    along += x * values[i];
    square += x * x;
    sum += (values[i] - mean) * (values[i] - mean);
  }
  return std::max(0., sum - along * along / square) / static_cast<double>(count);
}

double rmsOf(const FourierSeries& series) {
  double sum = 0;
  for (std::size_t j = 0; j < series.a.size(); ++j)
    sum += 0.5 * (series.a[j] * series.a[j] + series.b[j] * series.b[j]);
  return std::sqrt(sum);
}

// Harmonics j + 1 of which `leave(j)` holds become nothing; their rms.
template <class Leave> double leaveOut(FourierSeries& series, const Leave& leave) {
  double sum = 0;
  for (std::size_t j = 0; j < series.a.size(); ++j) {
    if (!leave(j)) continue;
    sum += 0.5 * (series.a[j] * series.a[j] + series.b[j] * series.b[j]);
    series.a[j] = series.b[j] = 0;
  }
  return std::sqrt(sum);
}

// Slope a step of the best line through `count` heights and one more, from `first`.
double slopeOf(const std::vector<double>& heights, std::size_t first, std::size_t count) {
  const double middle = 0.5 * static_cast<double>(count);
  double along = 0, square = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    const double x = static_cast<double>(i) - middle;
    along += x * heights[first + i];
    square += x * x;
  }
  return along / square;
}

// By how much the slope at the beginning is above that at the end, each of so many steps.
double bendOf(const std::vector<double>& heights, std::size_t steps) {
  return slopeOf(heights, 0, steps) - slopeOf(heights, heights.size() - 1 - steps, steps);
}

// The end blended into the beginning by a cubic over the last `blend` steps, with slopes of so many
// steps at both ends.
std::vector<double> closedBy(std::vector<double> heights, std::size_t blend, std::size_t steps) {
  const std::size_t last = heights.size() - 1;
  // c(u) = p u^2 + q u^3 over the zone, 0 and level where it begins.
  const double step = heights.front() - heights[last], bend = bendOf(heights, steps);
  const double u = 1 - 1 / static_cast<double>(blend);
  // c(1) = step; c(1) - c(u) = bend.
  const double square = 1 - u * u, cube = 1 - u * u * u;
  const double q = (bend - step * square) / (cube - square), p = step - q;
  for (std::size_t i = 1; i < blend; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(blend);
    heights[last - blend + i] += t * t * (p + q * t);
  }
  heights[last] = heights.front();
  return heights;
}

void requireLine(const FourierTexture& texture) {
  if (texture.kind != TextureKind::line) throw Error("is not a texture along a line");
}

} // namespace

std::vector<double> seamless(std::vector<double> heights, std::size_t blend) {
  if (heights.size() < 4 || blend < 2 || blend + 2 > heights.size())
    throw Error("blending takes two steps or more, and fewer than there are");
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  std::vector<double> closed = closedBy(heights, blend, 1);
  const auto leaves = [least = *low, most = *high](double h) { return h < least || h > most; };
  if (std::none_of(closed.begin(), closed.end(), leaves)) return closed;
  // Of single steps the slopes of a rough profile are chance, of which a long zone makes hills.
  // Those of a few steps agree where they are none.
  const double bend = bendOf(heights, 1);
  const auto agrees = [&](std::size_t steps) {
    return std::abs(bendOf(heights, std::min(steps, blend)) - bend) < kSameBend * std::abs(bend);
  };
  if (agrees(2) && agrees(4) && agrees(8)) return closed;
  closed = closedBy(heights, blend, std::max<std::size_t>(1, blend / 4));
  for (double& h : closed) h = std::clamp(h, *low, *high);
  return closed;
}

FourierSeries seriesOf(const std::vector<double>& heights, int harmonics) {
  const std::size_t m = heights.size();
  if (harmonics < 1 || 2 * static_cast<std::size_t>(harmonics) > m)
    throw Error(std::to_string(harmonics) + " harmonics need " +
                std::to_string(2 * std::int64_t{harmonics} + 1) + " samples, there are " +
                std::to_string(m));
  std::vector<double> cosine(m), sine(m);
  for (std::size_t i = 0; i < m; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(m);
    cosine[i] = std::cos(angle);
    sine[i] = std::sin(angle);
  }
  FourierSeries series;
  for (const double h : heights) series.mean += h / static_cast<double>(m);
  for (std::size_t j = 1; j <= static_cast<std::size_t>(harmonics); ++j) {
    double a = 0, b = 0;
    for (std::size_t i = 0, k = 0; i < m; ++i, k = (k + j) % m) {
      a += (heights[i] - series.mean) * cosine[k];
      b += (heights[i] - series.mean) * sine[k];
    }
    const bool nyquist = 2 * j == m;
    series.a.push_back((nyquist ? 1 : 2) * a / static_cast<double>(m));
    series.b.push_back(nyquist ? 0 : 2 * b / static_cast<double>(m));
  }
  return series;
}

FittedTexture fitTexture(const std::vector<ProfilePoint>& given, const FitOptions1d& options) {
  const std::vector<ProfilePoint> points = inOrder(given);
  if (points.size() < 3) throw Error("the profile has fewer than three points");
  if (options.harmonics < 1 || options.harmonics > kMostHarmonics)
    throw Error("there must be 1 to " + std::to_string(kMostHarmonics) + " harmonics");
  if (!(options.blend > 0 && options.blend <= 0.5))
    throw Error("what is blended lies between 0 and half of the profile");
  if (options.cutoff && !(*options.cutoff > 0)) throw Error("the cutoff is a length above 0");
  const double from = points.front().along, length = points.back().along - from;
  double step = options.step.value_or(medianStep(points));
  if (!(options.over_noise >= 0)) throw Error("a harmonic is over the noise by a number above 0");
  if (!(step > 0) || !(length > 3 * step)) throw Error("the profile has fewer than three steps");
  for (std::size_t i = 1; i < points.size(); ++i)
    if (const double gap = points[i].along - points[i - 1].along;
        gap > std::max(kLongestGap * length, 1.5 * step))
      throw Error("the profile has no height between " + formatLength(points[i - 1].along) +
                  " and " + formatLength(points[i].along));
  if (length / step > kMostSamples)
    throw Error("the profile has more than " + formatCount(static_cast<std::size_t>(kMostSamples)) +
                " steps of " + formatLength(step) + "; choose a longer step");
  const auto m = static_cast<std::size_t>(std::lround(length / step));
  step = length / static_cast<double>(m);
  auto [heights, speeds] = evenHeights(points, from, step, m + 1);
  FittedTexture fitted;
  fitted.length = length;
  fitted.samples = m;
  fitted.tilt = flatten(heights) / step;
  fitted.rms = std::sqrt(offLine(heights, m));
  fitted.variance = meanSquare(heights, m);
  double highest = 0;
  for (const ProfilePoint& point : points) highest = std::max(highest, std::abs(point.height));
  if (!(std::sqrt(fitted.variance) > kRounding * highest)) throw Error("the profile is flat");
  double course = 0; // mean square of what is no texture
  if (options.cutoff && !speeds.empty()) {
    std::vector<double> drawn = drawnHeights(heights, speeds, step, *options.cutoff);
    for (std::size_t i = 0; i < m; ++i)
      course += std::pow(heights[i] - drawn[i], 2) / static_cast<double>(m);
    heights = std::move(drawn);
  }

  const auto blend = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(options.blend * static_cast<double>(m))), 2, m - 1);
  std::vector<double> closed = seamless(heights, blend);
  double changed = 0;
  for (std::size_t i = 0; i < m; ++i)
    changed += (closed[i] - heights[i]) * (closed[i] - heights[i]);
  fitted.blended = std::sqrt(changed / static_cast<double>(m));
  closed.pop_back();
  FourierTexture& texture = fitted.texture;
  texture.omega = 2 * std::numbers::pi / length; // A20
  texture.series = seriesOf(closed, std::min(options.harmonics, static_cast<int>((m - 1) / 2)));
  texture.series.mean = 0;
  texture.low = leastHeight(texture);
  // The constant is free, as the mean of a texture says nothing.
  std::vector<double> misses;
  double mean = 0;
  for (std::size_t i = 0; i + blend < m; ++i) {
    misses.push_back(heights[i] - height(texture, step * static_cast<double>(i)));
    mean += misses.back();
  }
  for (double& miss : misses) miss -= mean / static_cast<double>(misses.size());
  fitted.residual = std::sqrt(meanSquare(misses, misses.size()));
  fitted.noise = noiseOf(texture);
  if (options.cutoff) {
    const auto longer = std::min(static_cast<std::size_t>(std::ceil(length / *options.cutoff)) - 1,
                                 texture.series.a.size());
    if (longer == texture.series.a.size())
      throw Error("all of the texture's waves are longer than " + formatLength(*options.cutoff));
    fitted.left_out = std::hypot(
        leaveOut(texture.series, [&](std::size_t j) { return j < longer; }), std::sqrt(course));
  }
  if (options.over_noise > 0) {
    const double quiet_rms = leaveOut(texture.series, [&](std::size_t j) {
      const double wavelength = length / static_cast<double>(j + 1),
                   amplitude = std::hypot(texture.series.a[j], texture.series.b[j]);
      const bool quiet = amplitude < options.over_noise * fitted.noise * wavelength * wavelength;
      fitted.quiet += quiet && amplitude > 0;
      return quiet;
    });
    fitted.residual = std::hypot(fitted.residual, quiet_rms);
    if (rmsOf(texture.series) == 0) throw Error("no harmonic rises over the noise");
  }
  texture.low = leastHeight(texture);
  return fitted;
}

double noiseOf(const FourierTexture& line) {
  requireLine(line);
  std::vector<double> heights;
  for (std::size_t j = 0; j < line.series.a.size(); ++j) {
    const double amplitude = std::hypot(line.series.a[j], line.series.b[j]);
    const double wavelength = period(line) / static_cast<double>(j + 1);
    if (amplitude > 0) heights.push_back(amplitude / (wavelength * wavelength));
  }
  return heights.empty() ? 0 : percentiles(heights).p50;
}

FourierTexture crossCorrelation(const FourierTexture& across, const FourierTexture& along) {
  requireLine(across);
  requireLine(along);
  if (harmonics(across) > kMostPlaneHarmonics)
    throw Error("textures of more than " + std::to_string(kMostPlaneHarmonics) +
                " harmonics are not crossed");
  if (across.omega != along.omega || harmonics(across) != harmonics(along))
    throw Error("two textures that are crossed must have one period and one number of harmonics");
  FourierTexture crossed;
  crossed.name = across.name;
  crossed.kind = TextureKind::products;
  crossed.omega = across.omega;
  crossed.compliance = across.compliance;
  FourierProduct product{along.series, across.series};
  const double scale = 1 / rmsOf(along.series);
  for (std::size_t j = 0; j < product.along_x.a.size(); ++j) {
    product.along_x.a[j] *= scale;
    product.along_x.b[j] *= -scale; // of -x
  }
  crossed.products.push_back(std::move(product));
  crossed.low = leastHeight(crossed);
  return crossed;
}

FourierTexture spectrumOf(const FourierTexture& line, std::uint64_t seed) {
  requireLine(line);
  FourierTexture spectrum = line;
  spectrum.kind = TextureKind::spectrum;
  spectrum.seed = seed;
  for (std::size_t j = 0; j < line.series.a.size(); ++j)
    spectrum.series.a[j] = std::hypot(line.series.a[j], line.series.b[j]);
  spectrum.series.b.clear();
  spectrum.low = leastHeight(spectrum);
  return spectrum;
}

} // namespace patina
