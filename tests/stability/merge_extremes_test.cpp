// The Merge list of MATH 2.8, on the servo's own tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "field/construction/build_field.h"
#include "field/merge/merge_fields.h"
#include "field/merge/redistance.h"
#include "geometry/mesh/shapes.h"
#include "haptics/law/snapshot.h"
#include "haptics/servo/cross_fade.h"

namespace patina {
namespace {

constexpr double kStiffness = 500;
constexpr double kDt = 1e-3;

struct Placed {
  TriangleMesh mesh;
  Vec3 at = Vec3::Zero();
};

// Compiles a scene of these objects at `resolution` cells, band 8.
std::shared_ptr<const HapticSnapshot> united(const std::vector<Placed>& objects, bool redistance,
                                             int resolution = 150, double shift = 0) {
  Progress progress;
  std::vector<TriangleMesh> meshes;
  Box3 box;
  TriangleMesh joint;
  for (const Placed& object : objects) {
    meshes.push_back(object.mesh);
    for (Vec3& p : meshes.back().positions) p += object.at;
    box.extend(fieldBounds(meshes.back()));
    joint = joint.triangles.empty() ? meshes.back() : joined(joint, meshes.back());
  }
  FieldSpec spec;
  spec.resolution = resolution;
  const FieldGrid grid = gridAround(box, spec);
  // `shift` [voxel] moves the nodes against the objects: no result may depend on it.
  const BlockLattice lattice{grid.origin - Vec3::Constant(shift * grid.voxel), grid.voxel};
  std::vector<FieldPart> parts;
  std::int32_t first_face = 0;
  for (const TriangleMesh& mesh : meshes) {
    const BlockBox blocks = blocksAround(lattice, fieldBounds(mesh), spec.band);
    parts.push_back({buildField(mesh, gridOf(lattice, blocks), spec.band, progress).field,
                     blocks.low, first_face});
    first_face += static_cast<std::int32_t>(mesh.triangles.size());
  }
  SurfaceField field = mergeFields(parts, lattice);
  if (redistance) field = redistanced(field, parts, lattice, joint, progress).field;
  Scene scene;
  scene.haptics.stiffness = kStiffness;
  scene.haptics.force_limit = 1e3;
  return compileStages(scene, withSamples(std::make_shared<const SurfaceField>(std::move(field))));
}

struct Walk {
  Contact last;
  double largest_step = 0; // [N] between two ticks
  double largest = 0;      // [N]
  bool finite = true;
  int faults = 0;
};

// Moves the tip by at most `step` metres a tick.
Walk walk(const HapticSnapshot& snapshot, ContactMemory& memory, const std::vector<Vec3>& path,
          double step = 1e-4) {
  Walk result;
  Vec3 force = Vec3::Zero();
  Vec3 from = memory.tip.last ? *memory.tip.last : path.front();
  bool first = true;
  for (const Vec3& to : path) {
    const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step)));
    for (int i = 1; i <= count; ++i) {
      result.last =
          tick(snapshot, memory, from + static_cast<double>(i) / count * (to - from), kDt);
      const Vec3& f = result.last.force;
      result.finite = result.finite && f.allFinite();
      if (!first) result.largest_step = std::max(result.largest_step, (f - force).norm());
      first = false;
      result.largest = std::max(result.largest, f.norm());
      result.faults += result.last.fault;
      force = f;
    }
    from = to;
  }
  return result;
}

double vcpDistance(const Contact& contact) {
  return (contact.vcp - contact.tip).norm();
}

constexpr double kR = 0.02, kOff = 0.01;
const double kExit = std::sqrt(kR * kR - kOff * kOff); // 17.32 mm
const double kMergedVoxel = 2 * (kR + kOff) / 134;     // at 150 cells, band 8

std::vector<Placed> deepPair() {
  return {{icosphere(kR, 30), Vec3(-kOff, 0, 0)}, {icosphere(kR, 30), Vec3(kOff, 0, 0)}};
}

const std::vector<Vec3>& nearCentre() {
  static const std::vector<Vec3> kTips = {Vec3(0, 0, 0),          Vec3(1e-4, 0, 0),
                                          Vec3(0, 1e-4, 0),       Vec3(0, 0, -1e-4),
                                          Vec3(5e-5, 5e-5, 7e-5), Vec3(-7e-5, 0, 7e-5)};
  return kTips;
}

