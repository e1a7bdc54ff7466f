#include "acquisition/tracking/edge_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/tracking/lens.h"

namespace patina {
namespace {

constexpr double kStep = 0.5;        // across an edge [px]
constexpr double kLeastContrast = 8; // grey levels across an edge
constexpr double kReach = 3, kFarthestReach = 8,
                 kBlurs = 2.5; // to either side of it [px]; in blurs

// What no averaging along an edge removes: pixels, and what is blurred into it from the bits on the
// other side of a border. Of rendered edges of six cameras and families the latter was, in pixels,
// .011 .027 .057 .105 .18 .33 where the blur was .2 .25 .3 .35 .4 .5 of the border.
double systematic(double blur, double border) {
  const double share = blur / (0.4 * border);
  return 0.004 + 0.18 * std::pow(share, 4);
}

struct EdgeLine {
  Vec2 normal, middle, along;
  double scatter = 0;            // of the points about it [px]
  double weight = 0, spread = 0; // sums of weights, and times squared places along it
  double blur = 0;               // [px]
  double floor = 0;              // of its deviation [px]

  // Of its place at a point of it.
  double variance(const Vec2& point) const {
    const double t = along.dot(point - middle);
    return floor * floor + scatter * scatter * (1 / weight + t * t / spread);
  }
};

struct EdgePoint {
  double at = 0;   // along the normal; the middle of the slopes
  double rise = 0; // from one end to the other [grey levels]
  double step = 0; // in the pixel about the middle [grey levels]
};

// Where along the normal, from -reach to reach about the middle, it gets bright. Nothing without
// contrast.
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
  if (sum < kLeastContrast) return std::nullopt;
  const double at = moment / sum;
  return std::abs(at) <= reach ? std::optional(EdgePoint{at, sum, step}) : std::nullopt;
}

// The deviation of a Gaussian that makes such an edge of a step, without what bilinear grey adds.
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

// Robust: what another thing covers does not pull the line.
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

// Places of the edge between two corners; `again` looks a second time about each one found.
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

using Lines = std::array<EdgeLine, 4>; // from corner i to the next

std::optional<Vec2> meeting(const EdgeLine& a, const EdgeLine& b) {
  const double sine = cross(a.along, b.along);
  if (std::abs(sine) < 0.03) return std::nullopt;
  return a.middle + cross(b.middle - a.middle, b.along) / sine * a.along;
}

std::optional<Lines> linesOf(const GreyFrame& image, const Quad& quad, const Camera* lens, int bits,
                             bool again, double most_reach = kReach) {
  Lines lines;
  std::array<double, 4> borders{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &from = quad[i], &to = quad[(i + 1) % 4];
    // How wide the black border is across this side, at most: beyond it are the code's bits.
    const Vec2 along = (to - from).normalized(), normal(along.y(), -along.x());
    const double across = std::min(std::abs(normal.dot(quad[(i + 2) % 4] - to)),
                                   std::abs(normal.dot(quad[(i + 3) % 4] - from)));
    const double border = across / bits;
    const double reach = std::clamp(border / 2, 1., most_reach);
    EdgePoints points = edgePoints(image, from, to, reach, again);
    if (lens) {
      std::vector<Vec2> straight;
      for (const Vec2& point : points.place)
        if (const auto place = straightened(*lens, point)) straight.push_back(*place);
      points.place = std::move(straight);
    }
    const auto line = lineOf(points.place, normal);
    if (!line) return std::nullopt;
    lines[i] = *line;
    borders[i] = border;
    if (again) lines[i].blur = blurOf(points.rise, points.step, reach);
  }
  // A narrow border does not show its blur: it has that of the widest at least.
  const auto widest = std::max_element(borders.begin(), borders.end()) - borders.begin();
  const double blur = lines[static_cast<std::size_t>(widest)].blur;
  for (std::size_t i = 0; i < 4; ++i) {
    lines[i].blur = std::max(lines[i].blur, blur);
    lines[i].floor = systematic(lines[i].blur, borders[i]);
  }
  // An edge that is cut off on both sides is seen nearer to where it was looked for.
  const double reach = std::min(kBlurs * blur, kFarthestReach);
  if (again && most_reach == kReach && reach > kReach &&
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
    out.straight = *corner;
    out.pixel = lens ? bentBack(*lens, *corner) : *corner;
    if ((out.pixel - now[i]).squaredNorm() > 4) return std::nullopt;
    out.whiten.row(0) = before.normal / std::sqrt(before.variance(*corner));
    out.whiten.row(1) = after.normal / std::sqrt(after.variance(*corner));
    fitted.roughness += after.scatter * after.scatter / 4;
  }
  fitted.roughness = std::sqrt(fitted.roughness);
  return fitted;
}

} // namespace patina
