#include "visualization/surfaces/refined_surface.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace patina {
namespace {

// Area of a piece over the square of the longest edge allowed: edges end between half of it and all
// of it.
constexpr double kPieceArea = 0.22;

struct Piece {
  Triangle corners;
  std::array<Vec2, 3> uv;
  std::array<Vec3, 3> normal;
};

struct Extent {
  double area, longest;
};

// Estimates the number of pieces. A sliver halved in length gives three equally thin ones.
double pieces(const std::vector<Extent>& extents, double max_edge) {
  constexpr double kSliver = 1.585; // log2 3
  double count = 0;
  for (const Extent& face : extents)
    count += std::max({1.0, face.area / (kPieceArea * max_edge * max_edge),
                       std::pow(face.longest / max_edge, kSliver)});
  return count;
}

class Refiner {
 public:
  Refiner(const TriangleMesh& mesh, double max_edge) : max_edge_(max_edge) {
    result_.mesh.positions = mesh.positions;
  }

  void add(const Piece& whole, std::int32_t face, bool with_uvs) {
    pieces_.assign(1, whole);
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      if (split(piece)) continue;
      result_.mesh.triangles.push_back(piece.corners);
      if (with_uvs) result_.mesh.corner_uvs.push_back(piece.uv);
      result_.normals.push_back(piece.normal);
      result_.parent.push_back(face);
    }
  }
  RefinedSurface take() { return std::move(result_); }

 private:
  // Depends only on the edge, so that both its faces decide equally.
  bool isLong(std::int32_t a, std::int32_t b) const { return (at(a) - at(b)).norm() > max_edge_; }
  const Vec3& at(std::int32_t vertex) const {
    return result_.mesh.positions[static_cast<std::size_t>(vertex)];
  }
  std::int32_t middle(std::int32_t a, std::int32_t b) {
    const auto low = static_cast<std::uint64_t>(std::min(a, b));
    const auto high = static_cast<std::uint64_t>(std::max(a, b));
    const auto [found, fresh] = middles_.try_emplace(
        high << 32 | low, static_cast<std::int32_t>(result_.mesh.positions.size()));
    if (fresh) result_.mesh.positions.push_back(0.5 * (at(a) + at(b)));
    return found->second;
  }

  // Bisects the longest of the edges that are too long (Rivara 1984), so that pieces stay compact.
  bool split(const Piece& piece) {
    std::size_t edge = 3;
    double longest = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::int32_t a = piece.corners[e], b = piece.corners[(e + 1) % 3];
      const double length = (at(a) - at(b)).squaredNorm();
      if (isLong(a, b) && length > longest) {
        longest = length;
        edge = e;
      }
    }
    if (edge == 3) return false;
    const std::size_t next = (edge + 1) % 3;
    const std::int32_t vertex = middle(piece.corners[edge], piece.corners[next]);
    const Vec2 uv = 0.5 * (piece.uv[edge] + piece.uv[next]);
    Piece first = piece, second = piece;
    first.corners[next] = second.corners[edge] = vertex;
    first.uv[next] = second.uv[edge] = uv;
    first.normal[next] = second.normal[edge] = 0.5 * (piece.normal[edge] + piece.normal[next]);
    pieces_.push_back(first);
    pieces_.push_back(second);
    return true;
  }

  double max_edge_;
  RefinedSurface result_;
  std::vector<Piece> pieces_;
  std::unordered_map<std::uint64_t, std::int32_t> middles_;
};

} // namespace

RefinedSurface refined(const TriangleMesh& mesh, double max_edge, std::size_t most) {
  if (!(max_edge > 0)) throw std::invalid_argument("refined: max_edge must be positive");
  std::vector<bool> usable(mesh.triangles.size());
  std::vector<Extent> extents;
  for (std::size_t f = 0; f < usable.size(); ++f) {
    const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    usable[f] = std::isfinite(area);
    if (usable[f])
      extents.push_back({area, std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()})});
  }
  const double limit = static_cast<double>(most + extents.size());
  while (pieces(extents, max_edge) > limit) max_edge *= 1.15;

  Refiner refiner(mesh, max_edge);
  const bool with_uvs = !mesh.corner_uvs.empty();
  const CornerNormals normals = smoothNormals(mesh);
  for (std::size_t f = 0; f < usable.size(); ++f)
    if (usable[f])
      refiner.add(
          {mesh.triangles[f], with_uvs ? mesh.corner_uvs[f] : std::array<Vec2, 3>{}, normals[f]},
          static_cast<std::int32_t>(f), with_uvs);
  return refiner.take();
}

} // namespace patina
