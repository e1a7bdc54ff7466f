#include "haptics/servo/feel.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "haptics/contact_fixture.h"

namespace patina {
namespace {

std::vector<TimedTip> press() {
  std::vector<TimedTip> path;
  for (int i = 0; i < 40; ++i) path.push_back({1e-3 * i, Vec3(1e-4 * i, 0, 1e-3 - 1e-4 * i)});
  return path;
}

TEST(Feel, GivesOneSampleARowLikeTheServo) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), planeField());
  const std::vector<TimedTip> path = press();
  Progress progress;
  const std::vector<ToolSample> samples = feel(*snapshot, path, progress);
  ASSERT_EQ(samples.size(), path.size());
  ContactMemory memory;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Contact contact =
        tick(*snapshot, memory, path[i].tip, i ? path[i].t - path[i - 1].t : path[1].t - path[0].t);
    EXPECT_EQ(samples[i].t, path[i].t);
    EXPECT_EQ(samples[i].tip, path[i].tip);
    EXPECT_EQ(samples[i].force, contact.force);
    EXPECT_EQ(samples[i].vcp, contact.vcp);
    EXPECT_EQ(samples[i].contact, path[i].tip.z() < 0);
    if (!samples[i].contact) {
      EXPECT_EQ(samples[i].vcp, samples[i].tip);
      EXPECT_EQ(samples[i].normal, Vec3::Zero().eval());
    } else {
      EXPECT_NEAR(samples[i].depth, -path[i].tip.z(), 1e-9);
    }
  }
}

TEST(Feel, NamesTheRowIfTimeDoesNotIncrease) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  std::vector<TimedTip> path = press();
  path[7].t = path[6].t;
  Progress progress;
  try {
    feel(*snapshot, path, progress);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("row 8"), std::string::npos) << error.what();
  }
  path[7].t = std::nan("");
  EXPECT_THROW(feel(*snapshot, path, progress), Error);
}

TEST(Feel, HandlesSinglePointsAndNoPoints) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  Progress progress;
  EXPECT_TRUE(feel(*snapshot, {}, progress).empty());
  const auto samples = feel(*snapshot, {{0, Vec3(0, 0, -1e-3)}}, progress);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_NEAR(samples[0].force.z(), 0.5, 1e-6);
}

TEST(Feel, StopsWhenCancelled) {
  const auto snapshot = compileStages(sceneOf(500), planeField());
  Progress progress;
  progress.cancel();
  EXPECT_THROW(feel(*snapshot, press(), progress), Cancelled);
}

// A wall that damps gives K d + b v, also if the path begins at another time than 0.
TEST(Feel, TakesTheSpeedFromTheTimeBetweenTwoRows) {
  Scene scene = sceneOf(500);
  scene.haptics.damping = 2;
  const auto snapshot = compileStages(scene, planeField());
  Progress progress;
  for (const double start : {0.0, 7.5}) {
    std::vector<TimedTip> path;
    for (int i = 0; i < 40; ++i) path.push_back({start + 2e-3 * i, Vec3(0, 0, 1e-3 - 1e-4 * i)});
    const double last = feel(*snapshot, path, progress).back().force.z();
    EXPECT_NEAR(last, 500 * 2.9e-3 + 2 * 0.05, 1e-3) << start;
  }
}

// Two sides of a ball: the tip skips the straight line between them at a pause.
TEST(Feel, LiftsTheTipAtAPause) {
  const auto snapshot = compileStages(sceneOf(500), sphereField(0.03, 60));
  const auto felt = [&](double period, double pause) {
    std::vector<TimedTip> path;
    for (int i = 0; i < 20; ++i) {
      const double t = i * period + (i < 10 ? 0 : pause);
      path.push_back({t, Vec3(i < 10 ? 0.031 : -0.029, 1e-5 * i, 0)});
    }
    std::size_t given = 0;
    std::vector<ToolSample> samples;
    const std::size_t pauses = feel(
        *snapshot,
        [&] { return given < path.size() ? std::optional(path[given++]) : std::nullopt; },
        [&](const ToolSample& sample) { samples.push_back(sample); }, Progress());
    return std::pair(pauses, samples);
  };
  const auto [paused, apart] = felt(1e-3, 0.5);
  EXPECT_EQ(paused, 1u);
  EXPECT_EQ(apart[9].force.norm(), 0);
  EXPECT_NEAR(apart[10].force.x(), -0.5, 1e-3) << "as deep as on this side";
  // A slow path has long ticks and no pause: the tip is held on its side of entry.
  const auto [none, through] = felt(1.0 / 30, 0);
  EXPECT_EQ(none, 0u);
  EXPECT_GT(through[10].force.x(), 1);
}

} // namespace
} // namespace patina
