#include "haptics/catalog/device_catalog.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "haptics/device/tip_target.h"
#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_device.h"
#include "haptics/link/linked_device.h"
#include "haptics/plugin/plugin_device.h"
#include "haptics/plugin/plugin_library.h"
#include "haptics/simulation/simulated_hand.h"
#include "haptics/spacemouse/emulated_spacemouse.h"
#include "haptics/spacemouse/spacemouse.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

// Real drivers on emulated devices that a pointer moves: `device = sim:falcon`.

struct PointerDrivenFalcon {
  PointerDrivenFalcon(std::shared_ptr<const TipTarget> target, std::shared_ptr<DeviceClock> clock)
      : emulator({.body = {.mass = 0.25, .damping = 11, .spring = 200, .friction = 0.05}}, clock),
        hand(std::move(target)), start(hand.position()), led_at(clock->now()) {
    emulator.on_frame = [this](double t, const std::array<int, 3>&) {
      const Vec3 most = kFalconWorkspace.max();
      emulator.rest =
          (hand.follow(std::clamp(t - led_at, 0.0, 0.01)) - start).cwiseMax(-most).cwiseMin(most);
      led_at = t;
    };
  }
  FalconEmulator emulator;
  SpeedLimitedTip hand;
  Vec3 start;
  double led_at;
};

struct PointerDrivenPuck {
  explicit PointerDrivenPuck(std::shared_ptr<const TipTarget> target)
      : hand(std::move(target)), start(hand.position()), tip(start) {}
  // Proportional hand control: the cap's deflection grows with the distance to the target.
  CapState push(double t) {
    const double dt = led_at < 0 ? 0 : std::clamp(t - led_at, 0.0, 0.02);
    led_at = t;
    tip += dt * speed;
    CapState cap;
    cap.translation = 4 / SpaceMouseSpec{}.speed * kSpaceMouseFull * (hand.follow(dt) - tip);
    cap.translation = cap.translation.cwiseMax(-kSpaceMouseFull).cwiseMin(kSpaceMouseFull);
    cap.translation = cap.translation.array().round();
    for (int i = 0; i < 3; ++i) {
      const double past = std::max(std::abs(cap.translation[i]) - kSpaceMouseDead, 0.0);
      speed[i] = std::copysign(SpaceMouseSpec{}.speed * past / (kSpaceMouseFull - kSpaceMouseDead),
                               cap.translation[i]);
    }
    return cap;
  }
  SpeedLimitedTip hand;
  Vec3 start, tip, speed = Vec3::Zero();
  double led_at = -1;
};

// The hand's spring follows the target, whose start is the centre of the workspace.
std::unique_ptr<Device> makeEmulatedFalcon(std::shared_ptr<const TipTarget> target,
                                           std::shared_ptr<LinkStatistics> notes) {
  const LinkedSpec spec{.guard = falconGuard(), .notes = std::move(notes)};
  const auto led = std::make_shared<PointerDrivenFalcon>(std::move(target), spec.clock);
  return makeLinkedDevice(makeFalconLink([led] { return led->emulator.plug(); }, {}, spec.clock),
                          spec);
}

// The hand pushes the cap until the tip reaches the target.
std::unique_ptr<Device> makeEmulatedSpaceMouse(std::shared_ptr<const TipTarget> target,
                                               std::shared_ptr<LinkStatistics> notes) {
  const LinkedSpec spec{.notes = std::move(notes)};
  const auto led = std::make_shared<PointerDrivenPuck>(std::move(target));
  const auto cap = std::make_shared<EmulatedCap>();
  cap->hand = [led](double t) { return led->push(t); };
  return makeLinkedDevice(
      makeSpaceMouseLink([cap, clock = spec.clock] { return emulateSpaceMouse(cap, clock); },
                         {.start = led->start}, spec.clock),
      spec);
}

constexpr DeviceLimits kNoForce{.max_force = 0, .max_stiffness = 0};
constexpr std::string_view kFalcon = "Novint Falcon", kSpaceMouse = "3Dconnexion SpaceMouse";

const DeviceLimits kFalconLimits{.workspace = kFalconWorkspace,
                                 .max_force = falconGuard().max_force};
// Handle and hand together, as emulated; the maker publishes no values.
constexpr DeviceModel kFalconModel{.mass = 0.25, .damping = 3, .encoder_step = 4e-5, .delay = 1};

