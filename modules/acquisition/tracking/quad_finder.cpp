#include "acquisition/tracking/quad_finder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace patina {
namespace {

constexpr int kTile = 4; // [px]

// 1 where the picture is dark, with a border of zeros one pixel wide.
struct DarkMap {
  int stride;
  std::vector<std::uint8_t> value;
};
constexpr std::uint8_t kTraced = 2; // the left side of the pixel was traced

struct Tiles {
  int columns, rows;
  std::vector<std::uint8_t> low, high;
};

Tiles tilesOf(const GreyFrame& image) {
  Tiles tiles{(image.width + kTile - 1) / kTile, (image.height + kTile - 1) / kTile, {}, {}};
  const std::size_t width = static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> low(width), high(width);
  for (int y = 0; y < image.height; y += kTile) {
    std::memcpy(low.data(), image.row(y), width);
    std::memcpy(high.data(), image.row(y), width);
    for (int more = y + 1; more < std::min(y + kTile, image.height); ++more) {
      const std::uint8_t* row = image.row(more);
      for (std::size_t x = 0; x < width; ++x) {
        low[x] = std::min(low[x], row[x]);
        high[x] = std::max(high[x], row[x]);
      }
    }
    for (std::size_t x = 0; x < width; x += kTile) {
      const std::size_t end = std::min(x + kTile, width);
      std::uint8_t least = low[x], most = high[x];
      for (std::size_t i = x + 1; i < end; ++i) {
        least = std::min(least, low[i]);
        most = std::max(most, high[i]);
      }
      tiles.low.push_back(least);
      tiles.high.push_back(most);
    }
  }
  return tiles;
}

// Returns the threshold of each tile, from its neighbourhood; 0 without contrast.
std::vector<std::uint8_t> thresholds(const Tiles& tiles, const QuadOptions& search) {
  std::vector<std::uint8_t> threshold(tiles.low.size());
  for (int y = 0; y < tiles.rows; ++y)
    for (int x = 0; x < tiles.columns; ++x) {
      std::uint8_t low = 255, high = 0;
      for (int v = std::max(0, y - 1); v < std::min(y + 2, tiles.rows); ++v)
        for (int u = std::max(0, x - 1); u < std::min(x + 2, tiles.columns); ++u) {
          const std::size_t i = index(v * tiles.columns + u);
          low = std::min(low, tiles.low[i]);
          high = std::max(high, tiles.high[i]);
        }
      if (high - low >= search.contrast)
        threshold[index(y * tiles.columns + x)] =
            static_cast<std::uint8_t>(std::ceil(low + search.threshold_fraction * (high - low)));
    }
  return threshold;
}

DarkMap darkMap(const GreyFrame& image, const QuadOptions& search) {
  const Tiles tiles = tilesOf(image);
  const std::vector<std::uint8_t> threshold = thresholds(tiles, search);
  DarkMap map{image.width + 2, {}};
  map.value.resize(index(map.stride) * index(image.height + 2) + 8); // eight bytes a read
  std::vector<std::uint8_t> line(index(tiles.columns * kTile));
  for (int y = 0; y < image.height; ++y) {
    if (y % kTile == 0)
      for (int x = 0; x < tiles.columns; ++x)
        std::memset(line.data() + x * kTile, threshold[index(y / kTile * tiles.columns + x)],
                    kTile);
    const std::uint8_t* row = image.row(y);
    std::uint8_t* dark = map.value.data() + index((y + 1) * map.stride + 1);
    for (int x = 0; x < image.width; ++x) dark[x] = row[x] < line[index(x)];
  }
  return map;
}

// Returns the noise of a pixel, a standard deviation [grey levels], from the median second
// difference in rows, which edges and slopes hardly change.
double pixelNoise(const GreyFrame& image) {
  std::array<std::size_t, 511> count{};
  std::size_t all = 0;
  for (int y = 0; y < image.height; y += 4) {
    const std::uint8_t* row = image.row(y);
    for (int x = 1; x + 1 < image.width; x += 4, ++all)
      ++count[index(std::abs(row[x - 1] - 2 * row[x] + row[x + 1]))];
  }
  std::size_t bend = 0;
  for (std::size_t below = count[0]; 2 * below < all; below += count[bend]) ++bend;
  return static_cast<double>(bend) / (0.6745 * std::sqrt(6.));
}

// Filters with a 3 x 3 mean, except at the picture's border.
GreyFrame meansOfNine(const GreyFrame& image) {
  GreyFrame out = image;
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<std::uint16_t> column(width);
  for (int y = 1; y + 1 < image.height; ++y) {
    const std::uint8_t *above = image.row(y - 1), *here = image.row(y), *below = image.row(y + 1);
    for (std::size_t x = 0; x < width; ++x)
      column[x] = static_cast<std::uint16_t>(above[x] + here[x] + below[x]);
    std::uint8_t* to = out.pixel.data() + static_cast<std::size_t>(y) * width;
    for (std::size_t x = 1; x + 1 < width; ++x)
      to[x] = static_cast<std::uint8_t>((column[x - 1] + column[x] + column[x + 1] + 4) / 9);
  }
  return out;
}

struct Point {
  int x, y;
};

// Pixel corners along a contour, dark on the right; twice the area, negative for holes.
struct Contour {
  std::vector<Point> points;
  std::int64_t area = 0;
};

// Traces a contour along the sides of its pixels, starting upwards along the left side of pixel
// (x, y). Dark pixels that only share a corner are separate.
void traceContour(DarkMap& map, int x, int y, Contour& contour) {
  static constexpr int kX[] = {0, 1, 0, -1}, kY[] = {-1, 0, 1, 0};
  std::uint8_t* const base = map.value.data();
  const int stride = map.stride;
  // Offsets of the pixels ahead on the left and on the right, for each direction.
  const int left[] = {-stride - 1, -stride, 0, -1}, right[] = {-stride, 0, -1, -stride - 1};
  contour.points.clear();
  contour.area = 0;
  int px = x, py = y + 1, way = 0;
  do {
    if (way == 0) base[(py - 1) * stride + px] |= kTraced;
    contour.points.push_back({px, py});
    const int nx = px + kX[way], ny = py + kY[way];
    contour.area += static_cast<std::int64_t>(px) * ny - static_cast<std::int64_t>(nx) * py;
    px = nx;
    py = ny;
    const std::uint8_t* at = base + py * stride + px;
    if (!(at[right[way]] & 1))
      way = (way + 1) % 4;
    else if (at[left[way]] & 1)
      way = (way + 3) % 4;
  } while (px != x || py != y + 1 || way != 0);
}

struct Line {
  Vec2 middle, direction;
};

std::optional<Vec2> crossing(const Line& a, const Line& b) {
  const double sine = cross(a.direction, b.direction);
  if (std::abs(sine) < 0.05) return std::nullopt;
  return a.middle + cross(b.middle - a.middle, b.direction) / sine * a.direction;
}

// Returns a contour's four corners if it is a quadrilateral, each a farthest point.
std::optional<std::array<std::size_t, 4>> cornersOf(const std::vector<Point>& points) {
  const auto farthest = [&](const auto& distance) {
    std::size_t best = 0;
    std::int64_t most = -1;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const std::int64_t d = distance(points[i]); d > most) {
        most = d;
        best = i;
      }
    return std::pair(best, most);
  };
  const auto side = [](const Point& a, const Point& b, const Point& p) {
    return static_cast<std::int64_t>(b.x - a.x) * (p.y - a.y) -
           static_cast<std::int64_t>(b.y - a.y) * (p.x - a.x);
  };
  const auto squared = [](const Point& a, const Point& b) {
    const std::int64_t dx = a.x - b.x, dy = a.y - b.y;
    return dx * dx + dy * dy;
  };
  std::array<std::size_t, 4> corner{};
  corner[0] = farthest([&](const Point& p) { return squared(p, points[0]); }).first;
  const Point a = points[corner[0]];
  corner[1] = farthest([&](const Point& p) { return squared(p, a); }).first;
  const Point b = points[corner[1]];
  corner[2] = farthest([&](const Point& p) { return std::abs(side(a, b, p)); }).first;
  Point p1 = b, p2 = points[corner[2]];
  if (side(a, p1, p2) < 0) std::swap(p1, p2);
  // Distance outside the triangle, whose inside is on the positive side of each edge.
  const auto [last, out] = farthest([&](const Point& p) {
    return -std::min({side(a, p1, p), side(p1, p2, p), side(p2, a, p)});
  });
  corner[3] = last;
  if (out < 8) return std::nullopt;
  std::sort(corner.begin(), corner.end());
  return corner;
}

