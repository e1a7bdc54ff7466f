// T-RAMP: with the tip held still, no edit changes the force by more than 0.05 N a tick (MATH 2.4).
#include "haptics/servo/cross_fade.h"

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "support/simulated_device.h"

namespace patina {
namespace {

constexpr double kAllowed = 0.05; // [N]

struct Edit {
  const char* what;
  std::shared_ptr<const HapticSnapshot> from, to;
  Vec3 tip;
};

Scene with(void (*change)(HapticProperties&)) {
  Scene scene = sceneOf(500);
  change(scene.haptics);
  return scene;
}

std::vector<Edit> edits() {
  const Field sphere = sphereField(); // R = 30 mm, h = 0.45 mm
  const Field larger = cubeField([](const Vec3& p) { return p.norm() - 0.033; }, 0.5e-3, 180);
  const auto make = [&](void (*change)(HapticProperties&)) {
    return compileStages(with(change), sphere);
  };
  const auto plain = [](HapticProperties&) {};
  const Vec3 pressed = 0.028 * Vec3(1, 2, 2) / 3, deep = 0.025 * Vec3(1, 2, 2) / 3;
  const Vec3 above = 0.031 * Vec3(1, 2, 2) / 3;
  std::vector<Edit> list;
  const auto add = [&](const char* what, auto from, auto to, const Vec3& tip) {
    list.push_back({what, from, to, tip});
    list.push_back({what, to, from, tip});
  };
  const auto base = make(plain);
  add("stiffness 200 to 1000 N/m at 5 mm", make([](HapticProperties& h) { h.stiffness = 200; }),
      make([](HapticProperties& h) { h.stiffness = 1000; }), deep);
  add("offset", base, make([](HapticProperties& h) { h.offset = 2e-3; }), pressed);
  add("offset above the surface", base, make([](HapticProperties& h) { h.offset = 2e-3; }), above);
  add("tip radius", base, make([](HapticProperties& h) { h.tip_radius = 1.5e-3; }), above);
  add("magnet", base, make([](HapticProperties& h) {
        h.magnet = Magnet{2e-3, 1500, false};
      }),
      above);
  add("friction", base, make([](HapticProperties& h) {
        h.friction = Friction{0.5, 0.3, 0};
      }),
      pressed);
  add("damping", base, make([](HapticProperties& h) { h.damping = 5; }), pressed);
  add("an object at the tip", base, compileStages(sceneOf(500), larger), above);
  add("a grown object", base, compileStages(sceneOf(500), larger), pressed);
  return list;
}

TEST(CrossFade, NoEditStepsTheForceOfAStillTip) {
  for (const Edit& edit : edits()) {
    CrossFade law;
    law.fadeTo(edit.from.get());
    // The tip is moved sideways before it rests, so that friction holds a force as well.
    Vec3 tip = edit.tip;
    for (int i = 0; i < 20; ++i) law.tick(tip += Vec3(2e-5, 0, -1e-5), 1e-3);
    for (int i = 0; law.fading() && i < 500; ++i) law.tick(tip, 1e-3);
    Vec3 last = law.tick(tip, 1e-3).force;
    law.tick(tip, 1e-3);
    law.fadeTo(edit.to.get());
    EXPECT_TRUE(law.fading());
    int ticks = 0;
    for (; law.fading() && ticks < 1000; ++ticks) {
      const Contact contact = law.tick(tip, 1e-3);
      ASSERT_LE((contact.force - last).norm(), kAllowed) << edit.what << ", tick " << ticks;
      ASSERT_FALSE(contact.fault) << edit.what;
      last = contact.force;
    }
    EXPECT_LT(ticks, 150) << edit.what;
    EXPECT_EQ(law.active(), edit.to.get());
    ContactMemory fresh;
    const Vec3 wanted = tick(*edit.to, fresh, tip, 1e-3).force;
    const Vec3 after = law.tick(tip, 1e-3).force;
    EXPECT_LE((after - last).norm(), kAllowed) << edit.what;
    // Friction remembers its stuck point, which a fresh tip does not have.
    EXPECT_NEAR(after.norm(), wanted.norm(), 0.15 * wanted.norm() + 1e-12) << edit.what;
  }
}

TEST(CrossFade, ExchangesEqualLawsAtOnce) {
  const Field sphere = sphereField();
  const auto a = compileStages(sceneOf(500), sphere), b = compileStages(sceneOf(900), sphere);
  CrossFade law;
  law.fadeTo(a.get());
  law.tick(Vec3(0, 0, 0.05), 1e-3);
  law.fadeTo(b.get());
  law.tick(Vec3(0, 0, 0.05), 1e-3);
  EXPECT_FALSE(law.fading());
  EXPECT_EQ(law.active(), b.get());
}

TEST(CrossFade, EqualsTheTickWithoutAnEdit) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), sphereField());
  CrossFade law;
  law.fadeTo(snapshot.get());
  law.tick(Vec3(0, 0, 0.0305), 1e-3); // out of contact: at once
  EXPECT_FALSE(law.fading());
  ContactMemory memory;
  std::mt19937 random(2);
  Vec3 tip(0, 0, 0.0305);
  for (int i = 0; i < 3000; ++i) {
    tip += 1e-4 * randomDirection(random);
    ASSERT_EQ(law.tick(tip, 1e-3).force, tick(*snapshot, memory, tip, 1e-3).force) << i;
  }
}