// T-K14e, F9.
TEST(MergeExtremes, ShortestWayOutIsTakenDeepInTwoSpheres) {
  for (const double shift : {0.0, 1.3, 4.0, 6.7}) {
    const auto snapshot = united(deepPair(), true, 150, shift);
    for (const Vec3& tip : nearCentre()) {
      ContactMemory memory;
      for (int i = 0; i < 200; ++i) { // at once, and while it rests
        const Contact contact = tick(*snapshot, memory, tip, kDt);
        ASSERT_TRUE(contact.touching);
        ASSERT_NEAR(vcpDistance(contact), kExit, kMergedVoxel)
            << tip.transpose() << " shift " << shift;
      }
    }
  }
}

TEST(MergeExtremes, ShortestWayOutIsTakenAlongAPathWithoutAJump) {
  for (const double shift : {0.0, 4.0}) {
    const auto snapshot = united(deepPair(), true, 150, shift);
    for (const Vec3& tip : nearCentre()) {
      for (const Vec3& way : {Vec3(0, 1, 0), Vec3(0, 0.6, 0.8), Vec3(0.02, 0.3, -0.95)}) {
        ContactMemory memory;
        const Walk in = walk(*snapshot, memory, {0.03 * way.normalized(), tip});
        EXPECT_TRUE(in.finite);
        EXPECT_EQ(in.faults, 0);
        EXPECT_NEAR(vcpDistance(in.last), kExit, kMergedVoxel) << tip.transpose();
        EXPECT_LT(in.largest_step, 0.5) << way.transpose();
      }
    }
  }
}

// A path straight through keeps the first side, as in any solid (K03): no reversal, no jump.
TEST(MergeExtremes, ForceStaysFiniteAndBoundedThroughBothCentres) {
  for (const bool redistance : {false, true}) {
    const auto snapshot = united(deepPair(), redistance);
    ContactMemory memory;
    const Walk through = walk(*snapshot, memory, {Vec3(0.035, 1e-5, 0), Vec3(-0.035, 1e-5, 0)});
    EXPECT_TRUE(through.finite);
    EXPECT_LE(through.largest, kStiffness * 0.07);
  }
}

TEST(MergeExtremes, ForceIsFiniteAndBoundedWithoutRedistancing) {
  const auto snapshot = united(deepPair(), false);
  for (const Vec3& tip : nearCentre()) {
    ContactMemory memory;
    for (int i = 0; i < 100; ++i) {
      const Contact contact = tick(*snapshot, memory, tip, kDt);
      ASSERT_TRUE(contact.force.allFinite());
      ASSERT_LE(contact.force.norm(), kStiffness * 2 * (kR + kOff));
    }
    memory.reset();
    const Walk in = walk(*snapshot, memory, {Vec3(0, 0.03, 0), tip});
    EXPECT_TRUE(in.finite);
    EXPECT_LE(in.largest, kStiffness * 2 * (kR + kOff));
  }
}

TEST(MergeExtremes, IdenticalObjectsEqualOneBitForBit) {
  const auto one = united({{icosphere(kR, 16)}}, false, 100);
  const auto two = united({{icosphere(kR, 16)}, {icosphere(kR, 16)}}, false, 100);
  ContactMemory a, b;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * kDt;
    const Vec3 tip(0.022 - 0.006 * std::sin(2 * t), 0.01 * std::sin(3 * t), 0.01 * std::cos(5 * t));
    ASSERT_EQ(tick(*one, a, tip, kDt).force, tick(*two, b, tip, kDt).force);
  }
}

TEST(MergeExtremes, ObjectInsideAnotherHasNoEffect) {
  const auto big = united({{icosphere(kR, 16)}}, true, 100);
  const auto both =
      united({{icosphere(kR, 16)}, {icosphere(0.006, 8), Vec3(0.003, 0, 0)}}, true, 100);
  ContactMemory a, b;
  const std::vector<Vec3> path = {Vec3(0.003, 0.001, 0.025), Vec3(0.003, 0.001, 0.002)};
  const Walk x = walk(*big, a, path), y = walk(*both, b, path);
  EXPECT_EQ(x.last.force, y.last.force);
  EXPECT_GT(x.last.force.norm(), 1);
}

TEST(MergeExtremes, SpheresTouchingAtAPointHaveNoSpikeBetweenThem) {
  const std::vector<Placed> pair = {{icosphere(0.01, 20), Vec3(-0.01, 0, 0)},
                                    {icosphere(0.01, 20), Vec3(0.01, 0, 0)}};
  for (const bool redistance : {false, true}) {
    const auto snapshot = united(pair, redistance);
    ContactMemory memory;
    const Walk in =
        walk(*snapshot, memory,
             {Vec3(0, 0.012, 0), Vec3(0, 1e-4, 0), Vec3(0, -1e-4, 0), Vec3(0, -0.012, 0)});
    EXPECT_TRUE(in.finite);
    EXPECT_EQ(in.faults, 0);
    EXPECT_LT(in.largest, kStiffness * 2e-3); // the gap closes to nothing; so does the force
  }
}

