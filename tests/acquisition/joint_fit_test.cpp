#include "acquisition/registration/joint_fit.h"

#include <cstdio>
#include <functional>

#include <gtest/gtest.h>

#include "acquisition/registration_shapes.h"
#include "core/decompose.h"

namespace patina {
namespace {

// A body by its formula. Paths lie on its mesh, because the error of the facets, up to 1 um, is not
// small against the precision of 3000 samples.
double radiusAt(const Vec3& d) {
  return 0.035 + 0.006 * d.x() * d.y() + 0.005 * std::sin(3 * d.z() + d.x()) +
         0.003 * std::cos(5 * d.y() - 2 * d.z()) + 0.004 * d.x();
}
TriangleMesh bodyOf() {
  TriangleMesh mesh = icosphere(1, 100);
  for (Vec3& p : mesh.positions) p *= radiusAt(p);
  return mesh;
}
Vec3 normalAt(const Vec3& p) {
  const auto height = [](const Vec3& q) { return q.norm() - radiusAt(q.normalized()); };
  Vec3 slope;
  for (int a = 0; a < 3; ++a)
    slope[a] = height(p + 1e-7 * Vec3::Unit(a)) - height(p - 1e-7 * Vec3::Unit(a));
  return slope.normalized();
}

const SurfaceTarget& body() {
  static const SurfaceTarget target(bodyOf(), 0, true);
  return target;
}

struct JointScan {
  Pose mesh_from_path = Pose::Identity();
  Vec3 tip = Vec3(0.5e-3, -0.3e-3, 0.8e-3);
  double clock = 4e-3, noise = 50e-6, compliance = 0.5e-3;
  bool tilts = true;

  // Position and force of the tip at time t.
  double force(double t) const { return 1 + 0.8 * std::sin(2 * std::numbers::pi * 3 * t); }
  Vec3 tipAt(double t) const {
    const Vec3 d = Vec3(std::cos(2.1 * t) + 0.3 * std::sin(5 * t), std::sin(2.9 * t),
                        0.9 * std::cos(3.7 * t + 1))
                       .normalized();
    const Vec3 p = body().tree().closestPoint(radiusAt(d) * d).point;
    return p - compliance * force(t) * normalAt(p);
  }
  std::vector<PathSample> path(unsigned seed) const {
    test::Draw draw(seed);
    std::vector<PathSample> path;
    for (int i = 0; i < 3000; ++i) {
      PathSample sample;
      sample.t = 1e-3 * i;
      const double tilt = tilts ? 0.6 : 0;
      sample.orientation = Eigen::AngleAxisd(tilt * std::sin(1.7 * sample.t), Vec3::UnitX()) *
                           Eigen::AngleAxisd(tilt * std::cos(2.3 * sample.t), Vec3::UnitY());
      sample.position = mesh_from_path.inverse() * tipAt(sample.t) - sample.orientation * tip +
                        draw.normal(noise);
      sample.force = force(sample.t + clock);
      sample.touching = true;
      path.push_back(sample);
    }
    return path;
  }
};

JointScan jointScanOf(unsigned seed) {
  test::Draw draw(100 + seed);
  JointScan scan;
  scan.mesh_from_path.linear() =
      Eigen::AngleAxisd(0.4, draw.normal(1).normalized()).toRotationMatrix();
  scan.mesh_from_path.translation() = draw.normal(0.01);
  return scan;
}

// Fits the pose alone and leaves the errors of tip and clock in the path.
Pose separately(const SurfaceTarget& target, const std::vector<PathSample>& path, const Pose& start,
                double compliance) {
  std::vector<Vec3> points;
  FitOptions options;
  for (const PathSample& sample : path) {
    points.push_back(sample.position);
    options.indentations.push_back(compliance * sample.force);
  }
  return fitPath(target, points, start, options).mesh_from_path;
}

double bodyMissOf(const Pose& found, const JointScan& scan) { // rms over the body [m]
  double sum = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = scan.tipAt(1e-2 * i);
    sum += (found * (scan.mesh_from_path.inverse() * p) - p).squaredNorm();
  }
  return std::sqrt(sum / 300);
}

TEST(JointFit, PredictsItsErrorsAndBeatsSeparateSteps) {
  const int rounds = 30;
  double nees = 0, joint = 0, apart = 0, tip = 0, clock = 0;
  for (unsigned seed = 0; seed < rounds; ++seed) {
    const JointScan scan = jointScanOf(seed);
    const auto path = scan.path(seed);
    const std::vector<bool> counts(path.size(), true);
    const Pose before = separately(body(), path, scan.mesh_from_path, scan.compliance);
    JointOptions options;
    options.compliance = scan.compliance;
    const JointFit fit = fitJointly(body(), path, counts, before, options);
    ASSERT_TRUE(fit.converged);
    EXPECT_TRUE(fit.unobservable_parameters.empty()) << fit.unobservable_parameters.front();
    const Pose off = fit.mesh_from_path * scan.mesh_from_path.inverse();
    const Eigen::AngleAxisd turn(off.linear());
    JointVector error;
    error << turn.angle() * turn.axis(), off * fit.middle - fit.middle, fit.tip - scan.tip,
        fit.clock - scan.clock;
    nees += error.dot(SymmetricSolver(fit.covariance).solve(error)) / kJointValues / rounds;
    joint += bodyMissOf(fit.mesh_from_path, scan) / rounds;
    apart += bodyMissOf(before, scan) / rounds;
    tip += (fit.tip - scan.tip).norm() / rounds;
    clock += std::abs(fit.clock - scan.clock) / rounds;
  }
  std::printf("NEES %.2f, pose %.4f mm (apart %.4f), tip %.4f mm of .99, clock %.3f ms of 4\n",
              nees, 1e3 * joint, 1e3 * apart, 1e3 * tip, 1e3 * clock);
  EXPECT_GT(nees, 0.8); // one deviation is .08 for 300 degrees of freedom
  EXPECT_LT(nees, 1.25);
  EXPECT_LT(joint, 0.2 * apart);
  EXPECT_LT(tip, 0.03e-3);
  EXPECT_LT(clock, 0.5e-3);
}

// The tip cannot be separated from a shift of the path unless the probe tilts; on a rigid body the
// clock offset is unobservable.
TEST(JointFit, ReportsAndFixesUnobservableParameters) {
  JointScan scan = jointScanOf(1);
  scan.tilts = false;
  scan.compliance = 0;
  const auto path = scan.path(1);
  const std::vector<bool> counts(path.size(), true);
  const Pose start = separately(body(), path, scan.mesh_from_path, 0);
  const JointFit fit = fitJointly(body(), path, counts, start);
  for (const std::string& words : fit.unobservable_parameters) std::printf("%s\n", words.c_str());
  EXPECT_EQ(fit.unobservable_parameters.size(), 4U);
  EXPECT_NEAR(fit.clock, 0, 1e-6);
  EXPECT_FALSE(fit.clock_deviation.has_value()); // absent if unobservable
  EXPECT_FALSE(fit.tip_deviation.has_value());
  const auto names = [&](const char* what) {
    return std::count_if(
        fit.unobservable_parameters.begin(), fit.unobservable_parameters.end(),
        [&](const std::string& words) { return words.find(what) != std::string::npos; });
  };
  EXPECT_EQ(names("the tip along"), 3);
  EXPECT_EQ(names("the clock"), 1);
  // Nothing moved along fixed directions: the tip compensates the shift, and both are small.
  EXPECT_LT(fit.tip.norm(), 0.05e-3);
}

// No pose fits if the tip is wrong by millimetres. Once the tip is corrected, the pose is as good
// as any and all samples count again.
TEST(JointFit, JudgesConvergenceByTheResiduals) {
  JointScan scan = jointScanOf(3);
  scan.tip = Vec3(2e-3, 1.5e-3, 0);
  scan.clock = 0;
  auto path = scan.path(3);
  std::vector<Vec3> points;
  RegistrationOptions registering;
  registering.noise = scan.noise;
  registering.search = false;
  for (const PathSample& sample : path) {
    points.push_back(sample.position);
    registering.indentations.push_back(scan.compliance * sample.force);
  }
  Progress progress;
  Registration found = registerPath(body(), points, scan.mesh_from_path, registering, progress);
  EXPECT_FALSE(found.converged);
  JointOptions options;
  options.compliance = scan.compliance;
  const JointFit fit = refine(body(), options, registering, path, found, progress);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.rms, scan.noise, 0.1 * scan.noise);
  EXPECT_GT(std::count(found.inliers.begin(), found.inliers.end(), true), 2900);
  EXPECT_LT((fit.tip - scan.tip).norm(), 0.1e-3);
  EXPECT_LT(found.correlation_length, 2); // only white noise is left
  // The fit has not converged if the stated noise does not explain the residuals.
  auto again = scan.path(3);
  registering.noise = 0.3 * scan.noise;
  EXPECT_TRUE(refine(body(), options, registering, again, found, progress).converged); // at rest
  EXPECT_FALSE(found.converged);
}

