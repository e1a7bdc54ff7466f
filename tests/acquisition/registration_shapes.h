// Meshes and paths with a known pose, for tests of registration.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "acquisition/registration/surface_target.h"
#include "geometry/mesh/shapes.h"

namespace patina::test {

// A body without symmetry, 60 to 100 mm across.
inline TriangleMesh lumpy(int frequency = 40) {
  TriangleMesh mesh = icosphere(1, frequency);
  for (Vec3& p : mesh.positions) {
    const double r = 0.035 + 0.006 * p.x() * p.y() + 0.005 * std::sin(3 * p.z() + p.x()) +
                     0.003 * std::cos(5 * p.y() - 2 * p.z()) + 0.004 * p.x();
    p *= r;
    p.x() *= 1.3;
  }
  return mesh;
}

// 100 mm square, waves of several lengths.
inline TriangleMesh bumpyPatch(int cells = 150) {
  TriangleMesh mesh = sheet(0.1, 0.1, cells);
  for (Vec3& p : mesh.positions)
    p.z() = 2e-3 * std::sin(90 * p.x()) * std::cos(70 * p.y()) +
            1e-3 * std::sin(160 * p.y() + 40 * p.x());
  return mesh;
}

inline TriangleMesh tube(double radius, double length, int around, int along) {
  TriangleMesh mesh;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      mesh.positions.emplace_back(radius * std::cos(a), radius * std::sin(a),
                                  length * (static_cast<double>(j) / along - 0.5));
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around, low = j * around, high = low + around;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
  return mesh;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  Vec3 normal(double deviation) {
    std::normal_distribution<double> n(0, deviation);
    return {n(random_), n(random_), n(random_)};
  }
  Vec3 direction() { return normal(1).normalized(); }

  // A curve around the body, projected onto the surface.
  std::vector<Vec3> pathOn(const SurfaceTarget& target, int n) {
    const Box3 box = bounds(target.mesh());
    const Vec3 half = box.sizes() / 2;
    const double p = uniform(0, 6), q = uniform(0, 6), r = uniform(0, 6);
    std::vector<Vec3> path;
    for (int i = 0; i < n; ++i) {
      const double u = 6.2 * i / n;
      const Vec3 near =
          box.center() + half.cwiseProduct(Vec3(0.8 * std::sin(u + p), 0.9 * std::sin(2 * u + q),
                                                0.9 * std::sin(3 * u + r)));
      path.push_back(target.tree().closestPoint(near).point);
    }
    return path;
  }

  // Returns a start near the truth: the path rotated about its centre, then shifted.
  Pose off(const std::vector<Vec3>& path, double degrees, double metres) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : path) middle += p / static_cast<double>(path.size());
    Pose pose = Pose::Identity();
    pose.linear() =
        Eigen::AngleAxisd(degrees * std::numbers::pi / 180, direction()).toRotationMatrix();
    pose.translation() = middle - pose.linear() * middle + metres * direction();
    return pose;
  }

 private:
  std::mt19937 random_;
};

// Distance of the moved points from their true positions, rms [m].
inline double missOf(const Pose& mesh_from_path, const std::vector<Vec3>& truth) {
  double squares = 0;
  for (const Vec3& p : truth) squares += (mesh_from_path * p - p).squaredNorm();
  return std::sqrt(squares / static_cast<double>(truth.size()));
}

} // namespace patina::test
