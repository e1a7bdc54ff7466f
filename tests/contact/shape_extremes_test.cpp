// Extreme shapes and paths of contact, against the exact proxy.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"
#include "contact/course_limits.h"
#include "contact/ways.h"
#include "field/surface/models.h"
#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"

namespace patina::test {
namespace {

struct Felt {
  std::shared_ptr<const HapticSnapshot> snapshot;
  ExactSurface surface;
  double iso;

  Felt(const ContactScene& scene, double tip, std::vector<TriangleMesh> exact = {})
      : snapshot(contactSnapshot(contactField(scene, tip, 150), tip, "")),
        surface(exact.empty() ? scene.meshes : std::move(exact)), iso(tip) {}
  TrialReport along(const std::vector<Vec3>& corners, double speed) const {
    return runPath(methodOf(*snapshot), surface, iso, way(corners, speed));
  }
};

// Paths go down the diagonal, beside it, and slide around it.
TEST(ShapeExtremes, OnAVertex) {
  const Vec3 vertex(0.05, 0.04, 0.03), out = Vec3(1, 1, 1).normalized();
  for (const double iso : {0.0, 1e-3}) {
    const Felt felt(contactScene("box"), iso);
    for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(1e-6, 0, 0), Vec3(0.3e-3, -0.2e-3, 0)}) {
      const Vec3 in = vertex - 2e-3 * out + aside;
      const TrialReport report =
          felt.along({vertex + 4e-3 * out + aside, in, in + Vec3(1e-3, -1e-3, 0), in,
                      vertex + 4e-3 * out + aside},
                     0.05);
      EXPECT_GE(report.contacts, 50);
      expectFaultless(report, "vertex");
    }
  }
}

// The exit found is not much longer than the shortest one, and contact continues from there.
TEST(ShapeExtremes, InsideAtTheFirstTick) {
  for (const char* name : {"box", "L", "dinosaur", "torus"}) {
    const Felt felt(contactScene(name), 0);
    const double voxel = felt.snapshot->field->grid.voxel;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    const Box3 box = felt.surface.bounds();
    int inside = 0;
    for (int i = 0; i < 40000 && inside < 300; ++i) {
      const Vec3 tip =
          box.min() + box.sizes().cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
      const double depth = -felt.surface.distance(tip);
      if (depth < voxel) continue;
      ++inside;
      ContactMemory memory;
      Contact contact = tick(*felt.snapshot, memory, tip, kTick);
      ASSERT_TRUE(contact.touching) << name << ' ' << tip.transpose();
      EXPECT_FALSE(contact.fault);
      EXPECT_LT(std::abs(felt.surface.distance(contact.frictionless_point)), 0.5 * voxel) << name;
      EXPECT_GT(contact.depth, depth - 0.5 * voxel) << name;
      EXPECT_LT(contact.depth, 1.5 * depth + 2 * voxel) << name << ' ' << tip.transpose();
      const Vec3 last = contact.force;
      contact = tick(*felt.snapshot, memory, tip + Vec3(1e-5, 0, 0), kTick);
      EXPECT_TRUE(contact.touching);
      EXPECT_FALSE(contact.fault);
      EXPECT_LT((contact.force - last).norm(),
                kTestStiffness * (2e-5 + kOwnSpeed * kTick) + kWorstStep);
    }
    EXPECT_GE(inside, 100) << name;
  }
}

// At 2 mm a tick the wall is passed in one tick, and contact holds on the side of entry.
TEST(ShapeExtremes, AtTwoMetresASecondThroughAOneMillimetreWall) {
  for (const bool turned : {false, true}) {
    ContactScene scene{"plate", {plateSolid(1e-3)}};
    if (turned) scene.meshes[0] = tilted(scene.meshes[0]);
    for (const double iso : {0.0, 1e-3}) {
      const Felt felt(scene, iso);
      for (const double side : {1.0, -1.0})
        for (int phase = 0; phase < 10; ++phase) {
          std::vector<Vec3> corners = {Vec3(1e-3, 2e-3, side * (7e-3 + 0.2e-3 * phase)),
                                       Vec3(2e-3, 2e-3, -side * 5e-3)};
          if (turned) corners = tilted({corners, {}, {}}).positions;
          const Vec3 across = (corners[0] - corners[1]).normalized();
          ContactMemory memory;
          Contact contact;
          for (const Vec3& tip : way(corners, 2)) {
            contact = tick(*felt.snapshot, memory, tip, kTick);
            EXPECT_FALSE(contact.fault);
            EXPECT_GE(contact.force.dot(across), 0) << side << ' ' << phase;
          }
          EXPECT_NEAR(contact.force.dot(across), kTestStiffness * (5.5e-3 + iso), 0.1);
        }
    }
  }
}

