// An hour of work by pointer and keys holds as much memory as its first minutes.
#include <chrono>
#include <cstdio>
#include <vector>

#include "app/gui/control/desk_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/resident.h"

namespace patina {
namespace {

class LongSession : public DrivenWindow {};

// Paints with each tool, undoes it and visits every desk, again and again. The long form takes an
// hour (PATINA_LONG), or PATINA_MINUTES.
TEST_F(LongSession, MemoryIsLevelOverPaintingUndoAndDesks) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  saving().saveTo(QString::fromStdString((folder_ / "ws").string()));
  const double seconds = test::longSeconds(1, 3600);
  std::vector<std::size_t> resident;
  std::size_t strokes = 0;
  const DeskController& desks = window_->controllers().desks;
  const auto begin = std::chrono::steady_clock::now();
  const auto gone = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const std::vector<const char*> tools{"tool_color", "tool_relief", "tool_stiffness"};
  for (std::size_t round = 0; round < 4 || gone() < seconds; ++round) {
    type('5', kControl); // Paint
    wait(50);
    trigger(tools[round % tools.size()]);
    wait(100);
    const std::size_t before = edits().status().done;
    for (const int high : {-30, 30}) {
      drag(inView({-60, high}), inView({60, high}), 1, 10);
      wait(100);
    }
    ASSERT_TRUE(waitUntil([&] { return !edits().thread().busy(); }));
    QApplication::processEvents();
    strokes += edits().status().done - before;
    while (edits().status().done > before) {
      const std::size_t done = edits().status().done;
      type('z', kControl);
      ASSERT_TRUE(waitUntil([&] { return edits().status().done < done; }));
    }
    std::uint32_t key = '1';
    for (const DeskRow& row : deskRows()) {
      type(key++, kControl);
      EXPECT_TRUE(waitUntil([&] { return desks.desk() == row.desk; }, 5000)) << row.name;
    }
    resident.push_back(test::residentBytes());
  }
  std::printf("%zu strokes in %zu rounds\n", strokes, resident.size());
  EXPECT_GT(strokes, resident.size());
  // The first rounds hold the first use of each tool on each desk, which stays in memory.
  EXPECT_LT(test::growth(resident), resident.size() < 100 ? 60e6 : 6e6);
}

} // namespace
} // namespace patina
