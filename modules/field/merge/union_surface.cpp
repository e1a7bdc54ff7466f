#include "field/merge/union_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "field/construction/thickened_sheet.h"
#include "geometry/mesh/combined_mesh.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

using Corners = std::array<Vec3, 3>; // in grid coordinates of the lattice
using Pieces = std::vector<Corners>;

constexpr double kLargestPiece = 1; // [voxel]
// phi is 1-Lipschitz, but values interpolated between nodes are not exact.
constexpr double kAllowance = 0.5; // [voxel]

Box3 boxOf(const FieldPart& part) {
  const BlockBox blocks = part.blocks();
  Box3 box;
  box.min() = kBlockSide * Vec3(blocks.low[0], blocks.low[1], blocks.low[2]);
  box.max() = kBlockSide * Vec3(blocks.high[0], blocks.high[1], blocks.high[2]);
  return box;
}

Vec3 between(const Vec3& a, double fa, const Vec3& b, double fb) {
  return a + fa / (fa - fb) * (b - a);
}

// Returns the pieces of a small triangle with f >= 0, for f linear between the corners.
void cut(const Corners& t, const std::array<double, 3>& f, Pieces& left) {
  std::array<Vec3, 4> polygon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (f[i] >= 0) polygon[count++] = t[i];
    if ((f[i] >= 0) != (f[next] >= 0)) polygon[count++] = between(t[i], f[i], t[next], f[next]);
  }
  for (std::size_t i = 2; i < count; ++i) left.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

void outsideOf(const FieldPart& part, const NodeReader& nodes, const Corners& triangle,
               Pieces& left) {
  Pieces todo{triangle};
  while (!todo.empty()) {
    const Corners t = todo.back();
    todo.pop_back();
    std::size_t longest = 0;
    double length = 0;
    std::array<double, 3> f{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (t[(i + 1) % 3] - t[i]).norm();
      if (side > length) {
        length = side;
        longest = i;
      }
      f[i] = phiOfPart(part, nodes, t[i]) + kHiddenFrom;
    }
    const auto [least, most] = std::minmax({f[0], f[1], f[2]});
    if (most > length + kAllowance) {
      left.push_back(t);
    } else if (length <= kLargestPiece) {
      cut(t, f, left);
    } else if (!(least < -length - kAllowance)) {
      const Vec3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
      const Vec3 middle = 0.5 * (a + b);
      todo.push_back({a, middle, c});
      todo.push_back({middle, b, c});
    }
  }
}

// Collects the pieces of each mesh that no other part hides.
class VisibleTriangles {
 public:
  VisibleTriangles(std::span<const FieldPart> parts, const BlockLattice& lattice,
                   const Progress& progress)
      : parts_(parts), nodes_(nodesOf(parts)), lattice_(lattice), progress_(progress) {
    for (const FieldPart& part : parts) boxes_.push_back(boxOf(part));
  }

  // faceOf(triangle of the mesh) is its face in the combined mesh.
  template <class FaceOf> void add(const TriangleMesh& mesh, const FaceOf& faceOf) {
    const std::vector<std::int32_t> usable = usableTriangles(mesh);
    std::vector<Pieces> visible(usable.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, usable.size(), 256),
                      [&](const auto& range) {
                        if (progress_.cancelled()) return;
                        for (std::size_t i = range.begin(); i < range.end(); ++i)
                          visible[i] = visibleOf(mesh, usable[i], faceOf(usable[i]));
                      });
    progress_.throwIfCancelled();
    for (std::size_t i = 0; i < usable.size(); ++i)
      for (const Corners& piece : visible[i]) {
        const auto first = static_cast<std::int32_t>(surface.mesh.positions.size());
        for (const Vec3& q : piece)
          surface.mesh.positions.push_back(lattice_.anchor + lattice_.voxel * q);
        surface.mesh.triangles.push_back({first, first + 1, first + 2});
        surface.face.push_back(faceOf(usable[i]));
      }
  }

  UnionSurface surface;

 private:
  Pieces visibleOf(const TriangleMesh& mesh, std::int32_t triangle, std::int32_t face) const {
    const auto owner = static_cast<std::size_t>(objectOfFace(parts_, face, &FieldPart::first_face));
    Corners t;
    Box3 box;
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = mesh.corner(static_cast<std::size_t>(triangle), c);
      t[static_cast<std::size_t>(c)] = (p - lattice_.anchor) / lattice_.voxel;
      box.extend(t[static_cast<std::size_t>(c)]);
    }
    Pieces visible{t};
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (p == owner || !boxes_[p].intersects(box)) continue;
      Pieces left;
      for (const Corners& piece : visible) outsideOf(parts_[p], nodes_[p], piece, left);
      visible = std::move(left);
    }
    return visible;
  }

  std::span<const FieldPart> parts_;
  const std::deque<NodeReader> nodes_;
  const BlockLattice& lattice_;
  const Progress& progress_;
  std::vector<Box3> boxes_;
};

} // namespace

std::deque<NodeReader> nodesOf(std::span<const FieldPart> parts) {
  std::deque<NodeReader> nodes;
  for (const FieldPart& part : parts) nodes.emplace_back(*part.field);
  return nodes;
}

bool isHidden(std::span<const FieldPart> parts, const std::deque<NodeReader>& nodes,
              std::int32_t owner, const Vec3& q) {
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (static_cast<std::int32_t>(p) != owner && phiOfPart(parts[p], nodes[p], q) < -kHiddenFrom)
      return true;
  return false;
}

UnionSurface unionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                          const TriangleMesh& joint, const Progress& progress) {
  VisibleTriangles visible(parts, lattice, progress);
  visible.add(joint, [](std::int32_t triangle) { return triangle; });
  return std::move(visible.surface);
}

UnionSurface closedUnionSurface(std::span<const FieldPart> parts, const BlockLattice& lattice,
                                const TriangleMesh& joint, const Progress& progress) {
  VisibleTriangles visible(parts, lattice, progress);
  visible.add(joint, [](std::int32_t triangle) { return triangle; });
  for (const FieldPart& part : parts)
    if (part.caps)
      visible.add(part.caps->mesh, [&](std::int32_t triangle) {
        return part.first_face + part.caps->face[static_cast<std::size_t>(triangle)];
      });
  return std::move(visible.surface);
}

} // namespace patina
