#include "geometry/measure/fit_shape.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/decompose.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr double kCreaseCosine = 0.819; // 35°
constexpr int kFitRounds = 20;
// Largest radius over the size of the points; above it they lie in a plane.
constexpr double kMaxRelativeRadius = 1e3;

struct PointCloud {
  explicit PointCloud(const std::vector<Vec3>& points) {
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    for (const Vec3& p : points) size = std::max(size, (p - mean).norm());
  }
  Vec3 mean = Vec3::Zero();
  double size = 0;
};

} // namespace

MeshPatch patchAround(const TriangleMesh& mesh, const Adjacency& neighbours,
                      const SurfacePoint& point, double radius) {
  MeshPatch patch;
  const Vec3 centre = position(mesh, point);
  std::set<std::int32_t> seen{point.face}, vertices;
  patch.faces = {point.face};
  for (std::size_t i = 0; i < patch.faces.size(); ++i) {
    const auto face = static_cast<std::size_t>(patch.faces[i]);
    vertices.insert(mesh.triangles[face].begin(), mesh.triangles[face].end());
    for (const std::int32_t next : neighbours.face_neighbours[face]) {
      if (next < 0 || seen.count(next) > 0) continue;
      const auto n = static_cast<std::size_t>(next);
      if (faceNormal(mesh, face).dot(faceNormal(mesh, n)) < kCreaseCosine) continue;
      const SurfacePoint near{next, closestBarycentric(centre, mesh.corner(n, 0), mesh.corner(n, 1),
                                                       mesh.corner(n, 2))};
      if ((position(mesh, near) - centre).norm() > radius) continue;
      seen.insert(next);
      patch.faces.push_back(next);
    }
  }
  for (const std::int32_t v : vertices)
    patch.points.push_back(mesh.positions[static_cast<std::size_t>(v)]);
  return patch;
}

std::optional<FittedSphere> fitSphere(const std::vector<Vec3>& points) {
  if (points.size() < 4) return std::nullopt;
  const PointCloud cloud(points);
  // Algebraic fit in units of the cloud, |q|² = 2 c q + d, as the first guess.
  MatX normal_matrix = MatX::Zero(4, 4);
  VecX rhs = VecX::Zero(4);
  for (const Vec3& p : points) {
    const Vec3 q = (p - cloud.mean) / cloud.size;
    const Eigen::Vector4d row(2 * q.x(), 2 * q.y(), 2 * q.z(), 1);
    normal_matrix += row * row.transpose();
    rhs += q.squaredNorm() * row;
  }
  const SymmetricSolver solver(normal_matrix);
  if (!(solver.reciprocalCondition() > 1e-14)) return std::nullopt;
  const VecX first = solver.solve(rhs);
  Vec3 centre = first.head<3>();
  double radius = std::sqrt(std::max(0.0, first[3] + centre.squaredNorm()));
  for (int round = 0; round < kFitRounds; ++round) {
    normal_matrix.setZero();
    rhs.setZero();
    for (const Vec3& p : points) {
      const Vec3 away = (p - cloud.mean) / cloud.size - centre;
      const double distance = std::max(away.norm(), 1e-12);
      Eigen::Vector4d row;
      row << -away / distance, -1;
      normal_matrix += row * row.transpose();
      rhs -= (distance - radius) * row;
    }
    const VecX step = SymmetricSolver(normal_matrix).solve(rhs);
    if (!step.allFinite()) break;
    centre += step.head<3>();
    radius += step[3];
    if (step.norm() < 1e-14) break;
  }
  FittedSphere sphere{cloud.mean + cloud.size * centre, cloud.size * radius, 0};
  if (!(radius > 0 && radius < kMaxRelativeRadius)) return std::nullopt;
  for (const Vec3& p : points)
    sphere.rms += std::pow((p - sphere.centre).norm() - sphere.radius, 2);
  sphere.rms = std::sqrt(sphere.rms / static_cast<double>(points.size()));
  return sphere;
}

std::optional<FittedCylinder> fitCylinder(const TriangleMesh& mesh, const MeshPatch& patch) {
  const std::vector<Vec3>& points = patch.points;
  if (points.size() < 6) return std::nullopt;
  const PointCloud cloud(points);
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const std::int32_t face : patch.faces) {
    const Vec3 n = faceNormal(mesh, static_cast<std::size_t>(face));
    normals += n * n.transpose();
  }
  const SymmetricEigen eigen(normals);
  if (!(eigen.values[1] > 1e-9 * eigen.values[2])) return std::nullopt; // one normal: a plane
  Vec3 axis = eigen.vectors.col(0);
  // Circle in the plane across the axis, |q|² = 2 c q + d, as the first guess.
  Vec3 e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  MatX circle = MatX::Zero(3, 3);
  VecX circle_rhs = VecX::Zero(3);
  for (const Vec3& p : points) {
    const Vec3 q = (p - cloud.mean) / cloud.size;
    const Vec3 row(2 * q.dot(e1), 2 * q.dot(e2), 1);
    circle += row * row.transpose();
    circle_rhs += (std::pow(q.dot(e1), 2) + std::pow(q.dot(e2), 2)) * row;
  }
  const SymmetricSolver solver(circle);
  if (!(solver.reciprocalCondition() > 1e-14)) return std::nullopt;
  const VecX first = solver.solve(circle_rhs);
  Vec3 centre = first[0] * e1 + first[1] * e2;
  double radius = std::sqrt(std::max(0.0, first[2] + centre.squaredNorm()));
  const auto away = [&](const Vec3& p) {
    const Vec3 q = (p - cloud.mean) / cloud.size - centre;
    return std::pair(q.dot(axis), Vec3(q - q.dot(axis) * axis));
  };
  for (int round = 0; round < kFitRounds; ++round) {
    e1 = axis.unitOrthogonal();
    e2 = axis.cross(e1);
    MatX normal_matrix = MatX::Zero(5, 5);
    VecX rhs = VecX::Zero(5);
    for (const Vec3& p : points) {
      const auto [along, radial] = away(p);
      const double distance = std::max(radial.norm(), 1e-12);
      const double u1 = radial.dot(e1) / distance, u2 = radial.dot(e2) / distance;
      VecX row(5);
      row << -u1, -u2, -along * u1, -along * u2, -1;
      normal_matrix += row * row.transpose();
      rhs -= (distance - radius) * row;
    }
    const VecX step = SymmetricSolver(normal_matrix).solve(rhs);
    if (!step.allFinite()) break;
    centre += step[0] * e1 + step[1] * e2;
    axis = (axis + step[2] * e1 + step[3] * e2).normalized();
    radius += step[4];
    if (step.norm() < 1e-14) break;
  }
  if (!(radius > 0 && radius < kMaxRelativeRadius)) return std::nullopt;
  centre -= centre.dot(axis) * axis;
  FittedCylinder cylinder{cloud.mean + cloud.size * centre, axis, cloud.size * radius, 0};
  for (const Vec3& p : points)
    cylinder.rms += std::pow(cloud.size * (away(p).second.norm() - radius), 2);
  cylinder.rms = std::sqrt(cylinder.rms / static_cast<double>(points.size()));
  return cylinder;
}

} // namespace patina
