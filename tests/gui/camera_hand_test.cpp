// A SpaceMouse in the window: its driver over the emulated wire moves the camera, using the
// window's ticks only.

#include <atomic>
#include <thread>

#include <QAction>

#include "app/gui/control/view_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/spacemouse/emulated_spacemouse.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

class CameraHandTest : public WindowTest {
 protected:
  ViewController& views() { return window_->controllers().view; }
  vtkCamera& camera() { return *view().view().renderer().GetActiveCamera(); }
  Vec3 eye() { return Vec3(camera().GetPosition()) - Vec3(camera().GetFocalPoint()); }
  Vec3 right() { return Vec3(camera().GetViewUp()).cross(eye()).normalized(); }
};

TEST_F(CameraHandTest, ShiftsZoomsTurnsAndRollsTheView) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  struct Axes {
    std::atomic<double> of[6] = {};
  };
  const auto axes = std::make_shared<Axes>();
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [axes](double) {
    CapState state;
    for (int i = 0; i < 3; ++i) {
      state.translation[i] = axes->of[i];
      state.rotation[i] = axes->of[3 + i];
    }
    return state;
  };
  views().setCameraHand(
      std::make_unique<CameraHand>([=] { return emulateSpaceMouse(cap, systemClock()); }));
  const auto still = [&] {
    const CameraState place = placeOf(camera());
    wait(300);
    return placeOf(camera()) == place;
  };
  ASSERT_TRUE(waitUntil(still, 10000)) << "a cap at rest moves nothing";
  // Returns the motion after the cap was pushed or turned by a quarter of its range for a while.
  const auto push = [&](int axis, double counts) {
    axes->of[axis] = counts;
    wait(400);
    axes->of[axis] = 0;
    EXPECT_TRUE(waitUntil(still, 5000)) << "a cap that is let go";
  };
  Vec3 before(camera().GetFocalPoint()), side = right();
  push(0, 90);
  EXPECT_LT((Vec3(camera().GetFocalPoint()) - before).dot(side), -1e-3)
      << "the object moves to the right";
  before = Vec3(camera().GetFocalPoint());
  push(1, 90);
  EXPECT_LT((Vec3(camera().GetFocalPoint()) - before).dot(Vec3(camera().GetViewUp())), -1e-3);
  const double distance = camera().GetDistance();
  push(2, 90);
  EXPECT_LT(camera().GetDistance(), 0.98 * distance) << "and towards the eye";
  const Vec3 from = eye(), up(camera().GetViewUp());
  side = right();
  push(4, 90);
  EXPECT_LT(eye().dot(side), -0.02 * from.norm()) << "its front turns to the right";
  const double high = eye().normalized().dot(up);
  push(3, 90);
  EXPECT_GT(eye().normalized().dot(up), high + 0.02) << "and downwards";
  const Vec3 level(camera().GetViewUp());
  side = right();
  push(5, 90);
  EXPECT_GT(Vec3(camera().GetViewUp()).dot(side), 0.02) << "and counter-clockwise";
  EXPECT_LT(Vec3(camera().GetViewUp()).dot(level), 1);

  cap->attached = false;
  axes->of[0] = 90;
  EXPECT_TRUE(waitUntil(still, 5000)) << "it is unplugged";
}

TEST_F(CameraHandTest, IsChosenInTheMenuAndReportsAMissingDevice) {
  if (IsSkipped()) return;
  auto* messages = find<MessagePanel>();
  const auto notified = [&] {
    for (int i = 0; i < messages->count(); ++i)
      if (messages->item(i)->text().contains("SpaceMouse") ||
          messages->item(i)->text().contains("USB"))
        return true;
    return false;
  };
  EXPECT_FALSE(notified());
  trigger("camera_hand");
  EXPECT_TRUE(waitUntil(notified, 10000)) << "none is attached to a machine that builds";
  trigger("camera_hand");
  wait(100);
}

// The scene names the device: it then moves the tip.
TEST(SpaceMouseDevice, MovesTheTipInProportionToThePush) {
  const DeviceEntry& entry = deviceNamed("sim:spacemouse");
  DeviceSetup setup;
  const auto target = std::make_shared<TipTarget>(Vec3::Zero());
  setup.target = target;
  const auto device = openDevice(entry, setup, mountAt(entry, Vec3::Zero()));
  target->set(Vec3(0.02, 0, 0.01));
  Vec3 tip = Vec3::Zero();
  double fastest = 0;
  for (int i = 0; i < 3000 && (tip - Vec3(0.02, 0, 0.01)).norm() > 1e-3; ++i) {
    const DeviceState state = device->exchange(Vec3::Zero(), 1e-3);
    if (effectiveStatus(state) == DeviceStatus::ok) {
      tip = state.position;
      fastest = std::max(fastest, state.velocity.value_or(Vec3::Zero()).cwiseAbs().maxCoeff());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT((tip - Vec3(0.02, 0, 0.01)).norm(), 1e-3);
  EXPECT_LE(fastest, 1.001 * SpaceMouseSpec{}.speed);
}

} // namespace
} // namespace patina
