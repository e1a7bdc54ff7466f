// Ticks of a tool become strokes: their begin, end and sampling rate (K20).
#include "session/edit/stroke_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patina {
namespace {

constexpr double kTick = 1e-3;

ToolSample touching(double t, double x = 0) {
  ToolSample tick;
  tick.t = t;
  tick.contact = true;
  tick.surface = Vec3(x, 0, 0);
  tick.force = Vec3(0, 0, 0.7);
  return tick;
}
ToolSample away(double t) {
  ToolSample tick;
  tick.t = t;
  return tick;
}
std::vector<ToolSample> contact(double from, double to) {
  std::vector<ToolSample> ticks;
  for (int i = 0; from + i * kTick < to - 1e-9; ++i) ticks.push_back(touching(from + i * kTick));
  return ticks;
}
const StrokeTracker::Hand kDown{true, Vec3::Zero(), 1e-3};

std::size_t count(const std::vector<StrokePiece>& pieces) {
  std::size_t sum = 0;
  for (const auto& piece : pieces) sum += piece.samples.size();
  return sum;
}

TEST(StrokeTracker, ContactAtOneKilohertzGivesAbout120SamplesASecond) {
  StrokeTracker tracker;
  std::size_t samples = 0;
  for (double t = 0; t < 0.9999; t += 0.03)
    samples += count(tracker.feed(contact(t, t + 0.03), kDown));
  EXPECT_NEAR(static_cast<double>(samples), 1020.0 / 9, 2); // every ninth tick is past 1/120 s
  EXPECT_TRUE(tracker.painting());
}

TEST(StrokeTracker, StrokeLastsFromTheFirstContactUntilTheButtonIsReleased) {
  StrokeTracker tracker;
  const auto first = tracker.feed(contact(5, 5.05), kDown);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(first[0].begins);
  EXPECT_FALSE(first[0].ends);
  EXPECT_EQ(first[0].samples.front().t, 0);
  EXPECT_NEAR(first[0].samples.front().force, 0.7, 1e-12);
  const auto second = tracker.feed(contact(5.05, 5.08), kDown);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_FALSE(second[0].begins);
  EXPECT_GT(second[0].samples.front().t, first[0].samples.back().t);
  const auto last = tracker.finish();
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].ends);
  EXPECT_TRUE(tracker.finish().empty());
}

TEST(StrokeTracker, StrokeEndsAtTheTipPositionNotAtTheLastSample) {
  StrokeTracker tracker;
  std::vector<ToolSample> ticks;
  for (int i = 0; i < 20; ++i) ticks.push_back(touching(i * kTick, i * 1e-4));
  (void)tracker.feed(ticks, kDown);
  const auto last = tracker.finish();
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].ends);
  ASSERT_EQ(last[0].samples.size(), 1u);
  EXPECT_DOUBLE_EQ(last[0].samples[0].position.x(), 19e-4);
}

TEST(StrokeTracker, BriefLossContinuesTheStrokeAndLongerLossStartsAnother) {
  StrokeTracker tracker;
  std::vector<ToolSample> ticks = contact(0, 0.05);
  for (double t = 0.05; t < 0.07; t += kTick) ticks.push_back(away(t));
  for (const ToolSample& tick : contact(0.07, 0.1)) ticks.push_back(tick);
  auto pieces = tracker.feed(ticks, kDown);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_FALSE(pieces[0].ends);
  ticks.clear();
  for (double t = 0.1; t < 0.15; t += kTick) ticks.push_back(away(t));
  for (const ToolSample& tick : contact(0.15, 0.2)) ticks.push_back(tick);
  pieces = tracker.feed(ticks, kDown);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_TRUE(pieces[0].ends);
  EXPECT_TRUE(pieces[1].begins);
}

TEST(StrokeTracker, ApproachingTipPaintsNothing) {
  StrokeTracker tracker;
  std::vector<ToolSample> ticks;
  for (int i = 0; i < 20; ++i) ticks.push_back(touching(i * kTick, 0.05 - 0.0025 * i));
  auto pieces = tracker.feed(ticks, kDown); // finally 2.5 mm away
  EXPECT_TRUE(pieces.empty());
  pieces = tracker.feed(std::vector<ToolSample>{touching(0.021, 0.0005)}, kDown);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].begins);
}

TEST(StrokeTracker, ContactWithoutTheButtonPaintsNothing) {
  StrokeTracker tracker;
  EXPECT_TRUE(tracker.feed(contact(0, 0.2), {}).empty());
}

// Ticks of a device with these buttons.
std::vector<ToolSample> held(std::vector<ToolSample> ticks, unsigned buttons) {
  for (ToolSample& tick : ticks) tick.buttons = static_cast<std::uint8_t>(buttons);
  return ticks;
}
const StrokeTracker::Hand kDevice{.near = 1e-3, .device = true};

TEST(StrokeTracker, DevicePaintsOnContactWhileItsFirstButtonIsHeld) {
  StrokeTracker tracker;
  EXPECT_EQ(count(tracker.feed(held(contact(0, 0.05), 2), kDevice)), 0u) << "another button";
  auto ticks = contact(0.05, 0.1);
  for (ToolSample& tick : ticks) tick.surface.x() = 5; // far from any aim of the pointer
  const auto first = tracker.feed(held(ticks, 1), kDevice);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(first[0].begins);
  EXPECT_TRUE(tracker.feed({}, kDevice).empty()) << "no news of the device is no end";
  EXPECT_TRUE(tracker.painting());
  const auto last = tracker.feed(held(contact(0.1, 0.11), 0), kDevice);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].ends);
}

TEST(StrokeTracker, DeviceButtonPaintsNothingIfNotAllowed) {
  StrokeTracker tracker;
  EXPECT_TRUE(tracker.feed(held(contact(0, 0.1), 1), {}).empty());
}

TEST(StrokeTracker, CancelledStrokeRestartsOnlyAfterTheButtonIsReleased) {
  StrokeTracker tracker;
  tracker.feed(held(contact(0, 0.05), 1), kDevice);
  tracker.cancel();
  EXPECT_TRUE(tracker.feed(held(contact(0.05, 0.1), 1), kDevice).empty());
  EXPECT_TRUE(tracker.feed(held(contact(0.1, 0.11), 0), kDevice).empty());
  EXPECT_FALSE(tracker.feed(held(contact(0.11, 0.12), 1), kDevice).empty());
}

TEST(StrokeTracker, FinishEndsAStrokeWithAnyButtonHeld) {
  StrokeTracker tracker;
  tracker.feed(held(contact(0, 0.05), 1), kDevice);
  const auto pieces = tracker.finish();
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].ends);
  EXPECT_TRUE(tracker.finish().empty());
}

} // namespace
} // namespace patina
