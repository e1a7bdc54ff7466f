#include "app/studies/acquisition/registration_cases.h"

#include <cmath>
#include <numbers>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/registration/first_guess.h"
#include "acquisition/simulation/mesh_strokes.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 drawNormal(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

// Point away from the face's edges, because on a ridge all noise points away from the mesh.
Vec3 within(const TriangleMesh& mesh, std::size_t face, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.2, 1);
  const double a = share(random), b = share(random), c = share(random);
  return (a * mesh.corner(face, 0) + b * mesh.corner(face, 1) + c * mesh.corner(face, 2)) /
         (a + b + c);
}

} // namespace

RegistrationCase drawCase(const SurfaceTarget& target, const RegistrationSetting& setting,
                          unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Box3 box = bounds(target.mesh());
  const Vec3 half = box.sizes() / 2;
  const double x = 2 * kPi * unit(random), y = 2 * kPi * unit(random), z = 2 * kPi * unit(random);
  RegistrationCase drawn;
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < setting.points; ++i) {
    const double u = 2 * kPi * i / setting.points;
    const Vec3 about(std::sin(u + x), std::sin(2 * u + y), std::sin(3 * u + z));
    const std::int32_t face =
        target.tree().closestPoint(box.center() + half.cwiseProduct(about)).surface.face;
    drawn.truth.push_back(within(target.mesh(), index(face), random));
    middle += drawn.truth.back() / setting.points;
  }
  drawn.start = Pose::Identity();
  drawn.start.linear() =
      Eigen::AngleAxisd(setting.turn, drawNormal(random).normalized()).toRotationMatrix();
  drawn.start.translation() =
      middle - drawn.start.linear() * middle + setting.shift * drawNormal(random).normalized();
  drawn.path = drawn.truth;
  for (Vec3& p : drawn.path) {
    p += setting.noise * drawNormal(random);
    const Vec3 aside = drawNormal(random).normalized();
    const double far = 5e-3 + 15e-3 * unit(random);
    if (unit(random) < setting.outliers) p += far * aside;
  }
  return drawn;
}

ScannedCase scanCase(const TriangleMesh& mesh, double seconds, unsigned seed, Progress& progress) {
  constexpr double kRough = 25e-6; // [m]
  SimulatedHand hand = scanPathsOver(mesh, seed, seconds, 0.05);
  hand.relief = [shape = hand.relief, rough = roughSurface(seed, kRough)](const Vec2& place) {
    return shape(place) + rough(place);
  };
  const ProbeModel probe;
  SimulatedCamera camera;
  camera.camera_from_world = cameraOver(bounds(mesh), 0);
  ScanFilter filter;
  filter.gravity = camera.camera_from_world.linear() * kGravity;
  const FilteredScan scan =
      filterScan(simulateCamera(hand, probe, camera, seed),
                 simulateProbe(hand, probe, {}, seed + 1), probe, filter, progress);
  return {inContact(scan.path), camera.camera_from_world.inverse(), hand.compliance};
}

double trueError(const Pose& mesh_from_path, const std::vector<Vec3>& truth) {
  double squares = 0;
  for (const Vec3& p : truth) squares += (mesh_from_path * p - p).squaredNorm();
  return std::sqrt(squares / static_cast<double>(truth.size()));
}

TriangleMesh bumpySheet(int cells) {
  TriangleMesh mesh = sheet(0.1, 0.1, cells);
  constexpr double kStretch = 12;
  const auto relief = roughSurface(1, 1e-3);
  for (Vec3& p : mesh.positions) p.z() = relief(Vec2(p.head<2>() / kStretch));
  return mesh;
}

} // namespace patina
