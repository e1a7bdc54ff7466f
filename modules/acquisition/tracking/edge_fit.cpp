#include "acquisition/tracking/edge_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/tracking/lens.h"

namespace patina {
namespace {

constexpr double kStep = 0.5;      // step across an edge [px]
constexpr double kMinContrast = 8; // grey levels across an edge
constexpr double kReach = 3, kFarthestReach = 8,
                 // Search range on each side [px]; its largest value; the same in blurs.
    kBlurs = 2.5;

// Returns the systematic error [px] that averaging along an edge does not remove: pixels, and blur
// from the code's bits across the border. On rendered edges of six cameras and families the latter
// was .011 .027 .057 .105 .18 .33 px for a blur of .2 .25 .3 .35 .4 .5 of the border.
double systematic(double blur, double border) {
  const double share = blur / (0.4 * border);
  return 0.004 + 0.18 * std::pow(share, 4);
}

struct EdgeLine {
  Vec2 normal, middle, along;
  double scatter = 0;            // rms of the points about the line [px]
  double weight = 0, spread = 0; // sums of weights, and of weighted squared positions
  double blur = 0;               // [px]
  double floor = 0;              // systematic part of the deviation [px]

  // Returns the variance of the line's position at a point of it.
  double variance(const Vec2& point) const {
    const double t = along.dot(point - middle);
    return floor * floor + scatter * scatter * (1 / weight + t * t / spread);
  }
};

struct EdgePoint {
  double at = 0;   // position along the normal, at the middle of the slope
  double rise = 0; // across the whole edge [grey levels]
  double step = 0; // across the pixel at the middle [grey levels]
};

// Finds the edge along the normal within `reach` of the middle; nullopt without contrast.
std::optional<EdgePoint> edgeAlong(const GreyFrame& image, const Vec2& middle, const Vec2& normal,
                                   double reach) {
  const int steps = 2 * static_cast<int>(std::lround(reach / kStep));
  const double first = -0.5 * steps * kStep;
  double before = 0, sum = 0, moment = 0, step = 0;
  for (int i = 0; i <= steps; ++i) {
    const double d = first + i * kStep;
    const auto grey = greyAt(image, middle.x() + d * normal.x(), middle.y() + d * normal.y());
    if (!grey) return std::nullopt;
    if (i > 0) {
      if (2 * i == steps || 2 * i == steps + 2) step += *grey - before;
      sum += *grey - before;
      moment += (*grey - before) * (d - kStep / 2);
    }
    before = *grey;
  }
  if (sum < kMinContrast) return std::nullopt;
  const double at = moment / sum;
  return std::abs(at) <= reach ? std::optional(EdgePoint{at, sum, step}) : std::nullopt;
}

// Returns the deviation of the edge's Gaussian blur, without that of bilinear interpolation.
double blurOf(double rise, double step, double reach) {
  const double ratio = rise / std::max(step, 1e-3 * rise);
  const auto of = [](double distance, double sigma) {
    return std::erf(distance / (sigma * std::numbers::sqrt2));
  };
  double low = 0.3, high = 2 * reach;
  for (int i = 0; i < 12; ++i) {
    const double middle = std::sqrt(low * high);
    (of(reach, middle) < ratio * of(kStep, middle) ? low : high) = middle;
  }
  return std::sqrt(std::max(0.3, low * high - 1 / 6.));
}

// Robust line fit, insensitive to occluded parts of the edge.
std::optional<EdgeLine> lineOf(const std::vector<Vec2>& points, const Vec2& outwards) {
  std::vector<double> weights(points.size(), 1), sorted(points.size());
  EdgeLine line;
  for (int round = 0; round < 5; ++round) {
    double total = 0;
    Vec2 middle = Vec2::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      total += weights[i];
      middle += weights[i] * points[i];
    }
    if (total < 4) return std::nullopt;
    middle /= total;
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 p = points[i] - middle;
      xx += weights[i] * p.x() * p.x();
      xy += weights[i] * p.x() * p.y();
      yy += weights[i] * p.y() * p.y();
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    line.along = {std::cos(angle), std::sin(angle)};
    line.normal = {-line.along.y(), line.along.x()};
    if (line.normal.dot(outwards) < 0) line.normal = -line.normal;
    line.middle = middle;
    line.weight = total;
    line.spread = 0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy));
    const double least = std::max(0., 0.5 * (xx + yy - std::hypot(xx - yy, 2 * xy)));
    line.scatter = std::sqrt(least / std::max(1., total - 2));
    for (std::size_t i = 0; i < points.size(); ++i)
      sorted[i] = std::abs(line.normal.dot(points[i] - middle));
    const auto half = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), half, sorted.end());
    const double reach = 4.7 * std::max(0.03, 1.48 * *half);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double r = line.normal.dot(points[i] - middle) / reach;
      weights[i] = std::abs(r) < 1 ? (1 - r * r) * (1 - r * r) : 0;
    }
  }
  return line;
}

