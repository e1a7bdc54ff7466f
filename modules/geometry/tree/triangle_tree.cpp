#include "geometry/tree/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "geometry/tree/triangle_pieces.h"

namespace patina {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
// Padding suits coordinates near the mesh; farther points err relative to their distance.
constexpr double kBoxSlack = 1 + 4e-6;
// Squared distances closer than this are ties.
constexpr double kTie = 1 + 1e-11, kTieFloor = 1e-24;
constexpr std::size_t kStack = 7 * kMaxTreeDepth + 8;

struct Entry {
  float key;
  std::int32_t child;
};

// Fixed-size stack with the nearest child on top.
struct Stack {
  std::array<Entry, kStack> entries;
  std::size_t top = 0, base = 0;

  void beginNode() { base = top; }
  void push(float key, std::int32_t child) {
    std::size_t position = top++;
    while (position > base && entries[position - 1].key < key) {
      entries[position] = entries[position - 1];
      --position;
    }
    entries[position] = {key, child};
  }
};

// Computes squared distances of a node's boxes.
void boxDistances(const WideNode& node, const std::array<float, 3>& p, float* d2) {
  for (int i = 0; i < kWide; ++i) d2[i] = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kWide; ++i) {
      const float gap =
          std::max(std::abs(p[axis] - node.centre[axis][i]) - node.half[axis][i], 0.0f);
      d2[i] += gap * gap;
    }
  }
}

// Computes those of its boxes and cylinders; only these tell apart slivers that lie side by side.
void childDistances(const WideNode& node, const std::array<float, 3>& p, float* d2) {
  boxDistances(node, p, d2);
  for (int i = 0; i < kWide; ++i) {
    const float x = p[0] - node.centre[0][i], y = p[1] - node.centre[1][i],
                z = p[2] - node.centre[2][i];
    const float nx = node.normal[0][i], ny = node.normal[1][i], nz = node.normal[2][i];
    const float along = x * nx + y * ny + z * nz;
    const float ax = x - along * nx, ay = y - along * ny, az = z - along * nz;
    const float over = std::max(std::max(along - node.high[i], node.low[i] - along), 0.0f);
    const float out = std::max(std::sqrt(ax * ax + ay * ay + az * az) - node.radius[i], 0.0f);
    d2[i] = std::max(d2[i], (1 - 1e-5f) * (over * over + out * out));
  }
}

bool isEmpty(const WideNode& node, std::size_t slot) {
  return node.half[0][slot] < 0;
}

} // namespace

struct TriangleTree::Impl {
  Vec3 centre = Vec3::Zero();
  double unit = 1; // [m], half the longest side
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<CopiedFace> copies; // have no leaf: the first wins each tie
  std::vector<WideNode> nodes;
  std::int32_t first_leaf_node = 0; // first node with a block
  std::vector<PacketTriangle> leaves;
  std::vector<TriangleBlock> blocks;
  float mean_edge = 0; // mean of the leaves' longest edges

  Vec3 toTree(const Vec3& p) const { return (p - centre) / unit; }
  const Vec3& corner(std::int32_t face, std::size_t which) const {
    return positions[static_cast<std::size_t>(triangles[static_cast<std::size_t>(face)][which])];
  }
  std::int32_t faceOf(std::int32_t child) const {
    return leaves[static_cast<std::size_t>(~child)].face;
  }
  Vec3 at(std::int32_t face, const Vec3& w) const {
    return w[0] * corner(face, 0) + w[1] * corner(face, 1) + w[2] * corner(face, 2);
  }

  // Lowest of the nearest faces in a running search, in tree units.
  struct Nearest {
    double best = kInf; // squared
    double face_d2 = kInf;
    std::int32_t face = -1;
    Vec3 barycentric = Vec3::Zero();
    double limit() const { return best * kTie + kTieFloor; }
  };

  void tryFace(const Vec3& p, std::int32_t face, Nearest& nearest) const {
    const Vec3 w = closestBarycentric(p, corner(face, 0), corner(face, 1), corner(face, 2));
    const double d2 = (p - at(face, w)).squaredNorm();
    if (!(d2 <= nearest.limit())) return;
    nearest.best = std::min(nearest.best, d2);
    if (face >= nearest.face && nearest.face >= 0 && nearest.face_d2 <= nearest.limit()) return;
    nearest.face = face;
    nearest.face_d2 = d2;
    nearest.barycentric = w;
  }

