#include "app/studies/acquisition/filter_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "acquisition/profile/compliance.h"
#include "acquisition/profile/height_profile.h"
#include "acquisition/simulation/simulated_surface.h"
#include "acquisition/values/scan_samples.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

struct Press {
  double stiffness, noise; // [N/m]; displacement [m]
  int count;
};

std::vector<PressSample> presses(const Press& press, const ProbeModel& probe, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PressSample> samples;
  for (int i = 0; i < 300 * press.count; ++i) {
    const double t = i / 500., in = std::fmod(t, 0.6);
    const double force = in < 0.5 ? 3.4 * std::sin(kPi * in / 0.5) : 0;
    const double shown = force + probe.force_noise * normal(random);
    samples.push_back({t, force / press.stiffness + press.noise * normal(random),
                       probe.force_step * std::round(shown / probe.force_step)});
  }
  return samples;
}

} // namespace

WorkPrecisionTable heightTable(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = filterTable("Height of milled surfaces from acceleration in steps of "
                                         "0.015 g (A07), relative rms over surfaces, and worst",
                                         "1");
  constexpr double kStep = 5e-6;
  const ProbeModel probe;
  HeightOptions sensor;
  sensor.acceleration_variance = probe.accelerationVariance();
  const std::uint32_t seeds = options.quick ? 2 : options.thorough ? 40 : 6;
  for (const double speed : {0.02, 0.04, 0.08}) {
    WorkPrecisionRow row;
    row.settings = {{"speed [mm/s]", 1e3 * speed}};
    double length = 0, taken = 0, seconds = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
      progress.throwIfCancelled();
      const TraceReading reading =
          readTrace(envelope(milledProfile(seed, 28e-3, kStep), kStep, 0.5e-3), kStep, speed, 500,
                    probe.acceleration_step, probe.acceleration_noise,
                    probe.acceleration_step * seed / seeds, seed);
      const double begin = threadSeconds();
      const HeightProfile profile = estimateProfile(reading.samples, sensor);
      taken += threadSeconds() - begin;
      seconds += reading.samples.back().t;
      double squares = 0, all = 0;
      for (std::size_t i = 0; i < profile.points.size(); ++i) {
        squares += std::pow(profile.points[i].height - reading.heights[i], 2);
        all += reading.heights[i] * reading.heights[i];
      }
      row.error += squares / all / seeds;
      row.error_max = std::max(row.error_max, std::sqrt(squares / all));
      length += profile.length / seeds;
    }
    row.error = std::sqrt(row.error);
    row.ns = 1e9 * taken / seconds;
    row.more = {{"length found [mm]", 1e3 * length}};
    table.rows.push_back(row);
  }
  return table;
}

WorkPrecisionTable stiffnessTable(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = filterTable(
      "Stiffness from presses of 0.5 s with 0.3 mm of noise (A08), deviation and worst; it "
      "falls with the root of their number",
      "%");
  const ProbeModel probe;
  const std::uint32_t seeds = options.quick ? 200 : options.thorough ? 10000 : 1000;
  OrderFit order;
  for (const double k : {300., 1000., 3000.})
    for (const int count : {3, 12, 48}) {
      if (count > 3 && k != 1000) continue;
      progress.throwIfCancelled();
      WorkPrecisionRow row;
      row.settings = {{"stiffness [N/m]", k}, {"presses", count}};
      double mean = 0, squares = 0, stated = 0, taken = 0;
      for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        const std::vector<PressSample> samples = presses({k, 0.3e-3, count}, probe, seed);
        const double begin = threadSeconds();
        const auto estimate = estimateCompliance(samples, std::sqrt(probe.forceVariance()));
        taken += threadSeconds() - begin;
        const double off = 100 * (estimate->stiffness / k - 1);
        mean += off / seeds;
        squares += off * off / seeds;
        stated += 100 * estimate->stiffness_deviation / k / seeds;
        row.error_max = std::max(row.error_max, std::abs(off));
      }
      row.error = std::sqrt(squares - mean * mean);
      row.ns = 1e9 * taken / seeds;
      row.more = {{"bias [%]", mean}, {"stated / true deviation", stated / row.error}};
      table.rows.push_back(row);
      if (k == 1000) order.add(count, row.error);
    }
  order.into(table, -0.5);
  return table;
}

} // namespace patina
