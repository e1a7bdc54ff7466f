// The servo in the window: any thread publishes, and loops come and go meanwhile.
#include "haptics/servo/tip_servo.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "haptics/simulation/simulated_hand.h"

namespace patina {
namespace {

constexpr double kRadius = 0.02;

std::shared_ptr<const SurfaceField> ball() {
  FieldSpec spec;
  spec.resolution = 40;
  const FieldGrid grid = gridAround(Box3(Vec3::Constant(-kRadius), Vec3::Constant(kRadius)), spec);
  return withSamples(std::make_shared<const SurfaceField>(
      sampleFunction([](const Vec3& p) { return p.norm() - kRadius; }, grid, spec.band)));
}

std::shared_ptr<const HapticSnapshot> ofStiffness(double stiffness,
                                                  std::shared_ptr<const SurfaceField> field) {
  Scene scene;
  scene.haptics.stiffness = stiffness;
  return compileStages(scene, std::move(field));
}

void openAt(TipServo& servo, const Vec3& place) {
  const auto target = std::make_shared<TipTarget>(place);
  servo.open(makeMouse(target), target);
}

double forceSoon(TipServo& servo) {
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  const auto samples = servo.drain();
  return samples.empty() ? -1 : samples.back().force.norm();
}

TEST(TipServo, NewLoopRendersTheLastSnapshot) {
  const auto first = ball();
  TipServo servo;
  servo.publish(ofStiffness(500, first));
  servo.publish(ofStiffness(1000, first));
  openAt(servo, Vec3(0.019, 0, 0));
  EXPECT_NEAR(forceSoon(servo), 1.0, 0.05);
  servo.close();
  servo.publish(ofStiffness(300, first));
  openAt(servo, Vec3(0.019, 0, 0));
  EXPECT_NEAR(forceSoon(servo), 0.3, 0.02);
}

TEST(TipServo, TargetMovesTheTipOfTheOpenLoop) {
  TipServo servo;
  servo.setTarget(Vec3(1, 1, 1)); // no loop exists to move
  openAt(servo, Vec3(0.03, 0, 0));
  servo.setTarget(Vec3(0.03, 0, 0.01));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT((servo.drain().back().tip - Vec3(0.03, 0, 0.01)).norm(), 1e-6);
}

TEST(TipServo, JumpThroughABallHasNoForce) {
  TipServo servo;
  servo.publish(ofStiffness(500, ball()));
  openAt(servo, Vec3(0.021, 0, 0));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  (void)servo.drain();
  servo.jumpTarget(Vec3(-0.021, 0, 0), 1);
  servo.addWaypoint(Vec3(-0.019, 0, 0), 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const std::vector<ToolSample> samples = servo.drain();
  ASSERT_FALSE(samples.empty());
  for (const ToolSample& sample : samples) {
    EXPECT_GE(std::abs(sample.tip.x()), 0.0189);
    EXPECT_LE(sample.force.norm(), 0.51);
    EXPECT_TRUE(sample.tip.x() < 0 || sample.force.norm() == 0);
  }
  EXPECT_NEAR(samples.back().force.x(), -0.5, 0.02);
}

TEST(TipServo, OtherThreadMayPublishWhileLoopsComeAndGo) { // T-K20; for the thread sanitizer
  const auto field = ball();
  TipServo servo;
  std::atomic<bool> done{false};
  std::atomic<int> published{0};
  std::thread edits([&] {
    for (int i = 0; !done; ++i, ++published) servo.publish(ofStiffness(500 + 10 * (i % 50), field));
  });
  for (int i = 0; i < 6; ++i) {
    openAt(servo, Vec3(0.019, 0, 0));
    for (int drains = 0; drains < 10; ++drains) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      for (const ToolSample& sample : servo.drain()) {
        ASSERT_TRUE(sample.force.allFinite());
        ASSERT_LT(sample.force.norm(), 1.2);
      }
    }
    servo.close();
  }
  done = true;
  edits.join();
  EXPECT_GT(published, 10);
}

TEST(TipServo, DrainingFreesUnusedSnapshots) {
  TipServo servo;
  openAt(servo, Vec3(0.03, 0, 0));
  const auto field = ball();
  std::weak_ptr<const HapticSnapshot> first;
  {
    const auto snapshot = ofStiffness(500, field);
    first = snapshot;
    servo.publish(snapshot);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20)); // the force acts
  servo.publish(ofStiffness(600, field));
  for (int i = 0; i < 1000 && !first.expired(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    servo.drain();
  }
  EXPECT_TRUE(first.expired());
}

} // namespace
} // namespace patina
