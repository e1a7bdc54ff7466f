#include <gtest/gtest.h>

#include "core/error.h"
#include "haptics/contact_fixture.h"

namespace patina {
namespace {

Scene offsetScene(double stiffness, double offset, bool proxy = true) {
  Scene scene = sceneOf(stiffness);
  scene.haptics.offset = offset;
  if (!proxy) scene.haptics.contact = HapticProperties::Contact::ray;
  return scene;
}

// T-K12a: radial, K (delta - (r - R)), from the offset surface down into the sphere.
TEST(Offset, MatchesTheClosedFormOnASphere) {
  const double K = 1000, R = 0.03, delta = 1.5e-3;
  const Field sphere = sphereField(R); // h = 0.45 mm
  const auto snapshot = compileStages(offsetScene(K, delta), sphere);
  std::mt19937 random(1);
  const double h = sphere->grid.voxel;
  for (const double above : {1.6e-3, 1.499e-3, 1e-3, 0.3e-3, -0.2e-3, -1.5e-3}) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 n = randomDirection(random);
      const Contact contact = touchOnce(*snapshot, (R + above) * n);
      const double expected = std::max(0.0, K * (delta - above));
      EXPECT_NEAR(contact.force.norm(), expected, K * h * h / (4 * R)) << above;
      if (expected < 0.01) continue;
      EXPECT_LT((contact.force / contact.force.norm() - n).norm(), 1e-4);
      // T-K12d: the visible and editable point lies on the model itself.
      EXPECT_NEAR(contact.surface.norm(), R, h * h / (4 * R));
      EXPECT_NEAR((contact.vcp - contact.surface).norm(), delta, 2 * h * h / (4 * R));
    }
  }
}

TEST(Offset, SurfacePointStaysOnTheModelWithAFiniteTip) {
  Scene scene = offsetScene(1000, 1e-3);
  scene.haptics.tip_radius = 0.5e-3;
  const auto snapshot = compileStages(scene, sphereField());
  const Contact contact = touchOnce(*snapshot, Vec3(0, 0, 0.0305));
  EXPECT_NEAR(contact.force.z(), 1, 1e-3);
  EXPECT_NEAR(contact.surface.z(), 0.03, 2e-6);
}

// T-K12b: a plate of thickness t pushed through along z, from `top` to its middle and beyond.
struct Push {
  double middle = 0; // [N], resisting, at the middle
  double work = 0;   // [J], against it, down to the middle
  double beyond = 0; // [N] along z, just past the middle
};

Push pushThrough(double thickness, double offset, bool proxy) {
  const double K = 1000, step = 5e-7;
  const Field plate = plateField(thickness);
  Scene scene = sceneOf(K);
  if (offset > 0) scene = offsetScene(K, offset, proxy);
  if (!proxy) scene.haptics.contact = HapticProperties::Contact::ray;
  const auto snapshot = compileStages(scene, plate);
  ContactMemory memory;
  Push push;
  double last = 0;
  const int half = static_cast<int>(std::lround((0.5 * thickness + offset + 0.2e-3) / step));
  for (int i = half; i >= -60; --i) {
    const Contact contact = tick(*snapshot, memory, Vec3(1e-4, 2e-4, i * step), 1e-3);
    const double force = contact.force.z();
    if (i > 0) push.work += 0.5 * (force + last) * step;
    if (i == 1) push.middle = force;
    if (i == -60) push.beyond = force;
    last = force;
  }
  return push;
}

TEST(Offset, PushedPlateResistsLikeTheClosedForm) {
  const double K = 1000;
  for (const double t : {0.5e-3, 1e-3}) {
    for (const double delta : {0.0, 0.2e-3, 0.5e-3}) {
      for (const bool proxy : {false, true}) {
        const Push push = pushThrough(t, delta, proxy);
        const double reach = delta + 0.5 * t;
        EXPECT_NEAR(push.middle / (K * reach), 1, 0.01) << t << ' ' << delta;
        EXPECT_NEAR(push.work / (0.5 * K * reach * reach), 1, 0.01) << t << ' ' << delta;
        // The paper's force reverses there; the proxy keeps its side.
        EXPECT_EQ(push.beyond > 0, proxy) << t << ' ' << delta;
        EXPECT_NEAR(std::abs(push.beyond) / (K * reach), 1, 0.13) << t << ' ' << delta;
      }
    }
  }
}

// T-K12c: a tip that is guided down over a dent of radius rho < delta is held at sqrt(delta^2 -
// rho^2) above the plane, and would otherwise pass the plane.
TEST(Offset, BridgesADentNarrowerThanItself) {
  const double rho = 2e-3, delta = 2.5e-3, voxel = 0.1e-3;
  const Field dent = cubeField(
      [=](const Vec3& p) {
        const double r = std::hypot(p.x(), p.y());
        if (p.z() > 0) return r >= rho ? p.z() : std::hypot(p.z(), rho - r);
        const double from_ball = p.norm() - rho;
        return from_ball < 0 ? -from_ball : std::max(p.z(), -from_ball);
      },
      voxel, 120, 30);
  const auto snapshot = compileStages(offsetScene(1000, delta), dent);
  const double lowest = std::sqrt(delta * delta - rho * rho);
  EXPECT_FALSE(touchOnce(*snapshot, Vec3(0, 0, lowest + voxel)).touching);
  EXPECT_TRUE(touchOnce(*snapshot, Vec3(0, 0, lowest - voxel)).touching);
  // The tip without an offset falls to the bottom of the dent.
  const auto plain = compileStages(sceneOf(1000), dent);
  EXPECT_FALSE(touchOnce(*plain, Vec3(0, 0, -rho + voxel)).touching);
}

// MATH 2.8: an offset below a voxel, and one wider than the gap between two parts.
TEST(Offset, ActsIfSmallerThanAVoxel) {
  const Field sphere = sphereField(); // h = 0.45 mm
  const auto snapshot = compileStages(offsetScene(1000, 20e-6), sphere);
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(0, 0, 0.03)).force.z(), 0.02, 1e-4);
}

TEST(Offset, StaysFiniteAndBoundedIfWiderThanAGap) {
  const double gap = 2e-3, delta = 1.5e-3;
  const Field walls =
      cubeField([=](const Vec3& p) { return 0.5 * gap - std::abs(p.x()); }, 0.1e-3, 80, 30);
  for (const bool proxy : {false, true}) {
    const auto snapshot = compileStages(offsetScene(1000, delta, proxy), walls);
    ContactMemory memory;
    for (double x = -0.9e-3; x < 0.9e-3; x += 7e-6) {
      const Contact contact = tick(*snapshot, memory, Vec3(x, 0, 1e-4), 1e-3);
      ASSERT_TRUE(contact.force.allFinite());
      ASSERT_LE(contact.force.norm(), 1000 * (delta + gap)) << x;
      // The offset leaves no free place for a proxy.
      ASSERT_EQ(contact.touching || contact.fault, !proxy) << x;
    }
  }
}

TEST(Offset, IsRefusedOutsideTheBandWithTheRemedy) {
  try {
    compileStages(offsetScene(500, 5e-3), sphereField()); // h = 0.45 mm, band 8
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("offset = 5 mm"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("set band to 15"), std::string::npos) << error.what();
  }
}

TEST(Offset, IsLeftOutIfZero) {
  const Field sphere = sphereField(0.03, 60);
  EXPECT_EQ(compileStages(offsetScene(500, 0), sphere)->stages.size(), 3u);
  EXPECT_EQ(compileStages(offsetScene(500, 1e-3), sphere)->stages.size(), 4u);
}

} // namespace
} // namespace patina
