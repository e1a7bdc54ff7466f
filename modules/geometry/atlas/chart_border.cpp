#include "geometry/atlas/chart_border.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr int kReach = 4;              // cells in the clearance
constexpr double kMostCells = 1 << 24; // beyond, cells grow: the border is far longer than wide

struct Sample {
  Vec2 flat;
  Vec3 place;
  std::int32_t face, next; // next: in its cell
};

class Samples {
 public:
  Samples(const std::vector<BorderEdge>& border, double clearance) {
    for (const BorderEdge& edge : border) box_.extend(edge.from).extend(edge.to);
    cell_ = std::max(clearance / kReach, box_.sizes().maxCoeff() / 16384);
    cell_ = std::max(cell_, std::sqrt(box_.sizes().prod() / kMostCells));
    columns_ = static_cast<int>(box_.sizes()[0] / cell_) + 1;
    rows_ = static_cast<int>(box_.sizes()[1] / cell_) + 1;
    heads_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone);
  }

  double spacing() const { return cell_; }

  // One of several at a place will do: the count is bounded by the cells, not by the border.
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

} // namespace

std::optional<Clash> nearMiss(const AtlasSurface& surface, const std::vector<BorderEdge>& border,
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
  std::optional<Clash> worst;
  double furthest = 0;
  samples.forPairs([&](const Sample& a, const Sample& b) {
    const double flat = (a.flat - b.flat).norm(), apart = (a.place - b.place).norm();
    // A chart stretches by 2 at most: along it, places come twice as far as on the plane.
    const bool elsewhere = apart > 2 * flat + clearance / 2;
    if (flat > clearance || !elsewhere || apart <= furthest || a.face == b.face) return;
    furthest = apart;
    worst = Clash{a.face, b.face};
  });
  return worst;
}

} // namespace patina
