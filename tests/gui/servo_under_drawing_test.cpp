// Drawing must not starve the servo.
#include <cstdio>

#include "geometry/shapes.h"
#include "gui/load_average.h"
#include "gui/window_fixture.h"
#include "visualization/camera.h"

namespace patina {
namespace {

class ServoUnderDrawing : public WindowTest {
 protected:
  ServoTiming drawFor(int milliseconds) {
    double longest = 0, sum = 0;
    int frames = 0;
    QElapsedTimer clock;
    clock.start();
    while (clock.elapsed() < milliseconds) {
      orbit(*view().view().renderer().GetActiveCamera(), 0.004, 0);
      if (view().refresh()) {
        longest = std::max(longest, view().frameSeconds());
        sum += view().frameSeconds();
        ++frames;
      }
      QApplication::processEvents(QEventLoop::AllEvents, 1);
    }
    const ServoTiming timing = window_->feel().timing();
    std::printf(
        "%d frames, mean %.0f ms, longest %.0f ms; servo %s: late p99 %.0f us, p99.9 %.0f us, "
        "missed %llu of %llu\n",
        frames, 1000 * sum / frames, 1000 * longest, timing.policy.c_str(), timing.late_p99,
        timing.late_p999, static_cast<unsigned long long>(timing.missed),
        static_cast<unsigned long long>(timing.ticks));
    return timing;
  }
};

TEST_F(ServoUnderDrawing, WakesInTimeWhileTheWindowDraws500000Triangles) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 158), "sphere.ply"))); // 499,280 triangles
  // A virtual machine's host takes a millisecond now and then, whatever runs here: up to three
  // passes, the later ones long enough that the 8192 ticks judged are their own.
  ServoTiming timing;
  for (const int milliseconds : {4000, 9000, 9000}) {
    timing = drawFor(milliseconds);
    if (!timing.realtime || (timing.late_p99 <= 100 && timing.late_p999 <= 500)) break;
  }
  EXPECT_GT(surfaceShare(), 0.1);
  if (!timing.realtime)
    GTEST_SKIP() << "no real-time priority here (" << timing.policy
                 << "): lateness is shown and not judged";
  const bool holds = timing.late_p99 <= 100 && timing.late_p999 <= 500;
  if (!holds && machineIsCrowded())
    GTEST_SKIP() << "more runs here than there are processors: lateness is shown and not judged";
  EXPECT_LE(timing.late_p99, 100);
  EXPECT_LE(timing.late_p999, 500);
}

} // namespace
} // namespace patina
