// The servo's host: any thread publishes, and loops come and go meanwhile.
#include "app/gui/servo/feel_host.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "geometry/mesh/shapes.h"
#include "session/build/compile_scene.h"

namespace patina {
namespace {

std::shared_ptr<const CompiledScene> ball() {
  Scene scene;
  scene.field.resolution = 40;
  scene.objects.push_back(
      {"ball", std::make_shared<const TriangleMesh>(icosphere(0.02, 6)), Pose::Identity(), {}});
  Progress progress;
  return compile(std::move(scene), progress);
}

std::shared_ptr<const CompiledScene> stiffer(const CompiledScene& compiled, double stiffness) {
  Scene scene = compiled.scene;
  scene.haptics.stiffness = stiffness;
  return retuned(compiled, std::move(scene));
}

double forceSoon(FeelHost& host) {
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  const auto samples = host.drain();
  return samples.empty() ? -1 : samples.back().force.norm();
}

TEST(FeelHost, ANewLoopFeelsWhatWasPublishedLast) {
  const auto first = ball();
  FeelHost host;
  host.publish(first->snapshot);
  host.publish(stiffer(*first, 1000)->snapshot);
  host.open(makeMouseDevice(Vec3(0.019, 0, 0)));
  EXPECT_NEAR(forceSoon(host), 1.0, 0.05);
  host.close();
  host.publish(stiffer(*first, 300)->snapshot);
  host.open(makeMouseDevice(Vec3(0.019, 0, 0)));
  EXPECT_NEAR(forceSoon(host), 0.3, 0.02);
}

TEST(FeelHost, AnotherThreadPublishesWhileLoopsComeAndGo) { // T-K20; for the thread sanitizer
  const auto compiled = ball();
  FeelHost host;
  std::atomic<bool> done{false};
  std::atomic<int> published{0};
  std::thread edits([&] {
    for (int i = 0; !done; ++i, ++published)
      host.publish(stiffer(*compiled, 500 + 10 * (i % 50))->snapshot);
  });
  for (int i = 0; i < 6; ++i) {
    host.open(makeMouseDevice(Vec3(0.019, 0, 0)));
    for (int drains = 0; drains < 10; ++drains) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      for (const ToolSample& sample : host.drain()) {
        ASSERT_TRUE(sample.force.allFinite());
        ASSERT_LT(sample.force.norm(), 1.2);
      }
    }
    host.close();
  }
  done = true;
  edits.join();
  EXPECT_GT(published, 10);
}

} // namespace
} // namespace patina
