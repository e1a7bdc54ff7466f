// Pressing fast over edges with the coupling, whose damper acts on the tip and not on the contact
// point: a contact point that moves around an edge must not cause a push.
#include <algorithm>
#include <cstdio>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"

namespace patina::test {
namespace {

// In closed form, the force of a tick changes by no more than the tip's own motion explains:
//   spring  2 k |dx| + k v_s dt, also while the contact point runs by itself: .52 N at 2000 N/m;
//   damper  B |v| + B |dv|, for -B P v with 0 <= P <= 1 changes by B |v| as P does: .34 N.
// Both rarely coincide: with the spring's share less than 3/4 of the damper's was observed.
constexpr double kSpeed = 0.2;      // [m/s]
constexpr double kMaxBeyond = 0.25; // [N] beyond the spring's; .217 measured
constexpr double kRounding = 1e-3;  // [N]

struct Edge {
  const char* name;
  ContactScene scene;
  Vec3 at;  // on the edge
  Vec3 out; // unit vector from the edge into the open
  Vec3 along;
};

std::vector<Edge> edges() {
  return {
      {"box edge", contactScene("box"), Vec3(0.05, 0, 0.03), Vec3(1, 0, 1).normalized(),
       Vec3::UnitY()},
      {"L corner", contactScene("L"), Vec3(0, 0, 0), Vec3(-1, 0, 1).normalized(), Vec3::UnitY()},
      {"L edge", contactScene("L"), Vec3(0, 0, 0.05), Vec3(-1, 0, 1).normalized(), Vec3::UnitY()},
      {"plate edge", contactScene("plate2"), Vec3(0.05, 0, 0.001), Vec3(1, 0, 1).normalized(),
       Vec3::UnitY()}};
}

// The path leads in from free space, across below the edge, and out again, at one speed.
std::vector<Vec3> stroke(const Edge& edge, double iso, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vec3 side = edge.along.cross(edge.out);
  const auto about = [&](double across, double height) {
    return Vec3(edge.at + across * side + (height + iso) * edge.out +
                3e-3 * unit(random) * edge.along);
  };
  const std::vector<Vec3> corners = {
      about(6e-3 * unit(random), 9e-3), about(4e-3 * unit(random), -1e-3 + 2e-3 * unit(random)),
      about(4e-3 * unit(random), -1e-3 + 2e-3 * unit(random)), about(6e-3 * unit(random), 9e-3)};
  std::vector<Vec3> tips = {corners[0]};
  for (const Vec3& to : corners) {
    const Vec3 from = tips.back();
    const int count = static_cast<int>((to - from).norm() / (kSpeed * kTick));
    for (int i = 1; i <= count; ++i)
      tips.push_back(from + i * kSpeed * kTick * (to - from).normalized());
  }
  return tips;
}

Vec3 springOf(const Contact& contact) {
  return contact.stiffness * (contact.vcp - contact.tip);
}

TEST(CoupledPress, ForceStepsOverAnEdgeStayWithinSpringAndDamper) {
  std::map<double, double> worst; // largest excess [N] for each stiffness, at constant velocity
  double worst_beyond = 0;
  for (const Edge& edge : edges())
    for (const double iso : {0.0, 1e-3, 2e-3}) {
      const auto field = contactField(edge.scene, iso, 150);
      for (const bool chosen : {false, true})
        for (const double stiffness : {500.0, 1000.0, 2000.0}) {
          Scene scene;
          scene.haptics.stiffness = stiffness;
          scene.haptics.force_limit = 1e3;
          if (iso > 0) scene.haptics.tip_radius = iso;
          scene.device_model = DeviceModel{};
          if (chosen) scene.stabilisers = Stabilisers{true, false};
          const auto snapshot = compileStages(scene, field);
          const auto& plan = snapshot->stabilisers.coupling;
          const double damping = plan ? plan->damping : 0;
          std::mt19937 random(7);
          double straight = 0, beyond = 0, own = 0, swung = 0, damped = 0;
          long contacts = 0, faults = 0;
          for (int k = 0; k < 60; ++k) {
            ContactMemory memory;
            Contact last;
            bool first = true;
            for (const Vec3& tip : stroke(edge, iso, random)) {
              const Contact now = tick(*snapshot, memory, tip, kTick);
              if (!first) {
                const double turned = (now.velocity - last.velocity).norm();
                const double law = std::max(now.stiffness, last.stiffness) *
                                   (2 * (tip - last.tip).norm() + kOwnSpeed * kTick);
                const double step = (now.force - last.force).norm();
                if (turned < 1e-6) straight = std::max(straight, step);
                beyond = std::max(beyond, step - law - damping * turned);
                const Vec3 spring = springOf(now) - springOf(last);
                const double damper = (now.force - last.force - spring).norm();
                own = std::max(own, spring.norm() - law);
                swung = std::max(swung, damper - damping * (kSpeed + turned));
              }
              damped = std::max(damped, (now.force - springOf(now)).norm());
              contacts += now.touching;
              faults += now.fault;
              first = false;
              last = now;
            }
          }
          worst[stiffness] = std::max(worst[stiffness], straight);
          worst_beyond = std::max(worst_beyond, beyond);
          const std::string what = edge.name + (" " + std::to_string(iso)) + " K " +
                                   std::to_string(stiffness) + (chosen ? " chosen" : "");
          EXPECT_GT(contacts, 500);
          EXPECT_EQ(faults, 0) << what;
          EXPECT_LE(beyond, kMaxBeyond) << what;
          EXPECT_LE(own, kRounding) << what;
          EXPECT_LE(swung, kRounding) << what;
          EXPECT_LE(damped, damping * kSpeed * (1 + 1e-6)) << what;
        }
    }
  for (const auto& [stiffness, step] : worst) {
    std::printf("K %.0f: step %.3f N at constant velocity\n", stiffness, step);
    EXPECT_LE(step, 0.6) << "K " << stiffness; // .42, .48, .56
  }
  std::printf("beyond what spring and damper explain: %.3f N\n", worst_beyond);
}

} // namespace
} // namespace patina::test