std::unique_ptr<Device> openFalcon(const DeviceSetup& setup) {
  const LinkedSpec spec{.guard = falconGuard(), .notes = setup.notes};
  return makeLinkedDevice(makeFalconLink(usbOpener(kFalcon), falconFirmwareSource(), spec.clock),
                          spec);
}

std::unique_ptr<Device> openSpaceMouse(const DeviceSetup& setup) {
  const LinkedSpec spec{.notes = setup.notes};
  const SpeedLimitedTip tip(setup.target);
  return makeLinkedDevice(
      makeSpaceMouseLink(usbOpener(kSpaceMouse), {.start = tip.position()}, spec.clock), spec);
}

// One row per device, in the order shown to the user.
const DeviceEntry kCatalog[] = {
    {.name = "mouse",
     .caption = "Mouse",
     .note = "position only, no force: the tip follows the pointer, the drawn tool stays on the "
             "surface",
     .limits = kNoForce,
     .open = [](const DeviceSetup& setup) { return makeMouse(setup.target); }},
    {.name = "simulated",
     .caption = "Simulated device",
     .note = "a simulated mass held by a simulated hand; it rests where the forces are equal",
     .uses_device_model = true,
     .hand_compliance = 1 / HandSpec{}.stiffness,
     .open =
         [](const DeviceSetup& setup) {
           return makeSimulatedHand(setup.target, HandSpec{.device = setup.model});
         }},
    {.name = "falcon",
     .caption = "Novint Falcon",
     .note = "three motors on a delta robot; its firmware is a file of its maker's, named by "
             "PATINA_FALCON_FIRMWARE",
     .usb = kFalcon,
     .linked = true,
     .model = kFalconModel,
     .limits = kFalconLimits,
     .open = &openFalcon},
    {.name = "spacemouse",
     .caption = "SpaceMouse",
     .note = "position only, no force: the tip moves as fast as the cap is pushed",
     .usb = kSpaceMouse,
     .linked = true,
     .limits = kNoForce,
     .open = &openSpaceMouse},
    {.name = "sim:falcon",
     .caption = "Emulated Falcon",
     .note = "the Falcon's driver over an emulated wire, its handle led by the pointer",
     .linked = true,
     .model = kFalconModel,
     .limits = kFalconLimits,
     .open =
         [](const DeviceSetup& setup) { return makeEmulatedFalcon(setup.target, setup.notes); }},
    {.name = "sim:spacemouse",
     .caption = "Emulated SpaceMouse",
     .note = "the SpaceMouse's driver over an emulated wire, its cap led by the pointer",
     .linked = true,
     .limits = kNoForce,
     .open =
         [](const DeviceSetup& setup) {
           return makeEmulatedSpaceMouse(setup.target, setup.notes);
         }},
    {.name = "replay",
     .caption = "Replayed hand",
     .note = "plays a recorded tip path",
     .selectable = false,
     .limits = kNoForce,
     .open = [](const DeviceSetup& setup) { return makeReplayedHand(setup.path); }},
};

// Not in the catalogue, because each plug-in has its own name.
const DeviceEntry kPlugin{.name = "plugin",
                          .caption = "Plug-in",
                          .note = "a library of its maker's drives it",
                          .linked = true,
                          .open = [](const DeviceSetup& setup) {
                            return makePluginDevice(setup.name, {.notes = setup.notes});
                          }};

} // namespace

std::span<const DeviceEntry> deviceCatalog() {
  return kCatalog;
}

const DeviceEntry& deviceNamed(std::string_view name) {
  if (isPlugin(name)) return (void)pluginName(name), kPlugin;
  std::string known;
  for (const DeviceEntry& entry : kCatalog) {
    if (!entry.selectable) continue;
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : " or ") + std::string(entry.name);
  }
  throw Error("device = " + std::string(name) + ": it must be " + known + " or plugin:NAME");
}

MountSpec mountAt(const DeviceEntry& entry, const Vec3& place) {
  MountSpec mount;
  if (entry.limits.workspace) mount.world_from_device.translation() = place;
  return mount;
}

std::unique_ptr<Device> openDevice(const DeviceEntry& entry, const DeviceSetup& setup,
                                   MountSpec mount, std::shared_ptr<const MountControls> controls) {
  if (entry.limits.max_force.value_or(0) > 0)
    mount.max_force = std::min(mount.max_force, *entry.limits.max_force);
  return mountDevice(entry.open(setup), mount, std::move(controls));
}

} // namespace patina
