#include "app/studies/contact/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

#include "geometry/mesh/mesh_report.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr double kOnFeature = 1e-10; // barycentric coordinate that counts as zero
constexpr double kSlack = 1e-12;     // tolerance of half-spaces [m]
constexpr double kSame = 1e-9;       // smaller steps count as none [m]
constexpr int kMaxSteps = 2000;      // usually a few; more around a deep tip, facet by facet

std::vector<Triangle> welded(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::int32_t> first;
  std::vector<std::int32_t> same(mesh.positions.size());
  for (std::size_t v = 0; v < same.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    same[v] =
        first.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, static_cast<std::int32_t>(v))
            .first->second;
  }
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles)
    for (std::int32_t& v : t) v = same[static_cast<std::size_t>(v)];
  return triangles;
}

std::uint64_t edgeKey(std::int32_t a, std::int32_t b) {
  if (a > b) std::swap(a, b);
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

// Mesh with the data for the sign of the distance.
struct SignedMesh {
  explicit SignedMesh(const TriangleMesh& mesh)
      : tree(mesh), triangles(welded(mesh)), vertex(mesh.positions.size(), Vec3::Zero()) {
    TriangleMesh whole = mesh;
    whole.triangles = triangles;
    closed = inspect(whole).watertight;
    face.resize(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      face[f] = faceNormal(mesh, f);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 at = mesh.corner(f, static_cast<int>(k));
        const Vec3 u = (mesh.corner(f, static_cast<int>((k + 1) % 3)) - at).normalized();
        const Vec3 v = (mesh.corner(f, static_cast<int>((k + 2) % 3)) - at).normalized();
        vertex[static_cast<std::size_t>(triangles[f][k])] +=
            std::atan2(u.cross(v).norm(), u.dot(v)) * face[f];
        edge.try_emplace(edgeKey(triangles[f][k], triangles[f][(k + 1) % 3]), Vec3::Zero())
            .first->second += face[f];
      }
    }
  }

  Vec3 pseudonormal(const SurfacePoint& at) const {
    const auto f = static_cast<std::size_t>(at.face);
    const Triangle& t = triangles[f];
    int zeros = 0, least = 0, most = 0;
    for (int k = 0; k < 3; ++k) {
      zeros += at.barycentric[k] <= kOnFeature;
      if (at.barycentric[k] < at.barycentric[least]) least = k;
      if (at.barycentric[k] > at.barycentric[most]) most = k;
    }
    const auto of = [&](int k) { return t[static_cast<std::size_t>(k % 3)]; };
    if (zeros == 0) return face[f];
    if (zeros == 1) return edge.at(edgeKey(of(least + 1), of(least + 2))).normalized();
    return vertex[static_cast<std::size_t>(of(most))].normalized();
  }

  ExactSurface::Nearest nearest(const Vec3& p) const {
    const ClosestPoint closest = tree.closestPoint(p);
    ExactSurface::Nearest result{closest.point, pseudonormal(closest.surface), closest.distance};
    if (closed && (p - closest.point).dot(result.outward) < 0) result.distance *= -1;
    // An open sheet pushes towards the side of the point.
    if (!closed && (p - closest.point).dot(result.outward) < 0) result.outward *= -1;
    return result;
  }

  TriangleTree tree;
  std::vector<Triangle> triangles; // with merged vertices
  std::vector<Vec3> face, vertex;  // normals, angle-weighted sums
  std::unordered_map<std::uint64_t, Vec3> edge;
  bool closed = false;
};

struct HalfSpace {
  Vec3 normal;       // unit
  double offset = 0; // normal . y >= offset
  double at(const Vec3& y) const { return normal.dot(y) - offset; }
};

// Projects x onto the intersection of up to three planes; false if a multiplier is negative.
bool ontoPlanes(std::span<const HalfSpace* const> planes, const Vec3& x, Vec3& z) {
  const auto n = static_cast<Eigen::Index>(planes.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, n);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> gap(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const HalfSpace& h = *planes[static_cast<std::size_t>(i)];
    normals.col(i) = h.normal;
    gap[i] = -h.at(x);
  }
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram =
      normals.transpose() * normals;
  if (gram.determinant() < 1e-10) return false;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> force = gram.inverse() * gap;
  if (force.minCoeff() < 0) return false;
  z = x + normals * force;
  return true;
}

