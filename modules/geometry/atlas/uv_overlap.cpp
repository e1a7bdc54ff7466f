#include "geometry/atlas/uv_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

#include <tbb/parallel_for.h>

#include "geometry/atlas/atlas_charts.h"

namespace patina {
namespace {

// An edge of a chart's boundary, on the chart's plane.
struct BorderEdge {
  std::int32_t from_vertex, to_vertex; // indices in the surface
  Vec2 from, to;                       // on the plane; the chart lies on the left
  std::int32_t face;                   // index in the chart's list
};

// Two faces that overlap or may not share a chart.
struct ChartConflict {
  std::int32_t a, b;
};

constexpr int kReach = 4;             // cells per clearance
constexpr double kMaxCells = 1 << 24; // A boundary far longer than wide gets larger cells.

struct Sample {
  Vec2 flat;
  Vec3 place;
  std::int32_t face, next; // next: next sample of the same cell
};

class Samples {
 public:
  Samples(const std::vector<BorderEdge>& border, double clearance) {
    for (const BorderEdge& edge : border) box_.extend(edge.from).extend(edge.to);
    cell_ = std::max(clearance / kReach, box_.sizes().maxCoeff() / 16384);
    cell_ = std::max(cell_, std::sqrt(box_.sizes().prod() / kMaxCells));
    columns_ = static_cast<int>(box_.sizes()[0] / cell_) + 1;
    rows_ = static_cast<int>(box_.sizes()[1] / cell_) + 1;
    heads_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone);
  }

  double spacing() const { return cell_; }

  // Adds a sample unless its cell has one at that position: the cells bound the count.
  void add(const Vec2& flat, const Vec3& place, std::int32_t face) {
    std::int32_t& head = heads_[cellAt(column(flat), row(flat))];
    for (std::int32_t s = head; s != kNone; s = at(s).next)
      if ((at(s).place - place).squaredNorm() < cell_ * cell_ / 4) return;
    samples_.push_back({flat, place, face, head});
    head = static_cast<std::int32_t>(samples_.size()) - 1;
  }

  template <class Visit> void forPairs(Visit visit) const {
    for (const Sample& sample : samples_) {
      const int x = column(sample.flat), y = row(sample.flat);
      for (int j = std::max(0, y - kReach); j <= std::min(rows_ - 1, y + kReach); ++j)
        for (int i = std::max(0, x - kReach); i <= std::min(columns_ - 1, x + kReach); ++i)
          for (std::int32_t s = heads_[cellAt(i, j)]; s != kNone; s = at(s).next)
            if (&at(s) < &sample) visit(sample, at(s));
    }
  }

 private:
  const Sample& at(std::int32_t s) const { return samples_[static_cast<std::size_t>(s)]; }
  std::size_t cellAt(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(i);
  }
  int column(const Vec2& p) const {
    return std::clamp(static_cast<int>((p[0] - box_.min()[0]) / cell_), 0, columns_ - 1);
  }
  int row(const Vec2& p) const {
    return std::clamp(static_cast<int>((p[1] - box_.min()[1]) / cell_), 0, rows_ - 1);
  }

  Eigen::AlignedBox2d box_;
  double cell_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> heads_;
  std::vector<Sample> samples_;
};

// Finds parts of the boundary within `clearance` on the plane but much farther apart in space, such
// as the turns of a spiral: a look-up at one would read paint of the other. Across a slit or round
// a corner both are close in space too. Samples every quarter of the clearance and returns the pair
// that is farthest apart.
std::optional<ChartConflict> findCloseBorders(const AtlasSurface& surface,
                                              const std::vector<BorderEdge>& border,
                                              double clearance) {
  Samples samples(border, clearance);
  for (const BorderEdge& edge : border) {
    const Vec3 &from = surface.positions[static_cast<std::size_t>(edge.from_vertex)],
               &to = surface.positions[static_cast<std::size_t>(edge.to_vertex)];
    const int steps = 1 + static_cast<int>((edge.to - edge.from).norm() / samples.spacing());
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      samples.add(edge.from + t * (edge.to - edge.from), from + t * (to - from), edge.face);
    }
  }
  std::optional<ChartConflict> worst;
  double furthest = 0;
  samples.forPairs([&](const Sample& a, const Sample& b) {
    const double flat = (a.flat - b.flat).norm(), apart = (a.place - b.place).norm();
    // A chart stretches by at most 2, so that distances along it are at most twice those on the
    // plane.
    const bool elsewhere = apart > 2 * flat + clearance / 2;
    if (flat > clearance || !elsewhere || apart <= furthest || a.face == b.face) return;
    furthest = apart;
    worst = ChartConflict{a.face, b.face};
  });
  return worst;
}

