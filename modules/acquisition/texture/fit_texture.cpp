#include "acquisition/texture/fit_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr int kOrder = 3; // order of splines and differences
constexpr int kBand = kOrder + 1;
constexpr double kKnots = 8; // knots per cutoff length of the waviness
// Energy of a wave of that length in the splines: 2 (1208 + 1191 cos u + 120 cos 2u + cos 3u) / 7!,
// u = 2 pi / kKnots.
constexpr double kEnergy = 0.8132766;
constexpr double kSlow = 1. / 4;      // speed of weight 1/2 over the median
constexpr double kBeyondCutoff = 1.5; // waviness length over the cutoff, which loses a twelfth

// Returns the cubic B-spline weights, for u from 0 to 1 between two knots.
std::array<double, kBand> blending(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
          u * u * u / 6};
}

// Lower band matrix, each row from the diagonal to the left; solved in place by Cholesky.
struct Banded {
  std::vector<std::array<double, kBand>> rows;
  std::vector<double> right;

  explicit Banded(std::size_t n) : rows(n), right(n) {}

  void add(std::size_t first, const std::array<double, kBand>& row, double weight, double value) {
    for (std::size_t a = 0; a < kBand; ++a) {
      right[first + a] += weight * row[a] * value;
      for (std::size_t b = 0; b <= a; ++b) rows[first + a][a - b] += weight * row[a] * row[b];
    }
  }
  std::vector<double> solve() {
    const std::size_t n = rows.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t d = std::min<std::size_t>(i, kOrder) + 1; d-- > 0;) {
        double sum = rows[i][d]; // element (i, i - d)
        for (std::size_t k = d + 1; k < kBand && k <= i; ++k)
          sum -= rows[i][k] * rows[i - d][k - d];
        rows[i][d] = d > 0 ? sum / rows[i - d][0] : std::sqrt(sum);
      }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t d = 1; d < kBand && d <= i; ++d) right[i] -= rows[i][d] * right[i - d];
      right[i] /= rows[i][0];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t d = 1; d < kBand && i + d < n; ++d)
        right[i] -= rows[i + d][d] * right[i + d];
      right[i] /= rows[i][0];
    }
    return right;
  }
};

} // namespace

std::vector<double> wavinessOf(const std::vector<double>& heights,
                               const std::vector<double>& weights, double step, double length) {
  const double knot = length / kKnots;
  const auto knots = static_cast<std::size_t>(static_cast<double>(heights.size()) * step / knot);
  Banded equations(knots + 1 + kOrder);
  const auto placeOf = [&](std::size_t i, double& u) {
    u = static_cast<double>(i) * step / knot;
    const auto first = static_cast<std::size_t>(u);
    u -= static_cast<double>(first);
    return first;
  };
  double u = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t first = placeOf(i, u);
    equations.add(first, blending(u), weights[i], heights[i]);
  }
  const double stiff =
      kEnergy * knot / step / std::pow(2 * std::sin(std::numbers::pi / kKnots), 2. * kOrder);
  for (std::size_t i = 0; i + kOrder < equations.rows.size(); ++i)
    equations.add(i, {-1, 3, -3, 1}, stiff, 0);
  const std::vector<double> factors = equations.solve();
  std::vector<double> course;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t first = placeOf(i, u);
    const std::array<double, kBand> shares = blending(u);
    double height = 0;
    for (std::size_t a = 0; a < kBand; ++a) height += shares[a] * factors[first + a];
    course.push_back(height);
  }
  return course;
}

std::vector<double> speedWeights(const std::vector<double>& speeds) {
  const double slow = kSlow * percentiles(speeds).p50;
  if (!(slow > 0)) throw Error("the probe is stationary on half of the profile or more");
  std::vector<double> weights;
  for (const double speed : speeds) {
    const double known = std::pow(speed / slow, 3);
    weights.push_back(known / (1 + known));
  }
  return weights;
}

std::vector<double> roughnessProfile(const std::vector<double>& heights,
                                     const std::vector<double>& speeds, double step,
                                     double cutoff) {
  const std::vector<double> weights = speedWeights(speeds),
                            course = wavinessOf(heights, weights, step, kBeyondCutoff * cutoff);
  std::vector<double> texture;
  for (std::size_t i = 0; i < heights.size(); ++i)
    texture.push_back(weights[i] * (heights[i] - course[i]));
  return texture;
}

