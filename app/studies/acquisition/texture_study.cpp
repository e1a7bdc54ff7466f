#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "acquisition/profile/height_profile.h"
#include "acquisition/simulation/simulated_surface.h"
#include "acquisition/texture/fit_texture.h"
#include "app/studies/framework/query_timing.h"
#include "app/studies/framework/study.h"
#include "scene/fourier/reduced_phase.h"
#include "scene/fourier/texture_evaluator.h"

namespace patina {
namespace {

// Compares forms of texture sums with sums in higher precision.

__extension__ using Quad = __float128;

// Returns omega x modulo 2 pi, to 1e-24.
long double truePhase(double omega, double x) {
  const Quad turn =
      2 * (static_cast<Quad>(std::numbers::pi) + static_cast<Quad>(1.22464679914735317636e-16) +
           static_cast<Quad>(-2.99476980971833966530e-33));
  const Quad angle = static_cast<Quad>(omega) * static_cast<Quad>(x);
  return static_cast<long double>(angle - turn * std::nearbyint(static_cast<double>(angle / turn)));
}

double trueSum(const FourierSeries& series, double omega, double x) {
  const long double phase = truePhase(omega, x);
  long double sum = series.mean;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const long double angle = static_cast<long double>(i + 1) * phase;
    sum += series.a[i] * std::cos(angle) + series.b[i] * std::sin(angle);
  }
  return static_cast<double>(sum);
}

// Profile of a milled surface, 28 mm long, in steps of 5 um.
std::vector<ProfilePoint> milledPoints(std::uint32_t seed) {
  constexpr double kLength = 28e-3, kStep = 5e-6;
  std::vector<ProfilePoint> points;
  for (const double height : milledProfile(seed, kLength, kStep))
    points.push_back({kStep * static_cast<double>(points.size()), height, 0});
  return points;
}

FourierTexture milledTexture(std::uint32_t seed, int harmonics) {
  FitOptions1d options;
  options.harmonics = harmonics;
  return fitTexture(milledPoints(seed), options).texture;
}

template <class Point, class Form>
WorkPrecisionRow measured(const std::vector<Point>& places, const std::vector<double>& due,
                          double rms, const Form& form, int passes) {
  WorkPrecisionRow row;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double off = std::abs(form(places[i]).value - due[i]) / rms;
    row.error += off * off / static_cast<double>(places.size());
    row.error_max = std::max(row.error_max, off);
  }
  row.error = std::sqrt(row.error);
  row.ns = nsPerQuery(
      places,
      [&](const Point& place) {
        const SeriesValue sum = form(place);
        return sum.value + sum.slope;
      },
      passes);
  return row;
}

FourierTexture planeOf(const FourierTexture& products) {
  FourierTexture plane = products;
  plane.kind = TextureKind::plane;
  plane.products.clear();
  const auto terms = [](const FourierSeries& series) {
    std::vector<double> all{series.mean};
    for (std::size_t i = 0; i < series.a.size(); ++i) {
      all.push_back(series.a[i]);
      all.push_back(series.b[i]);
    }
    return all;
  };
  const std::vector<double> along_x = terms(products.products[0].along_x);
  for (const double p : terms(products.products[0].along_y))
    for (const double q : along_x) plane.plane.push_back(p * q);
  return plane;
}

// 128 harmonics over x, at one period and a million and a billion periods away (T-A19d).
WorkPrecisionTable lineForms(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf(
      "Height and slope of 128 harmonics so many periods away (T-A19d), against a sum in long "
      "double of a phase in quadruple precision",
      "of rms");
  const FourierTexture texture = milledTexture(3, 128);
  const FourierSeries& series = texture.series;
  const double omega = texture.omega, rms = rmsHeight(texture);
  const TextureEvaluator evaluator(texture);
  for (const double periods : {1., 1e6, 1e9}) {
    progress.throwIfCancelled();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<double> places, due;
    for (int i = 0; i < (options.quick ? 300 : 3000); ++i) {
      places.push_back((periods + any(random)) * period(texture));
      due.push_back(trueSum(series, omega, places.back()));
    }
    const auto add = [&](const char* form, const char* phase, double bytes, const auto& sum) {
      WorkPrecisionRow row = measured(places, due, rms, sum, 7);
      row.settings = {{"form", form}, {"phase", phase}, {"periods", periods}};
      row.bytes = bytes;
      table.rows.push_back(row);
    };
    const auto coefficients = static_cast<double>(16 * series.a.size());
    add("direct", "exact", coefficients,
        [&](double x) { return sumDirectly(series, reducePhase(x, omega)); });
    add("table 1e-12", "exact", static_cast<double>(evaluator.bytes()), [&](double x) {
      const TextureValue value = evaluator.at(x);
      return SeriesValue{value.height, value.gradient.x()};
    });
  }
  return table;
}