// A chart's faces, indexed as in its list.
struct FlatFace {
  std::array<Vec2, 3> corners;
  std::array<std::int32_t, 3> vertices;
  std::array<std::int32_t, 3> neighbours; // indices; -1 outside the chart
};

std::vector<FlatFace> flattened(const AtlasSurface& surface, const Chart& chart) {
  const ChartPlane plane(chart.normal);
  std::vector<std::int32_t> sorted = chart.faces;
  std::vector<std::int32_t> place(sorted.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[k] = static_cast<std::int32_t>(k);
  std::sort(place.begin(), place.end(), [&](std::int32_t a, std::int32_t b) {
    return chart.faces[index(a)] < chart.faces[index(b)];
  });
  std::sort(sorted.begin(), sorted.end());
  std::vector<FlatFace> flat(chart.faces.size());
  for (std::size_t k = 0; k < flat.size(); ++k) {
    const std::size_t f = index(chart.faces[k]);
    flat[k].vertices = surface.triangles[f];
    for (std::size_t c = 0; c < 3; ++c) {
      flat[k].corners[c] = plane(surface.positions[index(flat[k].vertices[c])]);
      const auto at = std::lower_bound(sorted.begin(), sorted.end(), surface.neighbours[f][c]);
      flat[k].neighbours[c] = at != sorted.end() && *at == surface.neighbours[f][c]
                                  ? place[static_cast<std::size_t>(at - sorted.begin())]
                                  : kNone;
    }
  }
  return flat;
}

// Tests interior vertices: two faces round a vertex may not both cross the ray to its right.
std::optional<ChartConflict> woundTwice(const std::vector<FlatFace>& flat,
                                        const std::vector<std::int32_t>& piece) {
  std::vector<std::pair<std::int32_t, std::int32_t>> crossings; // vertex, face
  for (const std::int32_t f : piece) {
    const FlatFace& face = flat[index(f)];
    for (std::size_t c = 0; c < 3; ++c) {
      const double y = face.corners[c][1];
      if (face.corners[(c + 1) % 3][1] < y && face.corners[(c + 2) % 3][1] >= y)
        crossings.emplace_back(face.vertices[c], f);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t k = 1; k < crossings.size(); ++k)
    if (crossings[k].first == crossings[k - 1].first)
      return ChartConflict{crossings[k - 1].second, crossings[k].second};
  return std::nullopt;
}

// Tests boundary vertices: an edge that leaves one may lie inside one face there only.
std::optional<ChartConflict> fannedTwice(const std::vector<FlatFace>& flat,
                                         const std::vector<std::int32_t>& piece,
                                         std::vector<BorderEdge> leaving) {
  constexpr double kParallel = 1e-12;
  std::sort(leaving.begin(), leaving.end(), [](const BorderEdge& a, const BorderEdge& b) {
    return std::tie(a.from_vertex, a.face) < std::tie(b.from_vertex, b.face);
  });
  const auto before = [](const BorderEdge& edge, std::int32_t v) { return edge.from_vertex < v; };
  for (const std::int32_t f : piece) {
    const FlatFace& face = flat[index(f)];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2 first = face.corners[(c + 1) % 3] - face.corners[c];
      const Vec2 last = face.corners[(c + 2) % 3] - face.corners[c];
      auto edge = std::lower_bound(leaving.begin(), leaving.end(), face.vertices[c], before);
      for (; edge != leaving.end() && edge->from_vertex == face.vertices[c]; ++edge) {
        if (edge->face == f) continue;
        const Vec2 along = edge->to - edge->from;
        const double from_first = cross(first, along), to_last = cross(along, last);
        const double length = along.norm();
        if (from_first > -kParallel * length * first.norm() &&
            to_last > kParallel * length * last.norm() &&
            (from_first > kParallel * length * first.norm() || first.dot(along) > 0))
          return ChartConflict{edge->face, f};
      }
    }
  }
  return std::nullopt;
}

// Returns -1, 0 or 1 if p is right of, on or left of an edge.
int sideOf(const BorderEdge& edge, const Vec2& p, double tolerance) {
  const Vec2 along = edge.to - edge.from;
  const double distance = cross(along, p - edge.from);
  const double least = tolerance * along.norm();
  return distance > least ? 1 : distance < -least ? -1 : 0;
}

bool within(const BorderEdge& edge, const Vec2& p, double tolerance) {
  const Vec2 along = edge.to - edge.from;
  const double at = along.dot(p - edge.from), length = along.norm();
  return at > tolerance * length && at < length * (length - tolerance);
}

// Returns true if the edges overlap, other than by touching from opposite sides.
bool edgesOverlap(const BorderEdge& a, const BorderEdge& b, double tolerance) {
  if (a.from_vertex == b.from_vertex || a.from_vertex == b.to_vertex ||
      a.to_vertex == b.from_vertex || a.to_vertex == b.to_vertex)
    return false;
  const int from_b = sideOf(a, b.from, tolerance), to_b = sideOf(a, b.to, tolerance);
  if (from_b * to_b > 0) return false;
  const int from_a = sideOf(b, a.from, tolerance), to_a = sideOf(b, a.to, tolerance);
  if (from_a * to_a > 0) return false;
  if (from_b * to_b < 0 && from_a * to_a < 0) return true;
  if (from_b == 0 && to_b == 0) { // collinear
    if ((a.to - a.from).dot(b.to - b.from) <= 0) return false;
    const Vec2 along = (a.to - a.from).normalized();
    const double overlap = std::min((a.to - a.from).norm(), along.dot(b.to - a.from)) -
                           std::max(0.0, along.dot(b.from - a.from));
    return overlap > tolerance;
  }
  const auto entersAt = [&](const BorderEdge& edge, const Vec2& touching, int at, int other) {
    return at == 0 && other > 0 && within(edge, touching, tolerance);
  };
  return entersAt(a, b.from, from_b, to_b) || entersAt(a, b.to, to_b, from_b) ||
         entersAt(b, a.from, from_a, to_a) || entersAt(b, a.to, to_a, from_a);
}

// Border edges, sorted into the cells of a grid that they cross.
class BorderGrid {
 public:
  explicit BorderGrid(const std::vector<BorderEdge>& border) : border_(border) {
    double length = 0;
    for (const BorderEdge& edge : border) {
      box_.extend(edge.from).extend(edge.to);
      length += (edge.to - edge.from).norm();
    }
    const double count = static_cast<double>(border.size());
    cell_ = std::max({length / count, box_.sizes().maxCoeff() / 4096,
                      std::sqrt(box_.sizes().prod() / (4 * count))});
    if (!(cell_ > 0)) cell_ = 1;
    columns_ = static_cast<std::size_t>(box_.sizes()[0] / cell_) + 1;
    const std::size_t rows = static_cast<std::size_t>(box_.sizes()[1] / cell_) + 1;
    offsets_.assign(columns_ * rows + 1, 0);
    for (const BorderEdge& edge : border)
      forCells(edge, [&](std::size_t cell) { ++offsets_[cell + 1]; });
    for (std::size_t k = 1; k < offsets_.size(); ++k) offsets_[k] += offsets_[k - 1];
    entries_.resize(offsets_.back());
    std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::size_t e = 0; e < border.size(); ++e)
      forCells(border[e],
               [&](std::size_t cell) { entries_[next[cell]++] = static_cast<std::int32_t>(e); });
  }

  double tolerance() const { return 1e-12 * box_.sizes().maxCoeff(); }

  // Calls `visit` for pairs in one cell until it returns false.
  template <class Visit> void forPairs(Visit visit) const {
    for (std::size_t cell = 0; cell + 1 < offsets_.size(); ++cell)
      for (std::size_t i = offsets_[cell]; i < offsets_[cell + 1]; ++i)
        for (std::size_t j = i + 1; j < offsets_[cell + 1]; ++j)
          if (!visit(border_[index(entries_[i])], border_[index(entries_[j])])) return;
  }

 private:
  template <class Visit> void forCells(const BorderEdge& edge, Visit visit) const {
    constexpr double kSlack = 1e-6; // cell sides; makes touching edges meet in a cell
    const Vec2 a = (edge.from - box_.min()) / cell_, b = (edge.to - box_.min()) / cell_;
    const std::size_t rows = (offsets_.size() - 1) / columns_;
    const auto clamped = [](double at, std::size_t count) {
      return std::min(static_cast<std::size_t>(std::max(at, 0.0)), count - 1);
    };
    const double low = std::min(a[1], b[1]) - kSlack, high = std::max(a[1], b[1]) + kSlack;
    for (std::size_t row = clamped(low, rows); row <= clamped(high, rows); ++row) {
      double from = std::min(a[0], b[0]), to = std::max(a[0], b[0]);
      if (std::abs(b[1] - a[1]) > kSlack) {
        const auto at = [&](double y) {
          return a[0] + std::clamp((y - a[1]) / (b[1] - a[1]), 0.0, 1.0) * (b[0] - a[0]);
        };
        const double x0 = at(static_cast<double>(row) - kSlack);
        const double x1 = at(static_cast<double>(row) + 1 + kSlack);
        from = std::min(x0, x1);
        to = std::max(x0, x1);
      }
      for (std::size_t column = clamped(from - kSlack, columns_);
           column <= clamped(to + kSlack, columns_); ++column)
        visit(row * columns_ + column);
    }
  }

  const std::vector<BorderEdge>& border_;
  Eigen::AlignedBox2d box_;
  double cell_ = 0;
  std::size_t columns_ = 0;
  std::vector<std::size_t> offsets_;
  std::vector<std::int32_t> entries_;
};