namespace {

constexpr double kLongestGap = 0.05; // longest gap relative to the profile's length
constexpr double kRounding = 1e-13;  // smallest relative rms of a profile after flattening
constexpr std::size_t kBesideTilt = 16;
constexpr double kMaxSamples = 1e6;
constexpr double kSamePlace = 1e-3; // in steps; nearer points coincide
constexpr double kSameBend = 0.25;  // largest relative difference of slope changes that agree

// Sorts by position and merges coincident points.
std::vector<ProfilePoint> inOrder(std::vector<ProfilePoint> points) {
  for (const ProfilePoint& point : points)
    if (!std::isfinite(point.arc_length) || !std::isfinite(point.height))
      throw Error("a height of the profile is not finite");
  std::sort(points.begin(), points.end(), [](const ProfilePoint& a, const ProfilePoint& b) {
    return a.arc_length < b.arc_length;
  });
  return points;
}

double medianStep(const std::vector<ProfilePoint>& points) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].arc_length > points[i - 1].arc_length)
      steps.push_back(points[i].arc_length - points[i - 1].arc_length);
  if (steps.empty()) throw Error("the profile has no length");
  return percentiles(steps).p50;
}

struct EvenHeights {
  std::vector<double> heights;
  std::vector<double> speeds; // empty unless all are known
};

// Samples at from, from + step, ... : means over one step, or linear interpolation.
EvenHeights evenHeights(const std::vector<ProfilePoint>& points, double from, double step,
                        std::size_t count) {
  std::vector<ProfilePoint> places; // one per step with points
  std::vector<double> weights;
  const bool weighted =
      std::all_of(points.begin(), points.end(), [](const ProfilePoint& p) { return p.sigma > 0; });
  const bool drawn =
      std::all_of(points.begin(), points.end(), [](const ProfilePoint& p) { return p.speed; });
  std::ptrdiff_t last = -1;
  for (const ProfilePoint& point : points) {
    const auto place = static_cast<std::ptrdiff_t>(std::lround((point.arc_length - from) / step));
    const double weight = weighted ? 1 / (point.sigma * point.sigma) : 1;
    if (place != last) {
      places.push_back({0, 0, 0, 0});
      weights.push_back(0);
      last = place;
    }
    places.back().arc_length += weight * point.arc_length;
    places.back().height += weight * point.height;
    *places.back().speed += weight * point.speed.value_or(0);
    weights.back() += weight;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].arc_length /= weights[i];
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
    while (next + 1 < places.size() && places[next].arc_length < x - kSamePlace * step) ++next;
    const ProfilePoint& behind = places[next];
    if (next == 0 || std::abs(behind.arc_length - x) <= kSamePlace * step ||
        behind.arc_length < x) {
      add(behind.height, *behind.speed);
      continue;
    }
    const ProfilePoint& before = places[next - 1];
    const double share = (x - before.arc_length) / (behind.arc_length - before.arc_length);
    add((1 - share) * before.height + share * behind.height,
        (1 - share) * *before.speed + share * *behind.speed);
  }
  return even;
}