// Product textures over x and y, which all forms can evaluate (A21).
WorkPrecisionTable planeForms(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf("Height and gradient of N x N harmonics (A21), against the "
                                     "product of two sums in long double",
                                     "of rms");
  for (const int n : {16, 32, 64, 128}) {
    const FourierTexture products = crossCorrelation(milledTexture(3, n), milledTexture(4, n)),
                         plane = planeOf(products);
    const FourierProduct& product = products.products[0];
    const double rms = rmsHeight(products);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> any(-10, 10);
    std::vector<Vec2> places;
    std::vector<double> due;
    for (int i = 0; i < (options.quick ? 100 : 1000); ++i) {
      const double x = any(random) * period(plane), y = any(random) * period(plane);
      places.emplace_back(x, y);
      due.push_back(trueSum(product.along_x, plane.omega, x) *
                    trueSum(product.along_y, plane.omega, y));
    }
    const auto add = [&](const char* form, double bytes, double seconds, const auto& sum) {
      progress.throwIfCancelled();
      WorkPrecisionRow row = measured(places, due, rms, sum, options.quick ? 3 : 7);
      row.settings = {{"form", form}, {"N", n}};
      row.bytes = bytes;
      row.more = {{"made in [ms]", 1e3 * seconds}};
      table.rows.push_back(row);
    };
    add("direct", static_cast<double>(8 * plane.plane.size()), 0, [&](const Vec2& p) {
      const Vec2 slopes = gradient(plane, p.x(), p.y());
      return SeriesValue{height(plane, p.x(), p.y()), slopes.x() + slopes.y()};
    });
    const auto addTable = [&](const char* form, const FourierTexture& texture) {
      const double begin = threadSeconds();
      const TextureEvaluator at(texture);
      const double seconds = threadSeconds() - begin;
      add(form, static_cast<double>(at.bytes()), seconds, [&](const Vec2& p) {
        const TextureValue value = at.at(p.x(), p.y());
        return SeriesValue{value.height, value.gradient.sum()};
      });
    };
    addTable("products, table 1e-12", products);
    addTable("window 1e-12", plane);
  }
  return table;
}

using Points = std::vector<ProfilePoint>;

constexpr double kPi = std::numbers::pi;

// Difference between texture and profile along the first part, without its mean.
struct Lack {
  double rms = 0, most = 0; // fractions of the profile's rms
};

Lack lackOf(const FittedTexture& fitted, const Points& points, double part) {
  const auto count = static_cast<std::size_t>(part * static_cast<double>(fitted.samples));
  std::vector<double> misses;
  double mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = points[i].arc_length - points[0].arc_length;
    misses.push_back(points[i].height - fitted.tilt * x - height(fitted.texture, x));
    mean += misses.back() / static_cast<double>(count);
  }
  Lack lack;
  for (const double miss : misses) {
    lack.rms += (miss - mean) * (miss - mean) / static_cast<double>(count);
    lack.most = std::max(lack.most, std::abs(miss - mean));
  }
  const double rms = std::sqrt(fitted.variance);
  return {std::sqrt(lack.rms) / rms, lack.most / rms};
}

struct Profile {
  std::string about;
  std::vector<Points> points; // one per seed
  double order;
  int from; // first number of harmonics in the fit of the order
  // Rms of all harmonics beyond N over the profile's; null without a closed form.
  double (*beyond)(int harmonics) = nullptr;
};

template <class Height> std::vector<Points> sampled(const Height& at) {
  constexpr int kSamples = 4000;
  Points points;
  for (int i = 0; i <= kSamples; ++i) {
    const double u = (i + 0.5) / kSamples;
    points.push_back({20e-3 * i / kSamples, 1e-4 * at(u - std::floor(u)), 0});
  }
  return {points};
}

template <class Power> double rootOfSum(int from, int step, const Power& power) {
  double sum = 0;
  for (int j = from; j < 1'000'000; j += step) sum += power(static_cast<double>(j));
  return std::sqrt(sum);
}