// Searches one piece: the faces with piece_of equal to that of piece[0].
std::optional<ChartConflict> findConflict(const AtlasSurface& surface,
                                          const std::vector<FlatFace>& flat,
                                          const std::vector<std::int32_t>& piece,
                                          const std::vector<std::int32_t>& piece_of,
                                          std::vector<std::int32_t>& rank, double clearance) {
  if (piece.size() < 2) return std::nullopt;
  const std::int32_t number = piece_of[index(piece[0])];
  if (const auto found = woundTwice(flat, piece)) return found;
  std::vector<BorderEdge> border;
  for (const std::int32_t f : piece) {
    const FlatFace& face = flat[index(f)];
    for (std::size_t e = 0; e < 3; ++e)
      if (face.neighbours[e] == kNone || piece_of[index(face.neighbours[e])] != number)
        border.push_back({face.vertices[e], face.vertices[(e + 1) % 3], face.corners[e],
                          face.corners[(e + 1) % 3], f});
  }
  if (border.empty()) return std::nullopt;
  if (const auto found = fannedTwice(flat, piece, border)) return found;

  // Chooses the pair farthest apart in the list: a cut between them halves a spiral.
  for (std::size_t k = 0; k < piece.size(); ++k)
    rank[index(piece[k])] = static_cast<std::int32_t>(k);
  const BorderGrid grid(border);
  std::optional<ChartConflict> widest;
  std::int32_t width = -1;
  std::size_t found = 0;
  grid.forPairs([&](const BorderEdge& a, const BorderEdge& b) {
    if (!edgesOverlap(a, b, grid.tolerance())) return true;
    const std::int32_t apart = std::abs(rank[index(a.face)] - rank[index(b.face)]);
    if (apart > width) {
      width = apart;
      widest = ChartConflict{a.face, b.face};
    }
    return ++found < 4 * border.size();
  });
  if (!widest && clearance > 0) return findCloseBorders(surface, border, clearance);
  return widest;
}