// A slot 1 mm wide under a tip of 2 mm: the tip rests on both edges.
TEST(ShapeExtremes, GrooveNarrowerThanTheTip) {
  const ContactScene scene{
      "slot",
      {cellSolid({-0.03, -0.5e-3, 0.5e-3, 0.03}, {-0.03, 0.03}, {-0.03, -0.01, 0},
                 [](int i, int, int k) { return i != 1 || k == 0; })}};
  const Felt felt(scene, 2e-3);
  for (const double below : {0.5e-3, 3e-3}) {
    const double z = 2e-3 - below;
    const TrialReport report =
        felt.along({Vec3(0.2e-3, -0.01, 5e-3), Vec3(0.2e-3, -0.01, z), Vec3(0, 0.01, z),
                    Vec3(-6e-3, 0.008, z), Vec3(6e-3, 0, z), Vec3(0, 0, 5e-3)},
                   0.1);
    EXPECT_GT(report.contacts, 200);
    expectFaultless(report, "slot");
  }
}

TEST(ShapeExtremes, OneTriangle) {
  const TriangleMesh triangle{
      {Vec3(0, 0, 0), Vec3(0.09, 0.01, 0.02), Vec3(0.01, 0.08, 0.01)}, {{0, 1, 2}}, {}};
  const Vec3 n = faceNormal(triangle, 0), middle = Vec3(0.1, 0.09, 0.03) / 3;
  const Vec3 along = n.unitOrthogonal();
  ContactScene scene{"triangle", {triangle}};
  // Contact from the front, as on the surface of a solid behind the triangle.
  const TriangleMesh body{{triangle.positions[0], triangle.positions[1], triangle.positions[2],
                           Vec3(middle - 0.05 * n)},
                          {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}},
                          {}};
  const std::vector<Vec3> press = {middle + 4e-3 * n, middle - 2e-3 * n,
                                   middle - 2e-3 * n + 8e-3 * along, middle + 4e-3 * n};
  for (const double iso : {0.0, 1e-3}) {
    const TrialReport report = Felt(scene, iso, {body}).along(press, 0.05);
    EXPECT_GT(report.contacts, 100);
    expectFaultless(report, "front");
  }
  // Contact from both sides and off the boundary.
  scene.sides = OpenSides::automatic_two;
  const Felt felt(scene, 1e-3);
  for (const double side : {1.0, -1.0}) {
    std::vector<Vec3> tips;
    for (const Vec3& p : press) tips.push_back(p - (1 - side) * (p - middle).dot(n) * n);
    tips.push_back(middle + side * 0.2e-3 * n + 0.08 * along);
    const TrialReport report = felt.along(tips, 0.05);
    EXPECT_GT(report.contacts, 100);
    expectFaultless(report, "both sides");
  }
}

// One sheet stands on a box's face, another shares a box's edge, where three faces meet.
TEST(ShapeExtremes, NonManifoldFins) {
  TriangleMesh fin;
  fin.positions = {Vec3(0, -0.04, 0.03),   Vec3(0, 0.04, 0.03),     Vec3(0, 0.04, 0.05),
                   Vec3(0, -0.04, 0.05),   Vec3(0.05, -0.04, 0.03), Vec3(0.05, 0.04, 0.03),
                   Vec3(0.07, 0.04, 0.05), Vec3(0.07, -0.04, 0.05)};
  fin.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const TriangleMesh solid = box(Vec3(0.1, 0.08, 0.06));
  const Felt felt({"fins", {joined(solid, fin)}, {1e-3}, OpenSides::automatic_two}, 1e-3,
                  {solid, fin});
  // Down beside the fin into the corner, along it, up over its edge and down the other side.
  const TrialReport report =
      felt.along({Vec3(6e-3, 0, 0.04), Vec3(-1e-3, 0.002, 0.029), Vec3(-1e-3, 0.012, 0.029),
                  Vec3(-1e-3, 0.01, 0.045), Vec3(3e-3, 0.01, 0.056), Vec3(-5e-3, 0.01, 0.053),
                  Vec3(1e-3, 0, 0.035), Vec3(-8e-3, 0, 0.04)},
                 0.05);
  EXPECT_GT(report.contacts, 300);
  expectFaultless(report, "fin on a face");
  const TrialReport edge = felt.along({Vec3(0.045, 0, 0.04), Vec3(0.051, 0, 0.029),
                                       Vec3(0.051, 0.01, 0.029), Vec3(0.045, 0.01, 0.04)},
                                      0.05);
  EXPECT_GT(edge.contacts, 100);
  expectFaultless(edge, "fin on an edge");
}

// One mesh of two intersecting boxes renders as their union.
TEST(ShapeExtremes, SelfIntersectingMesh) {
  const TriangleMesh lying = box(Vec3(0.1, 0.06, 0.03)),
                     standing = moved(tilted(box(Vec3(0.03, 0.03, 0.1))), Vec3(0.004, 0.002, 0.01));
  for (const double iso : {0.0, 1e-3}) {
    const Felt felt({"cut", {joined(lying, standing)}}, iso, {lying, standing});
    const TrialReport report = runTrials(methodOf(*felt.snapshot), felt.surface, iso, 5000, 3);
    EXPECT_GE(report.contacts, 5000);
    expectFaultless(report, "cut");
    expectExact(report, "cut");
  }
}

} // namespace
} // namespace patina::test
