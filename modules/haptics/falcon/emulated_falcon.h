// Emulated Falcon at the USB level: bridge, boot loader, firmware, encoders, motors, handle and
// hand, for tests and `--device sim:falcon`. Shares only device constants with the driver.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/types.h"
#include "haptics/link/device_clock.h"
#include "haptics/loop_model/zoh_integrator.h"
#include "usb/usb_transport.h"

namespace patina {

// Injected protocol faults; FalconEmulator::Faults sets the number of frames.
enum class WireFault : std::uint8_t {
  none,
  stall,        // the endpoint stalls
  mute,         // no reply
  shortened,    // 11 bytes of 16
  corrupt,      // an invalid byte
  flipped,      // a high bit of an encoder inverted
  late,         // 8 ms delay
  repeated,     // sent twice at once
  stale,        // the previous reply, then the current one
  out_of_order, // withheld until the next one was sent
  noise,        // random bytes
  homing_lost,  // the axes lose their homing
};

struct FalconEmulatorSpec {
  // Handle and hand on each axis, with the hand's mass and damping and its spring to `rest`.
  Oscillator body{.mass = 0.25, .damping = 3, .spring = 60, .friction = 0};
  double backlash = 0;            // dead zone of each thigh's gear [rad]
  double answer = 220e-6;         // from a frame to its reply [s]
  double homing_time = 0.15;      // time until the hand has moved every axis over its index [s]
  std::uint8_t homing_bit = 0x01; // homing bit that this firmware accepts
  bool runs_firmware = true;
  bool homed = true;
  std::vector<std::byte> firmware{}; // image that the boot loader accepts; empty: rejects all
  double chunk_loss = 0;             // share of chunks that are lost
  double chunk_late = 0;             // share of chunks echoed up to 150 ms late
  unsigned seed = 1;
};

// The device; transports are created as it is plugged in. Uses one clock. One thread at a time.
class FalconEmulator {
 public:
  FalconEmulator(const FalconEmulatorSpec& spec, std::shared_ptr<DeviceClock> clock);

  // Throws DeviceError while not attached. The emulator must outlive the transport.
  std::unique_ptr<UsbTransport> plug();
  void unplug() noexcept { attached_ = false; } // existing transports fail from now on
  void attach() noexcept { attached_ = true; }
  bool attached() const noexcept { return attached_; }

  struct Faults {
    WireFault kind = WireFault::none;
    int frames = 0;
  } faults;
  Vec3 rest = Vec3::Zero(); // rest position of the hand's spring, device frame [m]
  Vec3 push = Vec3::Zero(); // additional force of the hand [N]
  unsigned buttons = 0;     // bit i: button i of the four is down
  std::function<void(double t, const std::array<int, 3>& motors)>
      on_frame{}; // called for each complete frame

  // Advances to the present and returns the handle's position, device frame [m].
  Vec3 handle() noexcept;
  Vec3 velocity() const noexcept;
  Vec3 motorForce() const noexcept { return force_; } // at the handle, now [N]
  std::uint64_t frames() const noexcept { return frames_; }
  bool runsFirmware() const noexcept { return runs_; }
  void loseFirmware() noexcept { runs_ = false; }
  void loseHoming() noexcept;

 private:
  friend class EmulatedFalconTransport;
  struct Pending {
    double due;
    std::vector<std::byte> bytes;
  };

  void control(std::uint8_t request, std::uint16_t value) noexcept;
  UsbResult write(std::span<const std::byte> data);
  UsbCount read(std::span<std::byte> data, unsigned timeout_ms);
  void boot(std::span<const std::byte> data);
  void frame(std::span<const std::byte> data);
  std::vector<std::byte> answer();
  void corrupt(std::vector<std::byte> bytes);
  void reply(std::vector<std::byte> bytes, double after);
  void advance() noexcept;
  Vec3 lastHandle() const noexcept; // after the last advance() [m]

  FalconEmulatorSpec spec_;
  std::shared_ptr<DeviceClock> clock_;
  std::mt19937 random_;
  bool attached_ = true, runs_, stalled_ = false;
  // USB bridge.
  std::vector<Pending> to_host_;
  std::vector<std::byte> buffer_, from_host_;
  std::uint16_t baud_ = 0, modem_ = 0;
  double latency_ = 16e-3, last_packet_ = 0;
  // Boot loader.
  int greeted_ = 0;
  std::vector<std::byte> image_;
  // Firmware.
  std::uint64_t frames_ = 0;
  int homed_;
  double homing_for_ = 0;
  std::array<int, 3> offset_{};
  std::array<double, 3> encoder_{}; // with backlash [rad]
  std::array<int, 3> motors_{};
  std::vector<std::byte> withheld_, before_;
  // Mechanics.
  ZohIntegrator step_;
  std::array<Motion, 3> axes_{}; // relative to `anchor_`
  Vec3 anchor_ = Vec3::Zero();
  Vec3 force_ = Vec3::Zero();
  double moved_at_;
};

} // namespace patina