// Returns the faces at the ends of a long piece, unless a face is nearly as long as the piece.
std::optional<ChartConflict> endsOf(const std::vector<FlatFace>& flat,
                                    const std::vector<std::int32_t>& piece, double longest) {
  Eigen::AlignedBox2d box;
  Vec2 largest = Vec2::Zero();
  for (const std::int32_t f : piece) {
    Eigen::AlignedBox2d face;
    for (const Vec2& p : flat[index(f)].corners) face.extend(p);
    box.extend(face);
    largest = largest.cwiseMax(face.sizes());
  }
  int axis = 0;
  const double length = box.sizes().maxCoeff(&axis);
  if (length <= longest || largest[axis] > 0.6 * length) return std::nullopt;
  const auto middle = [&](std::int32_t f) {
    const auto& corners = flat[index(f)].corners;
    return corners[0][axis] + corners[1][axis] + corners[2][axis];
  };
  const auto [first, last] =
      std::minmax_element(piece.begin(), piece.end(),
                          [&](std::int32_t a, std::int32_t b) { return middle(a) < middle(b); });
  return ChartConflict{*first, *last};
}

// Splits a piece between two of its faces by the number of edge steps to each; the new pieces get
// the numbers `number` and number + 1.
std::array<std::vector<std::int32_t>, 2> cut(const std::vector<FlatFace>& flat,
                                             const std::vector<std::int32_t>& piece,
                                             const ChartConflict& between, std::int32_t number,
                                             std::vector<std::int32_t>& piece_of) {
  const std::int32_t old = piece_of[index(piece[0])];
  std::array<std::vector<std::int32_t>, 2> parts;
  std::vector<std::int32_t> queue;
  const auto take = [&](std::int32_t face, std::int32_t part) {
    piece_of[index(face)] = number + part;
    parts[index(part)].push_back(face);
    queue.push_back(face);
  };
  take(between.a, 0);
  take(between.b, 1);
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const std::int32_t next : flat[index(queue[k])].neighbours)
      if (next != kNone && piece_of[index(next)] == old)
        take(next, piece_of[index(queue[k])] - number);
  return parts;
}

} // namespace

