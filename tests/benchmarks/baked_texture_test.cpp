// T-K11: relief that is baked into the field costs a tick nothing.
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "session/edit/editor.h"
#include "session/open/session.h"
#include "support/least_time.h"
#include "support/sanitized.h"

namespace patina {
namespace {

constexpr double kBaked = 0.03, kHeight = 4e-4; // [m]
constexpr int kTips = 2000;

struct Felt {
  std::shared_ptr<const CompiledScene> scene;
  std::vector<Vec3> tips; // at equal depth below each surface
  std::size_t samples = 0, touching = 0;

  void pass() {
    ContactMemory memory;
    samples = touching = 0;
    for (const Vec3& tip : tips) {
      const Contact contact = tick(*scene->snapshot, memory, tip, 1e-3);
      samples += static_cast<std::size_t>(contact.samples);
      touching += contact.touching;
    }
  }
};

std::vector<Vec3> tipsOver(double radius) {
  std::vector<Vec3> tips;
  for (int i = 0; i < kTips; ++i) {
    const double t = 2e-3 * i;
    const Vec3 n(std::sin(1 + 0.3 * t) * std::cos(t), std::sin(1 + 0.3 * t) * std::sin(t),
                 std::cos(1 + 0.3 * t));
    tips.push_back((radius - 8e-4 - 3e-4 * std::sin(9 * t)) * n);
  }
  return tips;
}

TEST(BakedTexture, CostsNoTickTime) {
  Progress progress;
  Scene scene = sceneOf(icosphere(kBaked, 40), "ball");
  setValues(scene, {{"relief.mode", "baked"}, {"relief.force", "literal"}, {"band", "12"}});
  Editor editor(scene, progress);
  Felt without{editor.compiled(), tipsOver(kBaked)};
  Stroke all;
  all.brush.tool = Tool::relief;
  all.brush.value = kHeight;
  all.brush.radius = 3 * kBaked;
  all.brush.falloff = 1e4;
  all.samples = {{0, Vec3(0, 0, kBaked), 0}};
  (void)editor.apply(all, progress);
  Felt with{editor.compiled(), tipsOver(kBaked + kHeight)};
  ASSERT_NE(with.scene->paint.field, with.scene->built.field); // the relief is in the field
  ASSERT_EQ(with.scene->built.field->grid.voxel, without.scene->built.field->grid.voxel);
  EXPECT_EQ(with.scene->snapshot->stages.size(), without.scene->snapshot->stages.size());
  const std::vector<double> seconds =
      test::minSeconds({[&] { without.pass(); }, [&] { with.pass(); }});
  std::printf("%zu and %zu look-ups\n", without.samples, with.samples);
  EXPECT_EQ(without.touching, static_cast<std::size_t>(kTips));
  EXPECT_EQ(with.touching, static_cast<std::size_t>(kTips));
  // The curvature is a little less; 2051 and 2048 measured.
  EXPECT_NEAR(static_cast<double>(with.samples), static_cast<double>(without.samples),
              0.01 * static_cast<double>(without.samples));
  // The number of field evaluations shows whether a tick does more, the time whether each costs
  // more. Measured are 1.06 to 1.08, because each evaluation reads the nodes' spread; the memory
  // layout of the blocks adds a few hundredths.
  if (!test::kSanitized) {
    EXPECT_TRUE(test::within("a pass with texture, against without", seconds[1], seconds[0], 1.15));
  }
}

} // namespace
} // namespace patina