TEST(CrossFade, HasNoForceWithoutASurface) {
  CrossFade law;
  EXPECT_EQ(law.tick(Vec3(1, 2, 3), 1e-3).force, Vec3(0, 0, 0));
}

// A fault outlasts an edit: no edit bypasses the fade to zero and back.
TEST(CrossFade, KeepsAFaultThroughAnEdit) {
  const Field sphere = sphereField();
  const auto a = compileStages(sceneOf(2000), sphere), b = compileStages(sceneOf(1900), sphere);
  CrossFade law;
  law.fadeTo(a.get());
  law.tick(Vec3(0, 0, 0.0301), 1e-3);
  EXPECT_TRUE(law.tick(Vec3(0, 0, 0.022), 1e-3).fault); // 16 N in one tick
  law.fadeTo(b.get());
  double last = 0;
  for (int i = 1; i < 300; ++i) {
    const double force = law.tick(Vec3(0, 0, 0.022), 1e-3).force.norm();
    ASSERT_LT(force, i < 48 ? 0.1 : 20) << i;
    ASSERT_LT(std::abs(force - last), 0.1) << i;
    last = force;
  }
  EXPECT_NEAR(last, 1900 * 8e-3, 0.01); // a tip in a solid always has a force
}

// Edits at 30 Hz between 300 and 700 N/m under a mass in contact (limit 2b/T = 1000 N/m): it comes
// to rest as without edits; a rate limit of the force would shake it (F13).
TEST(CrossFade, EditsDoNotShakeAStableContact) {
  const Field plane = planeField();
  const auto soft = compileStages(sceneOf(300), plane), stiff = compileStages(sceneOf(700), plane);
  SimulatedDeviceSpec spec;
  spec.position = Vec3(0, 0, -1e-3);
  spec.velocity = Vec3(0, 0, -0.1);
  spec.hand_force = Vec3(0, 0, -1);
  SimulatedDevice device(spec);
  CrossFade law;
  law.fadeTo(soft.get());
  Vec3 force = Vec3::Zero(), tip = spec.position;
  double deepest = 0, fastest = 0;
  for (int i = 0; i < 12000; ++i) {
    if (i < 3000 && i % 33 == 0 && !law.fading())
      law.fadeTo(law.active() == soft.get() ? stiff.get() : soft.get());
    const Vec3 last = tip;
    tip = device.exchange(force, 1e-3).position;
    force = law.tick(tip, 1e-3).force;
    deepest = std::max(deepest, -tip.z());
    if (i > 11000) fastest = std::max(fastest, (tip - last).norm() / 1e-3);
  }
  EXPECT_LT(deepest, 0.012);
  EXPECT_LT(fastest, 5e-3);
}

} // namespace
} // namespace patina