ChartPlane::ChartPlane(const Vec3& normal) {
  // Axis of the smallest component: for a normal along an axis, e1 and e2 are axes too.
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  e1 = Vec3::Unit(least).cross(normal).normalized();
  e2 = normal.cross(e1);
}

std::vector<Chart> embeddedPieces(const AtlasSurface& surface, Chart chart,
                                  const ChartLimits& limits) {
  const std::vector<FlatFace> flat = flattened(surface, chart);
  std::vector<std::int32_t> piece_of(flat.size(), 0);
  std::vector<std::int32_t> whole(flat.size());
  for (std::size_t k = 0; k < whole.size(); ++k) whole[k] = static_cast<std::int32_t>(k);
  std::vector<std::int32_t> rank(flat.size()); // index of each face in its piece
  std::vector<std::vector<std::int32_t>> open = {std::move(whole)};
  std::vector<Chart> pieces;
  std::int32_t next_number = 1;
  while (!open.empty()) {
    const std::vector<std::int32_t> piece = std::move(open.back());
    open.pop_back();
    std::optional<ChartConflict> found =
        findConflict(surface, flat, piece, piece_of, rank, limits.clearance);
    if (!found) found = endsOf(flat, piece, limits.longest);
    if (!found) {
      if (piece.size() == flat.size()) return {std::move(chart)};
      Chart part{{}, chart.normal};
      for (const std::int32_t f : piece) part.faces.push_back(chart.faces[index(f)]);
      pieces.push_back(std::move(part));
      continue;
    }
    for (auto& part : cut(flat, piece, *found, next_number, piece_of))
      open.push_back(std::move(part));
    next_number += 2;
  }
  return pieces;
}

