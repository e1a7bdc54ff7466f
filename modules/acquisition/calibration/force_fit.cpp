#include "acquisition/calibration/force_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace patina {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// shown = zero + slope force.
struct ShownLine {
  double zero = 0, slope = 0;
  double miss(const KnownForce& r) const { return r.shown - zero - slope * r.force; }
};

// The median slope of all pairs: a quarter of wrong readings does not move it far.
ShownLine medianLine(const std::vector<KnownForce>& readings) {
  std::vector<double> slopes, zeros;
  for (const KnownForce& a : readings)
    for (const KnownForce& b : readings)
      if (b.force > a.force) slopes.push_back((b.shown - a.shown) / (b.force - a.force));
  ShownLine line{0, median(slopes)};
  for (const KnownForce& r : readings) zeros.push_back(line.miss(r));
  line.zero = median(zeros);
  return line;
}

} // namespace

std::optional<ForceFit> fitForce(const std::vector<KnownForce>& readings) {
  std::set<double> forces;
  for (const KnownForce& r : readings) forces.insert(r.force);
  if (readings.size() < 4 || forces.size() < 3) return std::nullopt;
  const ShownLine first = medianLine(readings);
  std::vector<double> misses;
  for (const KnownForce& r : readings) misses.push_back(std::abs(first.miss(r)));
  const double count = static_cast<double>(readings.size());
  const double range = std::abs(first.slope) * (*forces.rbegin() - *forces.begin());
  // Of few readings the median miss says less than of many; and no wrong weight is within kFair of
  // the range, which the sensor may be bent by.
  constexpr double kFair = 0.005;
  const double most =
      std::max(3.5 * 1.4826 * (1 + 5 / (count - 2)) * median(misses), kFair * range);
  ForceFit fit;
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (misses[i] > most) {
      fit.rejected.push_back(i);
      continue;
    }
    n += 1, x += readings[i].force, y += readings[i].shown;
    xx += readings[i].force * readings[i].force, xy += readings[i].force * readings[i].shown;
  }
  const double spread = xx - x * x / n;
  if (n < 3 || !(spread > 0)) return std::nullopt;
  ShownLine line{0, (xy - x * y / n) / spread};
  line.zero = (y - line.slope * x) / n;
  double squares = 0;
  for (std::size_t i = 0; i < readings.size(); ++i)
    if (misses[i] <= most) squares += line.miss(readings[i]) * line.miss(readings[i]);
  const double variance = squares / (n - 2), slope_deviation = std::sqrt(variance / spread);
  if (!(std::abs(line.slope) > 5 * slope_deviation)) return std::nullopt;
  fit.zero = line.zero;
  fit.gain = 1 / line.slope;
  fit.zero_deviation = std::sqrt(variance * xx / (n * spread));
  fit.gain_deviation = slope_deviation / (line.slope * line.slope);
  fit.rms = std::sqrt(squares / n) / std::abs(line.slope);
  return fit;
}

} // namespace patina
