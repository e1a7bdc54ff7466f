// A press drag is drawn as quickly as a turn of the camera, whatever the mesh has of triangles.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <vtkCallbackCommand.h>

#include "app/gui/panels/tool_bar.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/longer.h"

namespace patina {
namespace {

using Clock = std::chrono::steady_clock;

class PressFrames : public DrivenWindow {
 protected:
  struct Rate {
    double per_second = 0;
    double longest = 0; // the longest gap without the longest hundredth [s]
  };
  // Drags with this button over the middle for two seconds, and counts the frames.
  Rate dragged(int button) {
    std::vector<Clock::time_point> frames;
    const unsigned long observer =
        view().renderWindow()->AddObserver(vtkCommand::EndEvent, Note{&frames}.command(), 0);
    pointAt(inView({-40, 0}));
    press(button);
    wait(400);
    frames.clear();
    const auto begun = Clock::now();
    while (Clock::now() - begun < std::chrono::seconds(2)) {
      const double turn = 3 * std::chrono::duration<double>(Clock::now() - begun).count();
      const QPoint at = inView({int(-40 * std::cos(turn)), int(40 * std::sin(turn))});
      const double scale = window_->devicePixelRatioF();
      hand_->moveTo(qRound(scale * at.x()), qRound(scale * at.y()));
      wait(4);
    }
    release(button);
    view().renderWindow()->RemoveObserver(observer);
    std::vector<double> gaps;
    for (std::size_t i = 1; i < frames.size(); ++i)
      gaps.push_back(std::chrono::duration<double>(frames[i] - frames[i - 1]).count());
    std::sort(gaps.begin(), gaps.end());
    if (gaps.empty()) return {};
    return {double(frames.size()) / 2, gaps[gaps.size() * 99 / 100]};
  }
  struct Note {
    std::vector<Clock::time_point>* frames;
    vtkSmartPointer<vtkCallbackCommand> command() const {
      auto made = vtkSmartPointer<vtkCallbackCommand>::New();
      made->SetClientData(frames);
      made->SetCallback([](vtkObject*, unsigned long, void* into, void*) {
        static_cast<std::vector<Clock::time_point>*>(into)->push_back(Clock::now());
      });
      return made;
    }
  };
};

// Rates of a program beside others are no measure; those of both drags share what is beside.
TEST_F(PressFrames, AreAsManyAsThoseOfACameraTurn) {
  std::vector<int> sizes = {59};            // 69,620 triangles
  if (test::isLong()) sizes.push_back(224); // a million
  for (const int size : sizes) {
    const TriangleMesh mesh = icosphere(0.05, size);
    ASSERT_TRUE(open(saved(mesh, "ball" + std::to_string(size) + ".ply")));
    ASSERT_TRUE(waitUntil([&] { return feel().servo().running(); }, 60000));
    wait(1000);
    find<ToolBar>()->choose({.handling = InteractionMode::press});
    double best = 0;
    for (int repeat = 0; repeat < 5 && best < 0.9; ++repeat) {
      const Rate turn = dragged(2), press = dragged(1);
      std::printf("%zu triangles: press %.1f frames/s, 99 %% of the gaps <= %.0f ms; camera %.1f\n",
                  mesh.triangles.size(), press.per_second, 1000 * press.longest, turn.per_second);
      best = std::max(best, press.per_second / std::max(1., turn.per_second));
    }
    EXPECT_GE(best, 0.9) << size;
  }
}

} // namespace
} // namespace patina
