#include "app/studies/haptics/contact_test_path.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDynamic = 0.3;
constexpr double kStatic = 0.5;

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration duration) {
  return static_cast<double>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count());
}

double percentile(std::vector<double>& values, double fraction) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double angleDegrees(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi;
}

} // namespace

ContactTest makeContactTest(const ContactTestSpec& spec) {
  ContactTest test;
  test.spec = spec;
  const double R = spec.radius;
  const double stiffness = 50 / R;
  for (int i = 0; i < kContactTestTicks; ++i) {
    const double t = kContactTestPeriod * i;
    const double theta = kPi / 2 + 0.17 + 1.1 * std::sin(2 * kPi * 0.11 * t);
    const double theta_dot = 1.1 * 2 * kPi * 0.11 * std::cos(2 * kPi * 0.11 * t);
    const double phi = 0.7 + 2 * kPi * 0.37 * t;
    const double phi_dot = 2 * kPi * 0.37;
    const double depth = R * (0.03 + 0.02 * std::sin(2 * kPi * 1.3 * t));
    const Vec3 normal(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                      std::cos(theta));
    const Vec3 along_theta(std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi),
                           -std::sin(theta));
    const Vec3 along_phi(-std::sin(phi), std::cos(phi), 0);
    const Vec3 tangent = theta_dot * along_theta + std::sin(theta) * phi_dot * along_phi;
    Vec3 reference = stiffness * depth * normal;
    if (spec.friction) reference -= kDynamic * stiffness * depth * tangent.normalized();
    test.tips.push_back((R * (1 + spec.tip_radius) - depth) * normal);
    test.normals.push_back(normal);
    test.reference.push_back(reference);
  }
  const Vec3 start = 1.3 * R * test.normals.front();
  for (int i = 0; i < kContactTestLeadIn; ++i) {
    const double along = static_cast<double>(i) / kContactTestLeadIn;
    test.lead_in.push_back(start + along * (test.tips.front() - start));
  }
  return test;
}

Scene contactTestScene(const ContactTestSpec& spec) {
  Scene scene;
  scene.sampler = spec.sampler;
  scene.haptics.contact = spec.contact;
  scene.haptics.stiffness = 50 / spec.radius;
  if (spec.tip_radius > 0) scene.haptics.tip_radius = spec.tip_radius * spec.radius;
  if (spec.friction) {
    Friction friction;
    friction.static_coefficient = kStatic;
    friction.dynamic_coefficient = kDynamic;
    friction.slip = spec.slip;
    scene.haptics.friction = friction;
  }
  return scene;
}

ContactTestErrors contactTestErrors(const HapticSnapshot& snapshot, const ContactTest& test) {
  ContactTestErrors errors;
  ContactMemory memory;
  for (const Vec3& tip : test.lead_in) tick(snapshot, memory, tip, kContactTestPeriod);
  const std::size_t first = test.spec.friction ? kContactTestSettle : 0;
  const std::size_t count = test.tips.size();
  double direction = 0, magnitude = 0, jump = 0, ratio = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Contact contact = tick(snapshot, memory, test.tips[i], kContactTestPeriod);
    const Vec3& force = contact.force;
    errors.force.push_back(force);
    errors.faults += contact.fault;
    errors.lost += force.dot(test.normals[i]) < 0.5 * test.reference[i].dot(test.normals[i]);
    if (i < first) continue;
    const Vec3& reference = test.reference[i];
    const Vec3& n = test.normals[i];
    const auto slide = [&n](const Vec3& f) { return Vec3(f - f.dot(n) * n); };
    const double angle = test.spec.friction ? angleDegrees(slide(force), slide(reference))
                                            : angleDegrees(force, reference);
    const double relative = 100 * std::abs(force.norm() / reference.norm() - 1);
    direction += angle;
    magnitude += relative;
    errors.direction_max = std::max(errors.direction_max, angle);
    errors.magnitude_max = std::max(errors.magnitude_max, relative);
    const double normal_part = force.dot(test.normals[i]);
    ratio += (force - normal_part * test.normals[i]).norm() / normal_part;
    if (i == first) continue;
    jump += ((force - errors.force[i - 1]) - (reference - test.reference[i - 1])).squaredNorm();
  }
  const auto used = static_cast<double>(count - first);
  errors.direction_mean = direction / used;
  errors.magnitude_mean = magnitude / used;
  errors.coulomb_ratio = ratio / used;
  errors.jump_rms = std::sqrt(jump / (used - 1));
  return errors;
}

namespace {

std::vector<double> tickTimes(const HapticSnapshot& snapshot, const ContactTest& test,
                              std::size_t batch) {
  ContactMemory memory;
  for (const Vec3& tip : test.lead_in) tick(snapshot, memory, tip, kContactTestPeriod);
  std::vector<double> ns;
  ns.reserve(test.tips.size() / batch);
  for (std::size_t i = 0; i + batch <= test.tips.size(); i += batch) {
    const Clock::time_point before = Clock::now();
    for (std::size_t k = i; k < i + batch; ++k)
      tick(snapshot, memory, test.tips[k], kContactTestPeriod);
    ns.push_back(nanoseconds(Clock::now() - before) / static_cast<double>(batch));
  }
  return ns;
}

double clockTime(std::size_t count) {
  std::vector<double> ns(count);
  for (double& value : ns) {
    const Clock::time_point before = Clock::now();
    value = nanoseconds(Clock::now() - before);
  }
  return percentile(ns, 0.5);
}

} // namespace

ContactTestTiming contactTestTiming(const HapticSnapshot& snapshot, const ContactTest& test,
                                    int repeats) {
  ContactTestTiming timing;
  timing.p50 = timing.p99 = timing.clock = timing.batch = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < repeats; ++pass) {
    std::vector<double> single = tickTimes(snapshot, test, 1);
    timing.p50 = std::min(timing.p50, percentile(single, 0.5));
    timing.p99 = std::min(timing.p99, percentile(single, 0.99));
    std::vector<double> batches = tickTimes(snapshot, test, kTimingBatch);
    timing.batch = std::min(timing.batch, percentile(batches, 0.5));
    timing.clock = std::min(timing.clock, clockTime(test.tips.size()));
  }
  return timing;
}

std::shared_ptr<const SurfaceField> analyticSphere(double radius, int resolution, double band) {
  const Box3 box(Vec3::Constant(-radius), Vec3::Constant(radius));
  FieldSpec spec;
  spec.resolution = resolution;
  spec.band = band;
  return withSamples(std::make_shared<SurfaceField>(sampleFunction(
      [radius](const Vec3& p) { return p.norm() - radius; }, gridAround(box, spec), spec.band)));
}

std::shared_ptr<const SurfaceField> meshSphere(double radius, int frequency, double crack,
                                               Progress& progress) {
  const TriangleMesh whole = icosphere(radius, frequency);
  return withSamples(
      buildField(crack > 0 ? withShrunkenTriangles(whole, crack) : whole, FieldSpec{}, progress)
          .field);
}

} // namespace patina