struct EdgePoints {
  std::vector<Vec2> place;
  double rise = 0, step = 0; // sums
};

// Returns points of the edge between two corners; `again` repeats the search about each of them.
EdgePoints edgePoints(const GreyFrame& image, const Vec2& from, const Vec2& to, double reach,
                      bool again) {
  EdgePoints points;
  const double length = (to - from).norm();
  const Vec2 along = (to - from) / length, normal(along.y(), -along.x());
  const double margin = std::min(0.2 * length, 1 + reach);
  const int count = std::max(5, static_cast<int>(length - 2 * margin));
  for (int i = 0; i < count; ++i) {
    const double t = margin + (length - 2 * margin) * (i + 0.5) / count;
    Vec2 place = from + t * along;
    auto at = edgeAlong(image, place, normal, reach);
    if (at && again) {
      place += at->at * normal;
      at = edgeAlong(image, place, normal, reach);
    }
    if (!at) continue;
    points.place.push_back(place + at->at * normal);
    points.rise += at->rise;
    points.step += at->step;
  }
  if (5 * points.place.size() < 2 * static_cast<std::size_t>(count)) points.place.clear();
  return points;
}

using Lines = std::array<EdgeLine, 4>; // corner i to the next

std::optional<Vec2> meeting(const EdgeLine& a, const EdgeLine& b) {
  const double sine = cross(a.along, b.along);
  if (std::abs(sine) < 0.03) return std::nullopt;
  return a.middle + cross(b.middle - a.middle, b.along) / sine * a.along;
}

std::optional<Lines> linesOf(const GreyFrame& image, const Quad& quad, const Camera* lens, int bits,
                             bool again, double max_reach = kReach) {
  Lines lines;
  std::array<double, 4> borders{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &from = quad[i], &to = quad[(i + 1) % 4];
    // Largest width of the black border across this side; the code's bits follow.
    const Vec2 along = (to - from).normalized(), normal(along.y(), -along.x());
    const double across = std::min(std::abs(normal.dot(quad[(i + 2) % 4] - to)),
                                   std::abs(normal.dot(quad[(i + 3) % 4] - from)));
    const double border = across / bits;
    const double reach = std::clamp(border / 2, 1., max_reach);
    EdgePoints points = edgePoints(image, from, to, reach, again);
    if (lens) {
      std::vector<Vec2> undistorted;
      for (const Vec2& point : points.place)
        if (const auto place = undistortedPoint(*lens, point)) undistorted.push_back(*place);
      points.place = std::move(undistorted);
    }
    const auto line = lineOf(points.place, normal);
    if (!line) return std::nullopt;
    lines[i] = *line;
    borders[i] = border;
    if (again) lines[i].blur = blurOf(points.rise, points.step, reach);
  }
  // The blur of a narrow border is not observable: the widest border's is its lower limit.
  const auto widest = std::max_element(borders.begin(), borders.end()) - borders.begin();
  const double blur = lines[static_cast<std::size_t>(widest)].blur;
  for (std::size_t i = 0; i < 4; ++i) {
    lines[i].blur = std::max(lines[i].blur, blur);
    lines[i].floor = systematic(lines[i].blur, borders[i]);
  }
  // A wider range is searched if this one cuts the edge on both sides.
  const double reach = std::min(kBlurs * blur, kFarthestReach);
  if (again && max_reach == kReach && reach > kReach &&
      borders[static_cast<std::size_t>(widest)] > 2 * kReach)
    return linesOf(image, quad, lens, bits, true, reach);
  return lines;
}

} // namespace

std::optional<FittedQuad> fitEdges(const GreyFrame& image, const Quad& quad, const Camera* lens,
                                   int bits) {
  Quad now = quad;
  for (int round = 0; round < 2; ++round) {
    const auto lines = linesOf(image, now, nullptr, bits, false);
    if (!lines) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = meeting((*lines)[(i + 3) % 4], (*lines)[i]);
      if (!corner || (*corner - quad[i]).squaredNorm() > 25) return std::nullopt;
      now[i] = *corner;
    }
  }
  const auto lines = linesOf(image, now, lens, bits, true);
  if (!lines) return std::nullopt;
  FittedQuad fitted;
  for (std::size_t i = 0; i < 4; ++i) {
    const EdgeLine &before = (*lines)[(i + 3) % 4], &after = (*lines)[i];
    const auto corner = meeting(before, after);
    if (!corner) return std::nullopt;
    FittedCorner& out = fitted.corner[i];
    out.undistorted = *corner;
    out.pixel = lens ? distortedPoint(*lens, *corner) : *corner;
    if ((out.pixel - now[i]).squaredNorm() > 4) return std::nullopt;
    out.whiten.row(0) = before.normal / std::sqrt(before.variance(*corner));
    out.whiten.row(1) = after.normal / std::sqrt(after.variance(*corner));
    fitted.roughness += after.scatter * after.scatter / 4;
  }
  fitted.roughness = std::sqrt(fitted.roughness);
  return fitted;
}

} // namespace patina
