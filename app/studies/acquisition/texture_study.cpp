#include "app/studies/acquisition/texture_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/texture/fit_texture.h"
#include "app/studies/acquisition/texture_forms.h"
#include "app/studies/query_timing.h"

namespace patina {
namespace {

using Points = std::vector<ProfilePoint>;

constexpr double kPi = std::numbers::pi;

// What the texture lacks of the profile along its first part; a constant says nothing.
struct Lack {
  double rms = 0, most = 0; // of the profile's rms
};

Lack lackOf(const FittedTexture& fitted, const Points& points, double part) {
  const auto count = static_cast<std::size_t>(part * static_cast<double>(fitted.samples));
  std::vector<double> misses;
  double mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = points[i].along - points[0].along;
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
  std::vector<Points> points; // one a seed
  double order;
  int from; // harmonics from which the order is fitted
  // rms of all harmonics beyond N, of the profile's; absent where no closed form is known.
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
             // Odd ones alone, of which an even n is none.
             return rootOfSum(n + 1, 2, [](double j) { return 8 / (kPi * kPi * j * j); });
           }},
          // Bernoulli's third polynomial, its seam in the middle.
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
    row.knobs = {{"harmonics", harmonics}};
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
    // All of it lies where nothing is blended.
    if (profile.beyond)
      row.more = {
          {"of closed form", row.error / profile.beyond(harmonics) * std::sqrt(1 - fitting.blend)}};
    table.rows.push_back(row);
    if (harmonics >= profile.from) order.add(harmonics, row.error);
  }
  order.into(table, profile.order);
  return table;
}

// The steepest slope within a wave of the last harmonic from the seam, of the rms slope.
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
    row.knobs = {{"blended [%]", 100 * blend}};
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
