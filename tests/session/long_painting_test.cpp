// Ten minutes of painting at 30 Hz, in simulated time: memory is bounded and no data is lost.
#include <gtest/gtest.h>

#include <fstream>

#include "session/edit/editor.h"
#include "session/painted_scenes.h"
#include "support/sanitized.h"

namespace patina {
namespace {

using namespace test;

std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * 4096;
}

// A stroke of three seconds around the ball.
Stroke walk(int number) {
  const std::pair<Tool, double> tools[] = {
      {Tool::relief, 3e-4},
      {Tool::material(MaterialChannel::stiffness), 900},
      {Tool::color, 0},
      {Tool::material(MaterialChannel::dynamic_friction), 0.3}};
  const auto& [tool, value] = tools[static_cast<std::size_t>(number) % 4];
  Stroke stroke = dabAt(tool, value, 0.003, Vec3::Zero());
  stroke.samples.clear();
  const Vec3 axis = Vec3(std::sin(number), std::cos(1.7 * number), std::sin(2.3 * number));
  const Vec3 start = kBall * axis.unitOrthogonal();
  for (int i = 0; i < 90; ++i) {
    const Eigen::AngleAxisd turn(0.02 * i, axis.normalized());
    stroke.samples.push_back({i / 30.0, turn * start, 0.5});
  }
  return stroke;
}

TEST(LongPainting, TenMinutesStayWithinTheBudgetAndUndoToTheStart) {
  Progress progress;
  constexpr std::size_t kBudget = std::size_t{8} << 20;
  const int strokes = kSanitized ? 20 : 200;
  const Scene start = ballScene();
  Editor editor(start, progress, {}, kBudget);
  std::vector<std::pair<std::size_t, Scene>> some;
  std::size_t settled = 0;
  for (int i = 0; i < strokes; ++i) {
    editor.apply(walk(i), progress);
    ASSERT_LE(editor.history().bytes(), kBudget) << i;
    if (i % 40 == 13) some.emplace_back(editor.history().undoable(), editor.scene());
    if (i == strokes / 4) settled = residentBytes();
  }
  EXPECT_EQ(editor.history().undoable(), static_cast<std::size_t>(strokes));
  if (!kSanitized) {
    EXPECT_LT(editor.history().scenes(), static_cast<std::size_t>(strokes))
        << "nothing was thinned";
  }
  const Scene end = editor.scene();
  // Later growth comes from the history, which is bounded, and from the strokes themselves.
  EXPECT_LE(residentBytes(), settled + 3 * kBudget);
  for (const auto& [position, scene] : some)
    EXPECT_TRUE(same(editor.history().sceneAt(position), scene)) << position;
  EXPECT_EQ(editor.undo(100000, progress), static_cast<std::size_t>(strokes));
  EXPECT_TRUE(same(editor.scene(), start));
  EXPECT_FALSE(editor.scene().objects[0].paint);
  EXPECT_EQ(editor.redo(100000, progress), static_cast<std::size_t>(strokes));
  EXPECT_TRUE(same(editor.scene(), end));
}

} // namespace
} // namespace patina