// Projects x onto the intersection of half-spaces by an active-set method: the most violated one
// enters a basis of at most three. Each exchange increases the distance from x, so it terminates.
Vec3 projected(const std::vector<HalfSpace>& all, const Vec3& x) {
  std::array<const HalfSpace*, 4> basis{};
  std::size_t size = 0;
  Vec3 z = x;
  for (int exchange = 0; exchange < 200; ++exchange) {
    const HalfSpace* worst = nullptr;
    double least = -kSlack;
    for (const HalfSpace& h : all)
      if (const double l = h.at(z); l < least) {
        least = l;
        worst = &h;
      }
    if (!worst) return z;
    basis[size++] = worst;
    double best = std::numeric_limits<double>::infinity();
    std::array<const HalfSpace*, 4> chosen{};
    std::size_t chosen_size = 0;
    Vec3 best_point = z;
    for (unsigned mask = 1; mask < 1u << size; ++mask) {
      std::array<const HalfSpace*, 4> some{};
      std::size_t count = 0;
      for (std::size_t i = 0; i < size; ++i)
        if (mask >> i & 1) some[count++] = basis[i];
      Vec3 y;
      if (count > 3 || !ontoPlanes({some.data(), count}, x, y)) continue;
      if ((y - x).squaredNorm() >= best) continue;
      const bool inside = std::all_of(basis.begin(), basis.begin() + static_cast<long>(size),
                                      [&](const HalfSpace* h) { return h->at(y) >= -kSlack; });
      if (!inside) continue;
      best = (y - x).squaredNorm();
      chosen = some;
      chosen_size = count;
      best_point = y;
    }
    if (chosen_size == 0) return z; // nearly parallel: limited by rounding
    basis = chosen;
    size = chosen_size;
    z = best_point;
  }
  return z;
}

// The same within |z - centre| <= ball; the centre satisfies all half-spaces. A ball's multiplier
// moves x towards its centre.
Vec3 projectedInBall(const std::vector<HalfSpace>& all, const Vec3& x, const Vec3& centre,
                     double ball, bool& at_ball) {
  Vec3 z = projected(all, x);
  at_ball = (z - centre).squaredNorm() > ball * ball;
  if (!at_ball) return z;
  double low = 0, high = 1;
  Vec3 inside = centre;
  for (int i = 0; i < 60 && high - low > 1e-14; ++i) {
    const double t = 0.5 * (low + high);
    z = projected(all, centre + t * (x - centre));
    const double r = (z - centre).norm();
    if (r <= ball) {
      low = t;
      inside = z;
      if (r > ball - kSame) break;
    } else
      high = t;
  }
  return inside;
}

// Triangles that can obstruct a moving point.
class Obstacles {
 public:
  Obstacles(const ExactSurface& surface, double iso, const Vec3& centre, double ball)
      : iso_(iso), triangles_(surface.trianglesNear(centre, iso + ball + 1e-6)) {
    for (const Eigen::Matrix3d& t : triangles_)
      normals_.push_back((t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)).normalized());
    seen_.resize(triangles_.size());
  }

  double clearance(const Vec3& y) const { // distance - iso
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& t : triangles_)
      least = std::min(least, (closestOn(t, y) - y).squaredNorm());
    return std::sqrt(least) - iso_;
  }

  // Half-spaces about y, each of which keeps its triangles at distance iso. A triangle kept away by
  // an earlier one needs none. Its plane is perpendicular to the direction from the nearest point,
  // or the face's own (used first if y is clear of it), which lets y move farther along the face.
  enum class Prefer { faces, ways };
  const std::vector<HalfSpace>& halfSpaces(const Vec3& y, Prefer prefer) {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Vec3 closest = closestOn(triangles_[i], y);
      seen_[i] = {(closest - y).squaredNorm(), i, closest};
    }
    std::sort(seen_.begin(), seen_.end(),
              [](const Seen& a, const Seen& b) { return a.squared < b.squared; });
    spaces_.clear();
    for (const Seen& seen : seen_) {
      const Eigen::Matrix3d& t = triangles_[seen.index];
      const auto keeps = [&](const HalfSpace& h) {
        return (h.normal.transpose() * t).maxCoeff() <= h.offset - iso_ + kSlack;
      };
      if (std::any_of(spaces_.begin(), spaces_.end(), keeps)) continue;
      const double height = normals_[seen.index].dot(y - t.col(0));
      Vec3 normal = height < 0 ? Vec3(-normals_[seen.index]) : normals_[seen.index];
      if (prefer == Prefer::ways || std::abs(height) < iso_ - kSlack) {
        const double length = std::sqrt(seen.squared);
        if (length > 1e-12) normal = (y - seen.closest) / length;
      }
      spaces_.push_back({normal, (normal.transpose() * t).maxCoeff() + iso_});
    }
    return spaces_;
  }

 private:
  static Vec3 closestOn(const Eigen::Matrix3d& t, const Vec3& y) {
    return t * closestBarycentric(y, t.col(0), t.col(1), t.col(2));
  }
  struct Seen {
    double squared = 0;
    std::size_t index = 0;
    Vec3 closest = Vec3::Zero();
  };
  double iso_;
  std::vector<Eigen::Matrix3d> triangles_;
  std::vector<Vec3> normals_;
  std::vector<Seen> seen_;
  std::vector<HalfSpace> spaces_;
};