// Alternative poses seem to fit with a wrong tip; with the corrected tip there are none.
TEST(JointFit, JudgesUniquenessByTheFittedPath) {
  JointScan scan = jointScanOf(3);
  scan.tip = Vec3(5e-3, -3e-3, 0);
  auto path = scan.path(3);
  std::vector<Vec3> points;
  RegistrationOptions registering;
  registering.noise = scan.noise;
  registering.alternatives = true;
  for (const PathSample& sample : path) {
    points.push_back(sample.position);
    registering.indentations.push_back(scan.compliance * sample.force);
  }
  Progress progress;
  Registration found = registerPath(body(), points, scan.mesh_from_path, registering, progress);
  ASSERT_TRUE(found.alternatives.has_value());
  EXPECT_FALSE(found.alternatives->empty());
  JointOptions options;
  options.compliance = scan.compliance;
  const JointFit fit = refine(body(), options, registering, path, found, progress);
  EXPECT_TRUE(found.alternatives->empty()) << inWords(*found.alternatives);
  EXPECT_TRUE(found.converged);
  EXPECT_LT((fit.tip - scan.tip).norm(), 0.1e-3);
  EXPECT_LT(bodyMissOf(found.mesh_from_path, scan), 0.05e-3);
}

TEST(JointFit, KeepsParametersThatAreNotFitted) {
  const JointScan scan = jointScanOf(2);
  const auto path = scan.path(2);
  JointOptions options;
  options.compliance = scan.compliance;
  options.clock = false;
  const JointFit fit =
      fitJointly(body(), path, std::vector<bool>(path.size(), true), scan.mesh_from_path, options);
  EXPECT_EQ(fit.clock, 0);
  EXPECT_FALSE(fit.clock_deviation.has_value());
  ASSERT_TRUE(fit.tip_deviation.has_value());
  EXPECT_NEAR(*fit.tip_deviation, std::sqrt(fit.covariance.block<3, 3>(6, 6).trace() / 3), 1e-12);
  EXPECT_TRUE(fit.unobservable_parameters.empty());
  EXPECT_LT((fit.tip - scan.tip).norm(), 0.1e-3);
  EXPECT_THROW(fitJointly(body(), path, {true}, Pose::Identity()), std::invalid_argument);
}

} // namespace
} // namespace patina