std::vector<Profile> profiles(const StudyOptions& options) {
  std::vector<Points> milled;
  for (std::uint32_t seed = 1; seed <= (options.quick ? 1U : options.thorough ? 20U : 4U); ++seed)
    milled.push_back(milledPoints(seed));
  return {{"Two jumps", sampled([](double u) { return u < 0.25 || u >= 0.75 ? 1. : -1.; }), -0.5, 8,
           [](int n) {
             // Odd harmonics only; an even n is not among them.
             return rootOfSum(n + 1, 2, [](double j) { return 8 / (kPi * kPi * j * j); });
           }},
          // Bernoulli's third polynomial, with the seam in the middle.
          {"A jump of the curvature", sampled([](double u) {
             const double v = u < 0.5 ? u + 0.5 : u - 0.5;
             return v * (v - 0.5) * (v - 1);
           }),
           -2.5, 8,
           [](int n) {
             const auto power = [](double j) { return std::pow(j, -6); };
             return rootOfSum(n + 1, 1, power) / rootOfSum(1, 1, power);
           }},
          {"Milled profiles, which have corners", std::move(milled), -1.5, 64}};
}

WorkPrecisionTable harmonicsTable(const Profile& profile, Progress& progress) {
  FitOptions1d fitting;
  WorkPrecisionTable table =
      tableOf(profile.about + ", by harmonics (T-A18): what the texture lacks of it, "
                              "rms and max, where nothing is blended",
              "of rms");
  OrderFit order;
  for (const int harmonics : {8, 16, 32, 64, 128, 256}) {
    progress.throwIfCancelled();
    fitting.harmonics = harmonics;
    WorkPrecisionRow row;
    row.settings = {{"harmonics", harmonics}};
    const auto count = static_cast<double>(profile.points.size());
    for (const Points& points : profile.points) {
      const double begin = threadSeconds();
      const FittedTexture fitted = fitTexture(points, fitting);
      row.ns += 1e9 * (threadSeconds() - begin) / count;
      const Lack lack = lackOf(fitted, points, 1 - fitting.blend);
      row.error += lack.rms * lack.rms / count;
      row.error_max = std::max(row.error_max, lack.most);
    }
    row.error = std::sqrt(row.error);
    // Nothing is blended in this profile.
    if (profile.beyond)
      row.more = {
          {"of closed form", row.error / profile.beyond(harmonics) * std::sqrt(1 - fitting.blend)}};
    table.rows.push_back(row);
    if (harmonics >= profile.from) order.add(harmonics, row.error);
  }
  order.into(table, profile.order);
  return table;
}

// Max slope within one wave of the last harmonic from the seam, over the rms slope.
double steepnessAtSeam(const FourierTexture& texture) {
  const double wave = period(texture) / harmonics(texture);
  double most = 0;
  for (int i = -32; i <= 32; ++i) most = std::max(most, std::abs(slope(texture, wave * i / 32)));
  return most / rmsSlope(texture);
}

WorkPrecisionTable blendTable(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf(
      "Milled profiles as 128 harmonics, by how much of the end is blended into the beginning "
      "(A18): what the texture lacks of the whole, rms and max",
      "of rms");
  const std::uint32_t seeds = options.quick ? 2 : options.thorough ? 100 : 20;
  for (const double blend : {0.0005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    progress.throwIfCancelled();
    WorkPrecisionRow row;
    row.settings = {{"blended [%]", 100 * blend}};
    double first = 0, seam = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
      const Points points = milledPoints(seed);
      const double begin = threadSeconds();
      const FittedTexture fitted = fitTexture(points, {128, blend, {}});
      row.ns += 1e9 * (threadSeconds() - begin) / seeds;
      const Lack whole = lackOf(fitted, points, 1);
      row.error += whole.rms * whole.rms / seeds;
      row.error_max = std::max(row.error_max, whole.most);
      first += std::pow(lackOf(fitted, points, 0.8).rms, 2) / seeds;
      seam += steepnessAtSeam(fitted.texture) / seeds;
    }
    row.error = std::sqrt(row.error);
    row.more = {{"of the first 80 %", std::sqrt(first)}, {"steepest at the seam / rms", seam}};
    table.rows.push_back(row);
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> textureStudy(const StudyOptions& options, Progress& progress) {
  std::vector<StudyPart> parts;
  for (const Profile& profile : profiles(options))
    parts.push_back({0.2 * static_cast<double>(parts.size()), "harmonics",
                     [&progress, profile] { return harmonicsTable(profile, progress); }});
  parts.push_back({0.5, "blending", [&] { return blendTable(options, progress); }});
  parts.push_back({0.7, "forms over x", [&] { return lineForms(options, progress); }});
  parts.push_back({0.8, "forms over x and y", [&] { return planeForms(options, progress); }});
  return tablesOf(parts, progress);
}

} // namespace patina
