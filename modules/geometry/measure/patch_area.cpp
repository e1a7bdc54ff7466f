#include "geometry/measure/patch_area.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace patina {
namespace {

constexpr double kFirstCells = 500;    // along the mesh's longest side, for a first estimate
constexpr double kEnoughCells = 20000; // in the patch
constexpr int kMaxSplit = 8192;        // largest number of parts of an edge

// A face split n times has n (n + 1) / 2 cells that stand like it and n (n - 1) / 2 turned ones.
struct AreaCell {
  std::int32_t face = -1;
  int i = 0, j = 0; // steps towards corner 1 and corner 2
  bool turned = false;
};

class PatchFlood {
 public:
  PatchFlood(const TriangleMesh& mesh, const Adjacency& neighbours, double step,
             const std::function<double(const SurfacePoint&)>& cover)
      : mesh_(mesh), neighbours_(neighbours), step_(step), cover_(cover) {}

  double area = 0;
  std::size_t cells = 0;

  void run(const SurfacePoint& at) {
    const int n = splitOf(at.face).count;
    const double u = at.barycentric[1] * n, v = at.barycentric[2] * n;
    AreaCell first{at.face, std::clamp(static_cast<int>(u), 0, n - 1), 0, false};
    first.j = std::clamp(static_cast<int>(v), 0, n - 1 - first.i);
    visit(first);
    while (!open_.empty()) {
      const AreaCell cell = open_.back();
      open_.pop_back();
      spread(cell);
    }
  }

 private:
  struct Split {
    int count = 1;
    double cell_area = 0;
    std::vector<bool> seen;
  };

  Split& splitOf(std::int32_t face) {
    const auto [entry, is_new] = splits_.try_emplace(face);
    Split& split = entry->second;
    if (!is_new) return split;
    const auto f = static_cast<std::size_t>(face);
    const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c = mesh_.corner(f, 2);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    split.count = std::clamp(static_cast<int>(std::ceil(longest / step_)), 1, kMaxSplit);
    split.cell_area = 0.5 * (b - a).cross(c - a).norm() / split.count / split.count;
    split.seen.resize(2 * static_cast<std::size_t>(split.count) *
                      static_cast<std::size_t>(split.count));
    return split;
  }
  void visit(const AreaCell& cell) {
    Split& split = splitOf(cell.face);
    const std::size_t index =
        2 * (static_cast<std::size_t>(cell.j) * static_cast<std::size_t>(split.count) +
             static_cast<std::size_t>(cell.i)) +
        (cell.turned ? 1 : 0);
    if (split.seen[index]) return;
    split.seen[index] = true;
    const double third = cell.turned ? 2 / 3. : 1 / 3.;
    const double b1 = (cell.i + third) / split.count, b2 = (cell.j + third) / split.count;
    if (!(cover_({cell.face, Vec3(1 - b1 - b2, b1, b2)}) >= 0.5)) return;
    area += split.cell_area;
    ++cells;
    open_.push_back(cell);
  }
  void spread(const AreaCell& c) {
    const int n = splitOf(c.face).count;
    if (c.turned) {
      visit({c.face, c.i, c.j, false});
      visit({c.face, c.i + 1, c.j, false});
      visit({c.face, c.i, c.j + 1, false});
      return;
    }
    c.i + c.j < n - 1 ? visit({c.face, c.i, c.j, true}) : cross(c.face, 1, (c.j + 0.5) / n);
    c.j > 0 ? visit({c.face, c.i, c.j - 1, true}) : cross(c.face, 0, (c.i + 0.5) / n);
    c.i > 0 ? visit({c.face, c.i - 1, c.j, true}) : cross(c.face, 2, 1 - (c.j + 0.5) / n);
  }
  // Goes over an edge at `t` between its corners.
  void cross(std::int32_t face, int edge, double t) {
    const auto f = static_cast<std::size_t>(face);
    const std::int32_t next = neighbours_.face_neighbours[f][static_cast<std::size_t>(edge)];
    if (next < 0) return;
    const auto vertex = [&](std::int32_t of, int k) {
      return mesh_.triangles[static_cast<std::size_t>(of)][static_cast<std::size_t>(k % 3)];
    };
    const std::int32_t a = vertex(face, edge), b = vertex(face, edge + 1);
    const int n = splitOf(next).count;
    for (int k = 0; k < 3; ++k) {
      const bool back = vertex(next, k) == b && vertex(next, k + 1) == a;
      if (!back && !(vertex(next, k) == a && vertex(next, k + 1) == b)) continue;
      const int at = std::clamp(static_cast<int>((back ? 1 - t : t) * n), 0, n - 1);
      return visit(k == 0   ? AreaCell{next, at, 0, false}
                   : k == 1 ? AreaCell{next, n - 1 - at, at, false}
                            : AreaCell{next, 0, n - 1 - at, false});
    }
  }

  const TriangleMesh& mesh_;
  const Adjacency& neighbours_;
  double step_;
  const std::function<double(const SurfacePoint&)>& cover_;
  std::unordered_map<std::int32_t, Split> splits_;
  std::vector<AreaCell> open_;
};

} // namespace

double patchArea(const TriangleMesh& mesh, const Adjacency& neighbours, const SurfacePoint& at,
                 const std::function<double(const SurfacePoint&)>& cover) {
  double step = bounds(mesh).sizes().maxCoeff() / kFirstCells;
  for (int round = 0;; ++round) {
    PatchFlood flood(mesh, neighbours, step, cover);
    flood.run(at);
    if (flood.cells >= kEnoughCells || round == 2) return flood.area;
    step = flood.cells > 0 ? std::sqrt(flood.area / (2 * kEnoughCells)) : step / 30;
  }
}

} // namespace patina