namespace {

using Corners = std::array<Vec2, 3>;
using Faces = std::vector<std::int32_t>;
using Box2 = Eigen::AlignedBox2d;

constexpr std::size_t kLeafFaces = 16;   // smaller cells compare all pairs
constexpr std::size_t kTaskFaces = 4096; // a cell with more faces searches its quarters in parallel

Corners counterClockwise(Corners uv) {
  if (cross(uv[1] - uv[0], uv[2] - uv[0]) < 0) std::swap(uv[1], uv[2]);
  return uv;
}

bool isNarrow(const Corners& uv) {
  const double doubled_area = cross(uv[1] - uv[0], uv[2] - uv[0]);
  const double longest2 = std::max({(uv[1] - uv[0]).squaredNorm(), (uv[2] - uv[1]).squaredNorm(),
                                    (uv[0] - uv[2]).squaredNorm()});
  return !(doubled_area > kUvResolution * std::sqrt(longest2));
}

// Returns true if an edge has no point more than `margin` left of it. The face is
// counter-clockwise.
template <class Points> bool isParted(const Corners& face, const Points& points, double margin) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 along = face[(k + 1) % 3] - face[k];
    const double limit = margin > 0 ? margin * along.norm() : 0;
    if (std::all_of(points.begin(), points.end(),
                    [&](const Vec2& p) { return cross(along, p - face[k]) <= limit; }))
      return true;
  }
  return false;
}

Box2 boxOf(const Corners& uv) {
  return Box2(uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]), uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]));
}

bool overlap(const Corners& a, const Corners& b) {
  const Box2 box_a = boxOf(a), box_b = boxOf(b);
  const Vec2 common = box_a.max().cwiseMin(box_b.max()) - box_a.min().cwiseMax(box_b.min());
  return common.minCoeff() > kUvResolution && !isParted(a, b, kUvResolution) &&
         !isParted(b, a, kUvResolution);
}

std::array<Vec2, 4> cornersOf(const Box2& cell) {
  return {cell.min(), Vec2(cell.max()[0], cell.min()[1]), cell.max(),
          Vec2(cell.min()[0], cell.max()[1])};
}

bool covers(const Corners& face, const std::array<Vec2, 4>& cell) {
  for (std::size_t k = 0; k < 3; ++k)
    for (const Vec2& p : cell)
      if (cross(face[(k + 1) % 3] - face[k], p - face[k]) < 0) return false;
  return true;
}

class Search {
 public:
  explicit Search(const CornerUvs& uvs) : corners_(uvs.size()) {
    tbb::parallel_for(std::size_t{0}, uvs.size(),
                      [&](std::size_t f) { corners_[f] = counterClockwise(uvs[f]); });
  }

  std::optional<UvOverlap> run() const {
    Faces faces;
    for (std::size_t f = 0; f < corners_.size(); ++f)
      if (!isNarrow(corners_[f])) faces.push_back(static_cast<std::int32_t>(f));
    return in(Box2(Vec2::Zero().eval(), Vec2::Ones().eval()), faces);
  }

 private:
  struct Quarter {
    Box2 cell;
    Faces faces;
    std::optional<UvOverlap> found;
  };

  std::optional<UvOverlap> in(const Box2& cell, const Faces& faces) const {
    // If many faces overlap, the first few do.
    if (auto found = amongFirst(faces); found || faces.size() <= kLeafFaces) return found;
    if (cell.sizes()[0] <= kUvResolution) return std::nullopt;
    if (const auto hub = hubOf(faces)) return inFan(*hub, faces);
    std::array<Quarter, 4> quarters;
    const auto forQuarters = [&](const auto& visit) {
      if (faces.size() > kTaskFaces)
        tbb::parallel_for(std::size_t{0}, quarters.size(), visit);
      else
        for (std::size_t q = 0; q < quarters.size(); ++q) visit(q);
    };
    const auto firstFound = [&]() -> std::optional<UvOverlap> {
      for (const Quarter& quarter : quarters)
        if (quarter.found) return quarter.found;
      return std::nullopt;
    };
    forQuarters([&](std::size_t q) { quarters[q] = quarterOf(cell, faces, q); });
    if (const auto found = firstFound()) return found;
    forQuarters(
        [&](std::size_t q) { quarters[q].found = in(quarters[q].cell, quarters[q].faces); });
    return firstFound();
  }

