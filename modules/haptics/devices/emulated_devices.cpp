#include "haptics/devices/emulated_devices.h"

#include <algorithm>
#include <cmath>

#include "haptics/devices/falcon/emulated_falcon.h"
#include "haptics/devices/falcon/falcon_device.h"
#include "haptics/devices/spacemouse/emulated_spacemouse.h"

namespace patina {
namespace {

struct LedFalcon {
  LedFalcon(std::shared_ptr<const TipTarget> target, std::shared_ptr<DeviceClock> clock)
      : bench({.body = {.mass = 0.25, .damping = 11, .spring = 200, .friction = 0.05}}, clock),
        hand(std::move(target)), start(hand.position()), led_at(clock->now()) {
    bench.on_frame = [this](double t, const std::array<int, 3>&) {
      const Vec3 most = kFalconWorkspace.max();
      bench.rest =
          (hand.follow(std::clamp(t - led_at, 0.0, 0.01)) - start).cwiseMax(-most).cwiseMin(most);
      led_at = t;
    };
  }
  FalconBench bench;
  GlidingTip hand;
  Vec3 start;
  double led_at;
};

struct LedCap {
  explicit LedCap(std::shared_ptr<const TipTarget> target)
      : hand(std::move(target)), start(hand.position()), tip(start) {}
  // A hand that sees the tip, and pushes the more the further it has to go.
  CapState push(double t) {
    const double dt = led_at < 0 ? 0 : std::clamp(t - led_at, 0.0, 0.02);
    led_at = t;
    tip += dt * speed;
    CapState cap;
    cap.shift = 4 / SpaceMouseSpec{}.speed * kSpaceMouseFull * (hand.follow(dt) - tip);
    cap.shift = cap.shift.cwiseMax(-kSpaceMouseFull).cwiseMin(kSpaceMouseFull);
    cap.shift = cap.shift.array().round();
    for (int i = 0; i < 3; ++i) {
      const double past = std::max(std::abs(cap.shift[i]) - kSpaceMouseDead, 0.0);
      speed[i] = std::copysign(SpaceMouseSpec{}.speed * past / (kSpaceMouseFull - kSpaceMouseDead),
                               cap.shift[i]);
    }
    return cap;
  }
  GlidingTip hand;
  Vec3 start, tip, speed = Vec3::Zero();
  double led_at = -1;
};

} // namespace

std::unique_ptr<Device> makeEmulatedFalcon(std::shared_ptr<const TipTarget> target,
                                           std::shared_ptr<LinkNotes> notes) {
  const LinkedSpec spec{.guard = falconGuard(), .notes = std::move(notes)};
  const auto led = std::make_shared<LedFalcon>(std::move(target), spec.clock);
  return makeLinkedDevice(makeFalconLink([led] { return led->bench.plug(); }, {}, spec.clock),
                          spec);
}

std::unique_ptr<Device> makeEmulatedSpaceMouse(std::shared_ptr<const TipTarget> target,
                                               std::shared_ptr<LinkNotes> notes) {
  const LinkedSpec spec{.notes = std::move(notes)};
  const auto led = std::make_shared<LedCap>(std::move(target));
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [led](double t) { return led->push(t); };
  return makeLinkedDevice(
      makeSpaceMouseLink([cap, clock = spec.clock] { return emulateSpaceMouse(cap, clock); },
                         {.start = led->start}, spec.clock),
      spec);
}

} // namespace patina