// Fits a line to the middle part of a contour's side.
std::optional<Line> lineThrough(const std::vector<Point>& points, std::size_t from, std::size_t to,
                                double& misfit) {
  const std::size_t all = points.size(), count = (to + all - from) % all;
  const std::size_t skip = 1 + count / 10;
  if (count < 2 * skip + 4) return std::nullopt;
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const Point origin = points[from];
  for (std::size_t i = skip; i <= count - skip; ++i) {
    const Point& p = points[(from + i) % all];
    const double u = p.x - origin.x, v = p.y - origin.y;
    n += 1, x += u, y += v, xx += u * u, xy += u * v, yy += v * v;
  }
  x /= n, y /= n;
  xx = xx / n - x * x, xy = xy / n - x * y, yy = yy / n - y * y;
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const double least = 0.5 * (xx + yy - std::hypot(xx - yy, 2 * xy));
  misfit = std::sqrt(std::max(0., least));
  return Line{Vec2(origin.x + x, origin.y + y), Vec2(std::cos(angle), std::sin(angle))};
}

std::optional<Quad> quadOf(const Contour& contour, const QuadOptions& search) {
  const auto corner = cornersOf(contour.points);
  if (!corner) return std::nullopt;
  std::array<Line, 4> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t from = (*corner)[i], to = (*corner)[(i + 1) % 4];
    double misfit = 0;
    const auto line = lineThrough(contour.points, from, to, misfit);
    if (!line) return std::nullopt;
    const double dx = contour.points[to].x - contour.points[from].x,
                 dy = contour.points[to].y - contour.points[from].y;
    if (misfit > 0.7 + 0.03 * std::hypot(dx, dy)) return std::nullopt;
    lines[i] = *line;
  }
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto point = crossing(lines[(i + 3) % 4], lines[i]);
    if (!point) return std::nullopt;
    quad[i] = *point - Vec2(1.5, 1.5); // map border, and corner of a pixel
  }
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &p = quad[i], &q = quad[(i + 1) % 4], &r = quad[(i + 2) % 4];
    if ((q - p).norm() < search.shortest || cross(q - p, r - q) <= 0) return std::nullopt;
    area += cross(p, q);
  }
  const double walked = static_cast<double>(contour.area);
  return walked > 0.75 * area && walked < 1.3 * area ? std::optional(quad) : std::nullopt;
}

} // namespace