  Quarter quarterOf(const Box2& whole, const Faces& faces, std::size_t quarter) const {
    const Vec2 low(quarter & 1 ? whole.center()[0] : whole.min()[0],
                   quarter & 2 ? whole.center()[1] : whole.min()[1]);
    Quarter result{Box2(low, (low + whole.sizes() / 2).eval()), {}, std::nullopt};
    const std::array<Vec2, 4> corners = cornersOf(result.cell);
    std::int32_t cover = kNone;
    for (const std::int32_t f : faces) {
      const Corners& face = corners_[index(f)];
      if (!boxOf(face).intersects(result.cell) || isParted(face, corners, 0)) continue;
      result.faces.push_back(f);
      if (!covers(face, corners)) continue;
      // Two faces that cover the whole cell would both enter all quarters without end.
      if (cover != kNone && overlap(corners_[index(cover)], face)) {
        result.found = UvOverlap{cover, f};
        break;
      }
      cover = f;
    }
    return result;
  }

  // Returns the corner that all faces share, if there is one.
  std::optional<Vec2> hubOf(const Faces& faces) const {
    for (const Vec2& hub : corners_[index(faces[0])])
      if (std::all_of(faces.begin(), faces.end(), [&](std::int32_t f) {
            const Corners& uv = corners_[index(f)];
            return uv[0] == hub || uv[1] == hub || uv[2] == hub;
          }))
        return hub;
    return std::nullopt;
  }

  // Searches faces round a hub, sorted by the angle of their first edge: a face overlaps the next
  // faces that begin before it ends, or none.
  std::optional<UvOverlap> inFan(const Vec2& hub, const Faces& faces) const {
    constexpr double kTurn = 2 * std::numbers::pi;
    struct Sector {
      double from, to;
      std::int32_t face;
    };
    std::vector<Sector> sectors;
    for (const std::int32_t f : faces) {
      const Corners& uv = corners_[index(f)];
      const std::size_t k = uv[0] == hub ? 0 : uv[1] == hub ? 1 : 2;
      const Vec2 first = uv[(k + 1) % 3] - hub, last = uv[(k + 2) % 3] - hub;
      const double from = std::atan2(first[1], first[0]);
      const double to = from + std::atan2(cross(first, last), first.dot(last));
      sectors.push_back({from, to, f});
      sectors.push_back({from + kTurn, to + kTurn, f}); // repeated after a full turn
    }
    std::sort(sectors.begin(), sectors.end(), [](const Sector& a, const Sector& b) {
      return std::tie(a.from, a.face) < std::tie(b.from, b.face);
    });
    for (std::size_t i = 0; i < sectors.size(); ++i)
      for (std::size_t j = i + 1; j < sectors.size() && sectors[j].from < sectors[i].to; ++j) {
        const std::int32_t a = sectors[i].face, b = sectors[j].face;
        if (overlap(corners_[index(a)], corners_[index(b)]))
          return UvOverlap{std::min(a, b), std::max(a, b)};
      }
    return std::nullopt;
  }

  std::optional<UvOverlap> amongFirst(const Faces& faces) const {
    const std::size_t count = std::min(faces.size(), kLeafFaces);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        if (overlap(corners_[index(faces[i])], corners_[index(faces[j])]))
          return UvOverlap{faces[i], faces[j]};
    return std::nullopt;
  }

  std::vector<Corners> corners_; // counter-clockwise
};

} // namespace

std::optional<UvOverlap> findUvOverlap(const CornerUvs& uvs) {
  return Search(uvs).run();
}

} // namespace patina
