// Ten minutes of painting: memory within its budget, every bit of it undone and done again.
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "app/editor.h"
#include "app/session.h"
#include "geometry/shapes.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;
constexpr double kRate = 30;  // [Hz] of dabs
constexpr int kStrokes = 120; // of 5 s each
constexpr int kDabs = 5 * 30; // a stroke
constexpr std::size_t kBudget = 10u << 20;

std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

Stroke strokeOf(int index) {
  constexpr Tool kTools[]{Tool::color, Tool::relief, Tool::stiffness, Tool::static_friction};
  Stroke stroke;
  stroke.brush.tool = kTools[index % 4];
  stroke.brush.color = {0.1 * (index % 10), 0.5, 1 - 0.1 * (index % 10)};
  stroke.brush.value = index % 4 == 1 ? 2e-4 : index % 4 == 2 ? 300 + 5 * index : 0.4;
  stroke.brush.radius = 0.003;
  if (index % 3 == 0) stroke.brush.mode = StrokeMode::build_up;
  for (int i = 0; i < kDabs; ++i) {
    const double along = 2 * std::numbers::pi * i / kDabs;
    const double tilt = 0.4 + 0.02 * index;
    const Vec3 n(std::cos(along) * std::sin(tilt), std::sin(along) * std::sin(tilt),
                 std::cos(tilt));
    stroke.samples.push_back({i / kRate, kRadius * n, 1});
  }
  return stroke;
}

void expectSame(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const auto& left = a.objects[i].paint;
    const auto& right = b.objects[i].paint;
    if (!left || !right)
      EXPECT_EQ(left, right);
    else
      EXPECT_TRUE(same(*left, *right));
  }
}

TEST(LongPainting, StaysWithinItsBudgetAndIsUndoneToTheFirstBit) {
  Progress progress;
  Scene start = sceneOf(icosphere(kRadius, 20), "ball");
  start.field.resolution = 80;
  Editor editor(start, progress, {}, kBudget);
  std::size_t after_ten = 0;
  for (int i = 0; i < kStrokes; ++i) {
    (void)editor.apply(strokeOf(i), progress);
    ASSERT_LE(editor.history().bytes(), kBudget) << i;
    if (i == 9) after_ten = residentBytes();
  }
  ASSERT_EQ(editor.history().undoable(), std::size_t{kStrokes});
  EXPECT_LT(editor.history().scenes(), std::size_t{kStrokes}) << "the budget was never reached";
  // Scenes beyond the first ten may fill the budget, and nothing else may grow.
  EXPECT_LT(residentBytes(), after_ten + kBudget + (32u << 20));

  const Scene end = editor.scene();
  EXPECT_EQ(editor.undo(kStrokes, progress), std::size_t{kStrokes});
  expectSame(editor.scene(), start);
  EXPECT_EQ(editor.redo(kStrokes, progress), std::size_t{kStrokes});
  expectSame(editor.scene(), end);
  // A scene that was thinned out is replayed to the same bits as when it was first painted.
  Editor fresh(start, progress, {}, kBudget);
  for (int i = 0; i < 20; ++i) (void)fresh.apply(strokeOf(i), progress);
  EXPECT_EQ(editor.undo(kStrokes - 20, progress), std::size_t{kStrokes - 20});
  expectSame(editor.scene(), fresh.scene());
}

} // namespace
} // namespace patina