std::vector<Quad> findQuads(const GreyFrame& original, const QuadOptions& search) {
  // Thresholds see a range of about six deviations of pure noise, whose spots would all be traced.
  // The picture is smoothed first if this exceeds the contrast of a marker.
  // The unit is the deviation; this is an upper limit, so that no marker is lost.
  constexpr double kSpread = 7, kMaxContrast = 64;
  double noise = pixelNoise(original);
  GreyFrame means;
  if (kSpread * noise > kMaxContrast) {
    means = meansOfNine(original);
    noise /= 3;
  }
  const GreyFrame& image = means.pixel.empty() ? original : means;
  QuadOptions quieted = search;
  quieted.contrast =
      std::max(search.contrast, static_cast<int>(std::min(kMaxContrast, kSpread * noise)));
  DarkMap map = darkMap(image, quieted);
  std::vector<Quad> quads;
  Contour contour;
  const std::size_t least = static_cast<std::size_t>(4 * search.shortest);
  for (int y = 1; y <= image.height; ++y) {
    const std::uint8_t* row = map.value.data() + index(y * map.stride);
    for (int x = 1; x <= image.width; x += 8) {
      std::uint64_t here, before;
      std::memcpy(&here, row + x, 8);
      std::memcpy(&before, row + x - 1, 8);
      std::uint64_t starts = here & ~before & 0x0101010101010101u & ~(here >> 1);
      for (; starts; starts &= starts - 1) {
        const int at = x + std::countr_zero(starts) / 8;
        if (at > image.width) break;
        if (row[at] & kTraced) continue; // already traced
        traceContour(map, at, y, contour);
        const double n = static_cast<double>(contour.points.size());
        if (contour.points.size() < least || static_cast<double>(contour.area) < 0.02 * n * n)
          continue;
        if (const auto quad = quadOf(contour, search)) quads.push_back(*quad);
      }
    }
  }
  return quads;
}

} // namespace patina
