#include "acquisition/profilometer/square_area.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kMaxSide = 4096;

// Points of one axis between which a position of the square lies.
struct PointsAbout {
  std::size_t low, high;
  double share; // weight of the higher sample
};

// `side` positions, `step` apart, about the middle of `count` points; the first is a point.
std::vector<PointsAbout> positionsAlong(std::size_t count, double step_of_points, std::size_t side,
                                        double step) {
  const double spare =
      static_cast<double>(count - 1) - static_cast<double>(side - 1) * step / step_of_points;
  const double first = std::floor(std::max(0.0, spare) / 2 + 1e-9);
  std::vector<PointsAbout> places;
  for (std::size_t i = 0; i < side; ++i) {
    const double u = std::min(first + static_cast<double>(i) * step / step_of_points,
                              static_cast<double>(count - 1));
    const auto low = static_cast<std::size_t>(u);
    places.push_back({low, std::min(low + 1, count - 1), u - static_cast<double>(low)});
  }
  return places;
}

// Takes the least-squares plane off. Coordinates about the middle are orthogonal, so that each
// slope is a sum of its own.
void level(std::vector<double>& heights, std::size_t side) {
  const double middle = static_cast<double>(side - 1) / 2, count = static_cast<double>(side * side);
  double mean = 0, along_x = 0, along_y = 0, square = 0;
  const auto forAll = [&](const auto& act) {
    for (std::size_t r = 0; r < side; ++r)
      for (std::size_t c = 0; c < side; ++c)
        act(heights[r * side + c], static_cast<double>(c) - middle,
            static_cast<double>(r) - middle);
  };
  forAll([&](double z, double, double) { mean += z / count; });
  forAll([&](double z, double x, double y) {
    along_x += x * (z - mean);
    along_y += y * (z - mean);
    square += x * x;
  });
  forAll([&](double& z, double x, double y) { z -= mean + (along_x * x + along_y * y) / square; });
}

} // namespace

SquareArea squareOf(const MeasuredHeights& area, std::vector<std::string>& warnings) {
  if (!area.isArea()) throw Error("is a profile, not an area");
  const double step = std::min(area.step_x, area.step_y);
  const double width = static_cast<double>(area.columns - 1) * area.step_x,
               height = static_cast<double>(area.rows - 1) * area.step_y;
  const double sides = std::floor(std::min(width, height) / step * (1 + 1e-9)) + 1;
  if (sides > static_cast<double>(kMaxSide))
    throw Error("would have more than " + formatCount(kMaxSide) + " points a side, " +
                formatLength(step) + " apart: crop it, or export it with fewer points");
  const auto side = static_cast<std::size_t>(sides);
  const auto across = positionsAlong(area.columns, area.step_x, side, step),
             up = positionsAlong(area.rows, area.step_y, side, step);
  const std::string points = formatCount(area.columns) + " x " + formatCount(area.rows) + " points";
  if (std::abs(area.step_x - area.step_y) * static_cast<double>(side) > 0.5 * step)
    warnings.push_back("of " + points + " with steps of " + formatLength(area.step_x) + " and " +
                       formatLength(area.step_y) + " the square of " + formatCount(side) +
                       " points in the middle is fitted, linear between the wider ones");
  else if (area.columns != area.rows)
    warnings.push_back("of " + points + " the square of " + formatCount(side) +
                       " in the middle is fitted");

  std::vector<double> heights;
  heights.reserve(side * side);
  for (const PointsAbout& row : up)
    for (const PointsAbout& column : across) {
      const auto between = [&](std::size_t r) {
        const double* line = area.heights.data() + r * area.columns;
        return line[column.low] + column.share * (line[column.high] - line[column.low]);
      };
      const double low = between(row.low);
      heights.push_back(row.share > 0 ? low + row.share * (between(row.high) - low) : low);
    }
  level(heights, side);
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  SquareArea square;
  square.length = static_cast<double>(side) * step;
  square.height = *highest - *lowest;
  if (!(square.height > 1e-15)) throw Error("is as high everywhere, but for a slope");
  square.picture.width = square.picture.height = static_cast<int>(side);
  square.picture.channels = 1;
  square.picture.texel.reserve(heights.size());
  const double floor = *lowest;
  for (const double z : heights)
    square.picture.texel.push_back(static_cast<float>((z - floor) / square.height));
  return square;
}

} // namespace patina