// Tries free points near c that are closer to the tip; returns c if there is none. They are nearer
// to c than iso, so no triangle lies between.
Vec3 nudged(const Obstacles& obstacles, double iso, const Vec3& c, const Vec3& tip,
            const Vec3& centre, double ball) {
  const double reach = std::min(0.5 * iso, 2e-6);
  Vec3 best = c;
  double least = (c - tip).squaredNorm() - 2e-2 * reach * (c - tip).norm();
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        if (i == 0 && j == 0 && k == 0) continue;
        const Vec3 y = c + reach * Vec3(i, j, k).normalized();
        if ((y - tip).squaredNorm() >= least || (y - centre).norm() > ball) continue;
        if (obstacles.clearance(y) < -1e-10) continue;
        best = y;
        least = (y - tip).squaredNorm();
      }
  return best;
}

} // namespace

struct ExactSurface::Impl {
  std::vector<TriangleMesh> meshes;
  std::vector<SignedMesh> signed_meshes;
};

ExactSurface::ExactSurface(std::vector<TriangleMesh> meshes) {
  auto impl = std::make_unique<Impl>();
  for (const TriangleMesh& mesh : meshes) impl->signed_meshes.emplace_back(mesh);
  impl->meshes = std::move(meshes);
  impl_ = std::move(impl);
}
ExactSurface::ExactSurface(ExactSurface&&) noexcept = default;
ExactSurface& ExactSurface::operator=(ExactSurface&&) noexcept = default;
ExactSurface::~ExactSurface() = default;

ExactSurface::Nearest ExactSurface::nearest(const Vec3& p) const {
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const SignedMesh& mesh : impl_->signed_meshes)
    if (const Nearest n = mesh.nearest(p); n.distance < best.distance) best = n;
  return best;
}

std::vector<Eigen::Matrix3d> ExactSurface::trianglesNear(const Vec3& centre, double radius) const {
  std::vector<Eigen::Matrix3d> near;
  for (std::size_t m = 0; m < impl_->meshes.size(); ++m)
    for (const std::int32_t f : impl_->signed_meshes[m].tree.facesInSphere(centre, radius)) {
      Eigen::Matrix3d& corners = near.emplace_back();
      for (int k = 0; k < 3; ++k)
        corners.col(k) = impl_->meshes[m].corner(static_cast<std::size_t>(f), k);
    }
  return near;
}

const std::vector<TriangleMesh>& ExactSurface::meshes() const {
  return impl_->meshes;
}
Box3 ExactSurface::bounds() const {
  Box3 box;
  for (const TriangleMesh& mesh : impl_->meshes) box.extend(patina::bounds(mesh));
  return box;
}

ProxyAnswer projectedOutside(const ExactSurface& surface, double iso, const Vec3& p) {
  iso = std::max(iso, kMinIso);
  ProxyAnswer answer{p, false, false, 0};
  std::vector<HalfSpace> walls;
  for (; answer.steps < 60; ++answer.steps) {
    const ExactSurface::Nearest near = surface.nearest(answer.point);
    if (near.distance >= iso - kSame) {
      answer.found = true;
      return answer;
    }
    const Vec3 way = answer.point - near.point;
    // Close to the surface this direction would be rounding.
    const Vec3 out =
        way.norm() > 1e-8 ? Vec3(way.normalized() * (near.distance < 0 ? -1 : 1)) : near.outward;
    // Old planes mislead at round or many-sided parts.
    if (answer.steps % 12 == 0) walls.clear();
    walls.push_back({out, out.dot(near.point) + iso});
    answer.point = answer.steps < 36 ? projected(walls, p) : Vec3(near.point + (iso + 1e-9) * out);
  }
  return answer;
}

ProxyAnswer proxyOracle(const ExactSurface& surface, double iso, const Vec3& tip, const Vec3& seed,
                        double ball) {
  iso = std::max(iso, kMinIso);
  ProxyAnswer answer = projectedOutside(surface, iso, seed);
  if (!answer.found) return answer;
  const Vec3 centre = answer.point;
  Obstacles obstacles(surface, iso, centre, ball);
  for (answer.steps = 0; answer.steps < kMaxSteps; ++answer.steps) {
    Vec3 next = answer.point;
    for (const auto prefer : {Obstacles::Prefer::faces, Obstacles::Prefer::ways}) {
      next = projectedInBall(obstacles.halfSpaces(answer.point, prefer), tip, centre, ball,
                             answer.at_ball);
      // The two kinds of planes would alternate for ever over gains within the tolerance.
      const double gain = (answer.point - tip).norm() - (next - tip).norm();
      if ((next - answer.point).norm() >= kSame && (gain > 1e-13 || answer.steps == 0)) break;
      next = answer.point;
    }
    if (next == answer.point) next = nudged(obstacles, iso, answer.point, tip, centre, ball);
    if (next == answer.point) break;
    answer.point = next;
  }
  return answer;
}

} // namespace patina
