#include "geometry/atlas/chart_overlap.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/atlas/chart_border.h"

namespace patina {
namespace {

// A chart's faces by their places in its list.
struct FlatFace {
  std::array<Vec2, 3> corners;
  std::array<std::int32_t, 3> vertices;
  std::array<std::int32_t, 3> neighbours; // places; -1 outside the chart
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

// Interior of a piece: how often the faces round a vertex cross the ray to its right.
std::optional<Clash> woundTwice(const std::vector<FlatFace>& flat,
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
      return Clash{crossings[k - 1].second, crossings[k].second};
  return std::nullopt;
}

// At the border's vertices: the direction of an edge that leaves one lies in one face there only.
std::optional<Clash> fannedTwice(const std::vector<FlatFace>& flat,
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
          return Clash{edge->face, f};
      }
    }
  }
  return std::nullopt;
}

// -1, 0, 1 for right of, on and left of an edge.
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

// Edges that touch from opposite sides (vertices of one on an edge of the other) do not clash.
bool clash(const BorderEdge& a, const BorderEdge& b, double tolerance) {
  if (a.from_vertex == b.from_vertex || a.from_vertex == b.to_vertex ||
      a.to_vertex == b.from_vertex || a.to_vertex == b.to_vertex)
    return false;
  const int from_b = sideOf(a, b.from, tolerance), to_b = sideOf(a, b.to, tolerance);
  if (from_b * to_b > 0) return false;
  const int from_a = sideOf(b, a.from, tolerance), to_a = sideOf(b, a.to, tolerance);
  if (from_a * to_a > 0) return false;
  if (from_b * to_b < 0 && from_a * to_a < 0) return true;
  if (from_b == 0 && to_b == 0) { // on one line
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

// Border edges by the cells of a grid that they cross.
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

  // Pairs in one cell until `visit` has had enough and returns false.
  template <class Visit> void forPairs(Visit visit) const {
    for (std::size_t cell = 0; cell + 1 < offsets_.size(); ++cell)
      for (std::size_t i = offsets_[cell]; i < offsets_[cell + 1]; ++i)
        for (std::size_t j = i + 1; j < offsets_[cell + 1]; ++j)
          if (!visit(border_[index(entries_[i])], border_[index(entries_[j])])) return;
  }

 private:
  template <class Visit> void forCells(const BorderEdge& edge, Visit visit) const {
    constexpr double kSlack = 1e-6; // of a cell: touching edges meet in a cell
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

// `piece_of` tells which faces are in the piece: those with its number.
std::optional<Clash> clashIn(const AtlasSurface& surface, const std::vector<FlatFace>& flat,
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

  // Of many the one whose faces came furthest apart: the cut between them halves a spiral.
  for (std::size_t k = 0; k < piece.size(); ++k)
    rank[index(piece[k])] = static_cast<std::int32_t>(k);
  const BorderGrid grid(border);
  std::optional<Clash> widest;
  std::int32_t width = -1;
  std::size_t found = 0;
  grid.forPairs([&](const BorderEdge& a, const BorderEdge& b) {
    if (!clash(a, b, grid.tolerance())) return true;
    const std::int32_t apart = std::abs(rank[index(a.face)] - rank[index(b.face)]);
    if (apart > width) {
      width = apart;
      widest = Clash{a.face, b.face};
    }
    return ++found < 4 * border.size();
  });
  if (!widest && clearance > 0) return nearMiss(surface, border, clearance);
  return widest;
}

// The faces at a long piece's ends, unless a face is nearly as long as the piece.
std::optional<Clash> endsOf(const std::vector<FlatFace>& flat,
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
  return Clash{*first, *last};
}

// The faces of a piece that are nearer, in steps across edges, to one of two of its faces; the new
// pieces are numbered `number` and number + 1.
std::array<std::vector<std::int32_t>, 2> cut(const std::vector<FlatFace>& flat,
                                             const std::vector<std::int32_t>& piece,
                                             const Clash& between, std::int32_t number,
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
  // The axis that the normal has least of: for a normal along an axis, e1 and e2 are axes.
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
  std::vector<std::int32_t> rank(flat.size()); // in its piece, of each face
  std::vector<std::vector<std::int32_t>> open = {std::move(whole)};
  std::vector<Chart> pieces;
  std::int32_t next_number = 1;
  while (!open.empty()) {
    const std::vector<std::int32_t> piece = std::move(open.back());
    open.pop_back();
    std::optional<Clash> found = clashIn(surface, flat, piece, piece_of, rank, limits.clearance);
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

} // namespace patina
