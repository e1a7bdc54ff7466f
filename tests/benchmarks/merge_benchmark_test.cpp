// A scene of a hundred objects against one (K14): a tick must cost the same, and the build may take
// a few times that of one mesh with all the triangles.
#include <gtest/gtest.h>

#include <cstdio>

#include "benchmarks/tick_time.h"
#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "session/compile/compile_scene.h"
#include "support/one_thread.h"

namespace patina {
namespace {

constexpr double kTouched = 0.05; // radius [m] of the touched sphere at the origin
constexpr int kFrequency = 7;     // 980 triangles

// The touched sphere among `count` of its kind, with one voxel for any count.
Scene spheres(int count) {
  Scene scene = contactTestScene({});
  scene.field.voxel = 4e-3;
  const auto mesh = std::make_shared<const TriangleMesh>(icosphere(kTouched, kFrequency));
  for (int i = 0; i < count; ++i) {
    SceneObject object{"s" + std::to_string(i), mesh, Pose::Identity()};
    object.world_from_object.translation() =
        Vec3(0.11 * (i % 5), 0.11 * (i / 5 % 5), 0.11 * (i / 25));
    scene.objects.push_back(object);
  }
  return scene;
}

PATINA_TIMED_TEST(MergeTiming, TickOfAHundredObjectsIsThatOfOne) {
  Progress progress;
  const auto one = compile(spheres(1), progress), many = compile(spheres(100), progress);
  const ContactTest test = makeContactTest({});
  const std::vector<double> seconds = test::pathSeconds({one->snapshot, many->snapshot}, test);
  EXPECT_TRUE(
      test::within("2000 ticks: 100 objects against one", seconds[1], seconds[0], 1.1)); // 1.01
  const test::TickTime time = test::tickTime(*many->snapshot, test);
  EXPECT_TRUE(test::within("100 objects, p50", time.tick.p50, time.reference.p50, 4.5)); // 1.55
}

// Packed this densely, each band overlaps its neighbours: each object stores its own, and the
// blocks built are some four times those of one mesh. That is the price of moving one alone.
PATINA_TIMED_TEST(MergeTiming, HundredObjectsBuildInAFewTimesTheTimeOfOneMesh) {
  const test::OneThread alone;
  const Scene scene = spheres(100);
  const TriangleMesh joint = worldMesh(scene);
  Progress progress;
  const std::vector<double> seconds =
      test::minSeconds({[&] { (void)withSamples(buildField(joint, scene.field, progress).field); },
                        [&] { (void)compile(scene, progress); }},
                       1);
  EXPECT_TRUE(test::within("100 objects against one mesh", seconds[1], seconds[0], 5)); // 2.7
}

// One of four objects of 60,000 triangles, about 150 cells along the longest side.
PATINA_TIMED_TEST(MergeTiming, MovingOneObjectCostsThatObjectAndTheUnion) {
  const test::OneThread alone;
  Progress progress;
  Scene scene;
  const auto mesh = std::make_shared<const TriangleMesh>(icosphere(0.03, 55));
  for (int i = 0; i < 4; ++i) {
    SceneObject object{"s" + std::to_string(i), mesh, Pose::Identity()};
    object.world_from_object.translation() = Vec3(0.05 * (i % 2), 0.05 * (i / 2), 0);
    scene.objects.push_back(object);
  }
  auto compiled = compile(scene, progress);
  double to = 0.049;
  const auto move = [&](bool redistance) {
    scene.redistance = redistance;
    scene.objects[3].world_from_object.translation().x() = to -= 0.001;
    compiled = recompile(*compiled, scene, progress);
  };
  const std::vector<double> seconds = test::minSeconds(
      {[&] { (void)compile(scene, progress); }, [&] { move(false); }, [&] { move(true); }}, 1);
  EXPECT_TRUE(test::within("one of 4 moved, against all", seconds[1], seconds[0], 0.7));  // 0.28
  EXPECT_TRUE(test::within("  with depths measured again", seconds[2], seconds[0], 1.5)); // 0.72
}

} // namespace
} // namespace patina