// T-K14d: 1 mm deep from one sphere over the seam onto the other.
TEST(MergeExtremes, SlideOverTheSeamHasNoSpike) {
  const auto snapshot = united(deepPair(), true);
  const double depth = 1e-3, from = 0.7, speed = 0.05; // [m], [rad] about a centre, [m/s]
  const double r = kR - depth;
  ContactMemory memory;
  (void)walk(*snapshot, memory,
             {Vec3(kOff + 0.025 * std::sin(from), 0.025 * std::cos(from), 0),
              Vec3(kOff + r * std::sin(from), r * std::cos(from), 0)});
  const double seam = -std::asin(kOff / r); // seam of the right sphere, where x = 0
  const double tick_angle = speed * kDt / r;
  double side = 0, most = 0, turn = 0;
  Vec3 last = Vec3::Zero();
  for (int half = 0; half < 2; ++half)
    for (double angle = from; angle > seam; angle -= tick_angle) {
      const double a = half ? -(from + seam - angle) : angle;
      const Vec3 tip((half ? -kOff : kOff) + r * std::sin(a), r * std::cos(a), 0);
      const Contact contact = tick(*snapshot, memory, tip, kDt);
      ASSERT_TRUE(contact.touching);
      const double f = contact.force.norm();
      most = std::max(most, f);
      if (std::abs(tip.x()) > 5e-3) side = std::max(side, f);
      if (!last.isZero())
        turn =
            std::max(turn, std::atan2(last.cross(contact.force).norm(), last.dot(contact.force)));
      last = contact.force;
    }
  EXPECT_NEAR(side, kStiffness * depth, 0.02);
  EXPECT_LT(most, 1.2 * side);
  // The crease has 60 degrees, spread over the cells about it.
  const double jump = M_PI / 3;
  EXPECT_LT(turn, 3 * jump * speed * kDt / kMergedVoxel);
}

TEST(MergeExtremes, HundredObjectsAreTouchedSeparately) {
  std::vector<Placed> objects;
  for (int i = 0; i < 100; ++i)
    objects.push_back({icosphere(0.006, 5), Vec3(0.012 * (i % 10), 0.012 * (i / 10), 0)});
  const auto snapshot = united(objects, false);
  for (const Placed& object : objects) {
    ContactMemory memory;
    const Walk in =
        walk(*snapshot, memory, {object.at + Vec3(0, 0, 0.008), object.at + Vec3(0, 0, 0.005)});
    EXPECT_NEAR(in.last.force.z(), kStiffness * 1e-3, 0.06);
  }
}

// MATH 2.4: the object around the tip is removed, moved aside, and put back.
TEST(MergeExtremes, EditsOfTheObjectAroundTheTipFade) {
  const std::vector<Placed> pair = {{icosphere(0.01, 16), Vec3(-0.02, 0, 0)},
                                    {icosphere(0.01, 16), Vec3(0.02, 0, 0)}};
  const auto both = united(pair, false), left = united({pair[0]}, false, 60);
  const auto aside = united({pair[0], {pair[1].mesh, Vec3(0.02, 0, 0.004)}}, false);
  const Vec3 tip(0.02, 0, 0.007);
  CrossFade fade;
  fade.fadeTo(both.get());
  Contact contact;
  for (int i = 0; i < 200; ++i) contact = fade.tick(tip + Vec3(0, 0, 2.5e-5 * (199 - i)), kDt);
  const Vec3 felt = contact.force;
  ASSERT_GT(felt.norm(), 1);
  for (const HapticSnapshot* next : {left.get(), both.get(), aside.get(), left.get()}) {
    for (int i = 0; i < 500 && fade.fading(); ++i) (void)fade.tick(tip, kDt);
    fade.fadeTo(next);
    for (int i = 0; i < 500; ++i) {
      const Vec3 before = contact.force;
      contact = fade.tick(tip, kDt);
      ASSERT_TRUE(contact.force.allFinite());
      EXPECT_LE((contact.force - before).norm(), 0.05);
      EXPECT_FALSE(contact.fault);
    }
    if (next == both.get()) {
      // The contact point c on faces comes to rest to 5e-3 voxel.
      EXPECT_NEAR((contact.force - felt).norm(), 0, 2e-3);
    } else if (next == left.get()) {
      EXPECT_EQ(contact.force.norm(), 0);
    } else {
      EXPECT_GT(contact.force.norm(), felt.norm() + 1);
    }
  }
}

} // namespace
} // namespace patina