// Returns the slope per step of the line fitted together with a mean and the lowest harmonics, so
// that whole waves do not count as tilt. Subtracts it and the mean.
double flatten(std::vector<double>& heights) {
  const std::size_t m = heights.size() - 1; // the last height is the first one of the next period
  const auto n = static_cast<double>(m);
  std::vector<double> ramp(m); // part of a ramp orthogonal to the harmonics
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

// Returns the mean square of the first `count` values about their least-squares line.
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

// Sets the harmonics j + 1 with `leave(j)` to zero and returns their rms.
template <class Leave> double leaveOut(FourierSeries& series, const Leave& leave) {
  double sum = 0;
  for (std::size_t j = 0; j < series.a.size(); ++j) {
    if (!leave(j)) continue;
    sum += 0.5 * (series.a[j] * series.a[j] + series.b[j] * series.b[j]);
    series.a[j] = series.b[j] = 0;
  }
  return std::sqrt(sum);
}

// Returns the slope per step of the line through `count` heights and one more, from `first`.
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

// Returns the slope at the start minus the slope at the end, each over `steps` steps.
double slopeChange(const std::vector<double>& heights, std::size_t steps) {
  return slopeOf(heights, 0, steps) - slopeOf(heights, heights.size() - 1 - steps, steps);
}

// Blends the last `blend` steps into the beginning by a cubic, with slopes over `steps` steps.
std::vector<double> closedBy(std::vector<double> heights, std::size_t blend, std::size_t steps) {
  const std::size_t last = heights.size() - 1;
  // Cubic c(u) = p u^2 + q u^3 over the zone; value and slope are 0 at its start.
  const double step = heights.front() - heights[last], bend = slopeChange(heights, steps);
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
  // Single-step slopes of a rough profile are random, and a long zone would amplify them to hills.
  // Slopes over several steps agree on a smooth profile.
  const double bend = slopeChange(heights, 1);
  const auto agrees = [&](std::size_t steps) {
    return std::abs(slopeChange(heights, std::min(steps, blend)) - bend) <
           kSameBend * std::abs(bend);
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
  if (options.harmonics < 1 || options.harmonics > kMaxHarmonics)
    throw Error("there must be 1 to " + std::to_string(kMaxHarmonics) + " harmonics");
  if (!(options.blend > 0 && options.blend <= 0.5))
    throw Error("the blended part must be above 0 and at most half of the profile");
  if (options.cutoff && !(*options.cutoff > 0)) throw Error("the cutoff is a length above 0");
  const double from = points.front().arc_length, length = points.back().arc_length - from;
  double step = options.step.value_or(medianStep(points));
  if (!(options.min_snr >= 0)) throw Error("--min-snr must not be negative");
  if (!(step > 0) || !(length > 3 * step)) throw Error("the profile has fewer than three steps");
  for (std::size_t i = 1; i < points.size(); ++i)
    if (const double gap = points[i].arc_length - points[i - 1].arc_length;
        gap > std::max(kLongestGap * length, 1.5 * step))
      throw Error("the profile has no height between " + formatLength(points[i - 1].arc_length) +
                  " and " + formatLength(points[i].arc_length));
  if (length / step > kMaxSamples)
    throw Error("the profile has more than " + formatCount(static_cast<std::size_t>(kMaxSamples)) +
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
  double course = 0; // mean square of the removed waviness
  if (options.cutoff && !speeds.empty()) {
    std::vector<double> drawn = roughnessProfile(heights, speeds, step, *options.cutoff);
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
  texture.low = minHeight(texture);
  std::vector<double> residuals; // the constant is arbitrary
  double mean = 0;
  for (std::size_t i = 0; i + blend < m; ++i) {
    residuals.push_back(heights[i] - height(texture, step * static_cast<double>(i)));
    mean += residuals.back();
  }
  for (double& residual : residuals) residual -= mean / static_cast<double>(residuals.size());
  fitted.residual = std::sqrt(meanSquare(residuals, residuals.size()));
  fitted.noise = harmonicNoise(texture);
  if (options.cutoff) {
    const auto longer = std::min(static_cast<std::size_t>(std::ceil(length / *options.cutoff)) - 1,
                                 texture.series.a.size());
    if (longer == texture.series.a.size())
      throw Error("all of the texture's waves are longer than " + formatLength(*options.cutoff));
    fitted.removed_rms = std::hypot(
        leaveOut(texture.series, [&](std::size_t j) { return j < longer; }), std::sqrt(course));
  }
  if (options.min_snr > 0) {
    const double quiet_rms = leaveOut(texture.series, [&](std::size_t j) {
      const double wavelength = length / static_cast<double>(j + 1),
                   amplitude = std::hypot(texture.series.a[j], texture.series.b[j]);
      const bool suppressed_harmonics =
          amplitude < options.min_snr * fitted.noise * wavelength * wavelength;
      fitted.suppressed_harmonics += suppressed_harmonics && amplitude > 0;
      return suppressed_harmonics;
    });
    fitted.residual = std::hypot(fitted.residual, quiet_rms);
    if (rmsOf(texture.series) == 0) throw Error("no harmonic exceeds the noise");
  }
  texture.low = minHeight(texture);
  return fitted;
}

double harmonicNoise(const FourierTexture& line) {
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
  if (harmonics(across) > kMaxPlaneHarmonics)
    throw Error("textures of more than " + std::to_string(kMaxPlaneHarmonics) +
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
    product.along_x.b[j] *= -scale; // mirrored at x = 0
  }
  crossed.products.push_back(std::move(product));
  crossed.low = minHeight(crossed);
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
  spectrum.low = minHeight(spectrum);
  return spectrum;
}

} // namespace patina