  Nearest nearest(const Vec3& p, double max_d2, std::int32_t warm) const {
    Nearest result;
    result.best = max_d2;
    if (warm >= 0 && static_cast<std::size_t>(warm) < triangles.size()) tryFace(p, warm, result);
    if (!nearestAmongCandidates(p, result)) nearestByDescent(p, result);
    return result;
  }

  // Selects by float the few faces that double must compare. Returns false if they are too many, or
  // the point is too far for float.
  bool nearestAmongCandidates(const Vec3& p, Nearest& result) const {
    const double far = p.cwiseAbs().maxCoeff();
    if (far > 1e3) return false;
    PointJob job;
    job.nodes = nodes.data();
    job.first_leaf_node = first_leaf_node;
    job.blocks = blocks.data();
    job.triangles = leaves.data();
    job.corners = triangles.data()->data();
    job.positions = positions.data()->data();
    for (int i = 0; i < 3; ++i) job.point[i] = static_cast<float>(p[i]);
    const double slack = 2e-6 * (1 + far);
    job.reach = static_cast<float>(std::min(std::sqrt(result.best) * (1 + 1e-6), 1e6));
    job.slack = static_cast<float>(slack);
    trianglesNear(job);
    if (job.count < 0) return false;
    for (int i = 0; i < job.count; ++i) tryFace(p, job.face[i], result);
    return true;
  }

  void nearestByDescent(const Vec3& p, Nearest& result) const {
    const std::array<float, 3> f{static_cast<float>(p[0]), static_cast<float>(p[1]),
                                 static_cast<float>(p[2])};
    Stack stack;
    stack.push(0, 0);
    float limit = static_cast<float>(result.limit() * kBoxSlack);
    while (stack.top > 0) {
      const Entry entry = stack.entries[--stack.top];
      if (entry.key > limit) continue;
      if (entry.child < 0) {
        tryFace(p, faceOf(entry.child), result);
        limit = static_cast<float>(result.limit() * kBoxSlack);
        continue;
      }
      const WideNode& node = nodes[static_cast<std::size_t>(entry.child)];
      alignas(32) std::array<float, kWide> d2;
      childDistances(node, f, d2.data());
      stack.beginNode();
      for (std::size_t i = 0; i < kWide; ++i)
        if (d2[i] <= limit && !isEmpty(node, i)) stack.push(d2[i], node.child[i]);
    }
  }

  ClosestPoint answer(const Vec3& p, const Nearest& nearest) const {
    ClosestPoint closest;
    closest.surface = {nearest.face, nearest.barycentric};
    const Vec3 q = at(nearest.face, nearest.barycentric);
    closest.point = centre + unit * q;
    closest.distance = unit * (toTree(p) - q).norm();
    return closest;
  }
};

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  auto impl = std::make_unique<Impl>();
  if (mesh.triangles.empty()) throw std::invalid_argument("TriangleTree: the mesh has no triangle");
  Box3 box;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::int32_t v : triangle) {
      const Vec3& p = mesh.positions.at(static_cast<std::size_t>(v));
      if (!p.allFinite()) throw std::invalid_argument("TriangleTree: a corner is not finite");
      box.extend(p);
    }
  impl->centre = 0.5 * box.min() + 0.5 * box.max();
  const double half = 0.5 * box.sizes().maxCoeff();
  impl->unit = half > 0 ? half : 1.0;
  impl->triangles = mesh.triangles;
  impl->positions.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    impl->positions[i] = impl->toTree(mesh.positions[i]);

  impl->copies = findManyCopies(impl->positions, impl->triangles);
  TrianglePieces pieces = piecesOf(impl->positions, impl->triangles, impl->copies);
  impl->nodes = buildWideBvh(pieces.boxes);
  impl->first_leaf_node = partitionLeavesLast(impl->nodes);
  impl->leaves.resize(pieces.boxes.size());
  const auto faces = static_cast<std::int32_t>(impl->triangles.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pieces.boxes.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const std::int32_t id = pieces.boxes[i].id();
          if (id < faces) {
            impl->leaves[i] =
                packetTriangle(impl->corner(id, 0), impl->corner(id, 1), impl->corner(id, 2), id);
          } else {
            const auto extra = static_cast<std::size_t>(id - faces);
            const auto& [a, b, c] = pieces.corners[extra];
            impl->leaves[i] = packetTriangle(a, b, c, pieces.face[extra]);
          }
        }
      });
  fitCylinders(impl->nodes, impl->leaves);
  impl->blocks = triangleBlocks(impl->nodes, impl->first_leaf_node, impl->leaves);
  double edges = 0;
  for (const PacketTriangle& leaf : impl->leaves) edges += static_cast<double>(leaf.ab);
  impl->mean_edge = static_cast<float>(edges / static_cast<double>(impl->leaves.size()));
  impl_ = std::move(impl);
}

TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;
TriangleTree& TriangleTree::operator=(TriangleTree&&) noexcept = default;
TriangleTree::~TriangleTree() = default;

ClosestPoint TriangleTree::closestPoint(const Vec3& p, std::int32_t warm_face) const {
  const auto closest = closestPointWithin(p, kInf, warm_face);
  return closest ? *closest : ClosestPoint{{}, Vec3::Zero(), kInf};
}

std::optional<ClosestPoint> TriangleTree::closestPointWithin(const Vec3& p, double max_distance,
                                                             std::int32_t warm_face) const {
  if (!p.allFinite() || !(max_distance >= 0)) return std::nullopt;
  const double reach = max_distance / impl_->unit;
  const auto nearest = impl_->nearest(impl_->toTree(p), reach * reach, warm_face);
  if (nearest.face < 0) return std::nullopt;
  return impl_->answer(p, nearest);
}

std::vector<std::int32_t> TriangleTree::facesInSphere(const Vec3& centre, double radius) const {
  std::vector<std::int32_t> faces;
  if (!centre.allFinite() || !(radius >= 0)) return faces;
  const Vec3 p = impl_->toTree(centre);
  const double r2 = (radius / impl_->unit) * (radius / impl_->unit);
  const auto limit = static_cast<float>(r2 * kBoxSlack + kTieFloor);
  const std::array<float, 3> f{static_cast<float>(p[0]), static_cast<float>(p[1]),
                               static_cast<float>(p[2])};
  Stack stack;
  stack.push(0, 0);
  while (stack.top > 0) {
    const WideNode& node = impl_->nodes[static_cast<std::size_t>(stack.entries[--stack.top].child)];
    alignas(32) std::array<float, kWide> d2;
    boxDistances(node, f, d2.data());
    for (std::size_t i = 0; i < kWide; ++i) {
      if (!(d2[i] <= limit) || isEmpty(node, i)) continue;
      if (node.child[i] >= 0) {
        stack.beginNode();
        stack.push(0, node.child[i]);
        continue;
      }
      const std::int32_t face = impl_->faceOf(node.child[i]);
      const Vec3 w = closestBarycentric(p, impl_->corner(face, 0), impl_->corner(face, 1),
                                        impl_->corner(face, 2));
      if ((p - impl_->at(face, w)).squaredNorm() <= r2) faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  if (impl_->copies.empty()) return faces;
  for (std::size_t i = 0, found = faces.size(); i < found; ++i)
    for (auto copied =
             std::lower_bound(impl_->copies.begin(), impl_->copies.end(), CopiedFace{faces[i], 0});
         copied != impl_->copies.end() && copied->first == faces[i]; ++copied)
      faces.push_back(copied->copy);
  std::sort(faces.begin(), faces.end());
  return faces;
}

namespace {

// Ray in a sheared frame where it runs along +z (Woop, Benthin & Wald 2013). Neighbours share exact
// signs of the edge functions, so that no ray slips through a common edge.
struct ShearedRay {
  ShearedRay(const Vec3& origin_, const Vec3& direction) : origin(origin_) {
    direction.cwiseAbs().maxCoeff(&kz);
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    sx = direction[kx] / direction[kz];
    sy = direction[ky] / direction[kz];
    sz = 1 / direction[kz];
    for (int i = 0; i < 3; ++i)
      inverse[i] = 1 / (std::abs(direction[i]) > 1e-290 ? direction[i] : 1e-290);
  }
  Vec3 sheared(const Vec3& p) const {
    const Vec3 r = p - origin;
    return {r[kx] - sx * r[kz], r[ky] - sy * r[kz], sz * r[kz]};
  }
  // Returns false on a miss; t is in units of the direction's length.
  bool hits(const Vec3& pa, const Vec3& pb, const Vec3& pc, double& t, Vec3& w) const {
    const Vec3 a = sheared(pa), b = sheared(pb), c = sheared(pc);
    const double u = c[0] * b[1] - c[1] * b[0];
    const double v = a[0] * c[1] - a[1] * c[0];
    const double q = b[0] * a[1] - b[1] * a[0];
    if ((u < 0 || v < 0 || q < 0) && (u > 0 || v > 0 || q > 0)) return false;
    const double determinant = u + v + q;
    if (determinant == 0) return false;
    w = Vec3(u, v, q) / determinant;
    t = w[0] * a[2] + w[1] * b[2] + w[2] * c[2];
    return true;
  }

  Vec3 origin, inverse;
  int kx = 0, ky = 0, kz = 0;
  double sx = 0, sy = 0, sz = 0;
};

// Returns where the ray enters a child's box, or +infinity.
double entry(const WideNode& node, std::size_t slot, const ShearedRay& ray, double max_t) {
  double near = 0, far = max_t;
  for (int axis = 0; axis < 3; ++axis) {
    const double r = static_cast<double>(node.centre[axis][slot]) - ray.origin[axis];
    const double half = static_cast<double>(node.half[axis][slot]);
    const double t0 = (r - half) * ray.inverse[axis], t1 = (r + half) * ray.inverse[axis];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far * kTie ? near : kInf;
}

} // namespace

std::optional<RayHit> TriangleTree::firstHit(const Vec3& origin, const Vec3& direction,
                                             double max_t) const {
  const double length = direction.norm();
  if (!origin.allFinite() || !(length > 0) || !std::isfinite(length) || !(max_t >= 0))
    return std::nullopt;
  const ShearedRay ray(impl_->toTree(origin), direction / length);
  double limit = max_t / impl_->unit;
  RayHit best;
  Stack stack;
  stack.push(0, 0);
  while (stack.top > 0) {
    const Entry next = stack.entries[--stack.top];
    if (next.key > limit * kTie + 1e-12) continue;
    if (next.child < 0) {
      const std::int32_t face = impl_->faceOf(next.child);
      double t = 0;
      Vec3 w;
      if (!ray.hits(impl_->corner(face, 0), impl_->corner(face, 1), impl_->corner(face, 2), t, w))
        continue;
      if (t < 0 || t > limit + 1e-12) continue;
      const bool tie = best.surface.face >= 0 && std::abs(t - limit) <= 1e-12;
      if (best.surface.face < 0 ? t > limit : tie && face >= best.surface.face) continue;
      best = {{face, w}, t * impl_->unit};
      limit = std::min(limit, t);
      continue;
    }
    const WideNode& node = impl_->nodes[static_cast<std::size_t>(next.child)];
    stack.beginNode();
    for (std::size_t i = 0; i < kWide; ++i) {
      if (isEmpty(node, i)) continue;
      const double t = entry(node, i, ray, limit + 1e-12);
      if (t < kInf) stack.push(std::nextafter(static_cast<float>(t), 0.0f), node.child[i]);
    }
  }
  if (best.surface.face < 0) return std::nullopt;
  return best;
}

void TriangleTree::closestOnLattice(const Vec3& origin, double spacing, int side,
                                    double max_distance, std::span<float> distance,
                                    std::span<std::int32_t> face) const {
  const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) *
                     static_cast<std::size_t>(side);
  if (side < 2 || side % 2 != 0 || distance.size() != count || face.size() != count ||
      !origin.allFinite() || !(spacing > 0))
    throw std::invalid_argument("closestOnLattice: side must be even and the answers side^3");
  const Vec3 at = impl_->toTree(origin);
  const LatticeJob job{impl_->nodes.data(),
                       impl_->first_leaf_node,
                       impl_->blocks.data(),
                       impl_->leaves.data(),
                       impl_->mean_edge,
                       {at[0], at[1], at[2]},
                       spacing / impl_->unit,
                       side,
                       max_distance / impl_->unit,
                       face.data(),
                       distance.data()};
  patina::closestOnLattice(job);
  for (std::size_t i = 0; i < count; ++i) {
    distance[i] *= static_cast<float>(impl_->unit / spacing);
    if (face[i] >= 0) face[i] = impl_->leaves[static_cast<std::size_t>(face[i])].face;
  }
}

std::size_t TriangleTree::size() const {
  return impl_->triangles.size();
}

std::size_t TriangleTree::bytes() const {
  return sizeof(Impl) + impl_->positions.capacity() * sizeof(Vec3) +
         impl_->triangles.capacity() * sizeof(Triangle) +
         impl_->copies.capacity() * sizeof(CopiedFace) +
         impl_->nodes.capacity() * sizeof(WideNode) +
         impl_->leaves.capacity() * sizeof(PacketTriangle) +
         impl_->blocks.capacity() * sizeof(TriangleBlock);
}

} // namespace patina
