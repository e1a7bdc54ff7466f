// A Falcon at the wire: bridge, boot loader, firmware, encoders, motors, handle and a hand on it,
// as a test or `--device sim:falcon` needs them. Shares no code with the driver but constants of
// the device.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/types.h"
#include "haptics/devices/exact_step.h"
#include "haptics/devices/link/device_clock.h"
#include "usb/usb_transport.h"

namespace patina {

// What goes wrong with answers, for as many frames as FalconBench::Faults says.
enum class WireFault : std::uint8_t {
  none,
  stall,        // the endpoint refuses
  mute,         // no answer
  shortened,    // 11 bytes of 16
  corrupt,      // a byte that none has
  flipped,      // a bit of an encoder that is far up
  late,         // after 8 ms
  repeated,     // twice at once
  stale,        // the answer to the frame before, and this one behind it
  out_of_order, // withheld until the next has gone
  noise,        // bytes that are no frame
  homing_lost,  // its axes are not homed any more
};

struct FalconBenchSpec {
  // Handle and hand, along each axis: the hand's spring is to `rest`, its mass and damping are in.
  Oscillator body{.mass = 0.25, .damping = 3, .spring = 60, .friction = 0};
  double play = 0;                // [rad], of each thigh's gear
  double answer = 220e-6;         // [s], from a frame to its answer
  double homing_time = 0.15;      // [s], until the hand has moved each axis over its index
  std::uint8_t homing_bit = 0x01; // the one that this firmware knows
  bool runs_firmware = true;
  bool homed = true;
  std::vector<std::byte> firmware{}; // what its boot loader takes; empty: it refuses all
  double chunk_loss = 0;             // share of chunks that never arrive
  double chunk_late = 0;             // and of those that are echoed late, by up to 150 ms
  unsigned seed = 1;
};

// The device on the desk; transports come and go as it is plugged in. Lives in one clock. One
// thread's at a time.
class FalconBench {
 public:
  FalconBench(const FalconBenchSpec& spec, std::shared_ptr<DeviceClock> clock);

  // Throws DeviceError while it is not attached. The bench must outlive it.
  std::unique_ptr<UsbTransport> plug();
  void unplug() noexcept { attached_ = false; } // what is plugged is gone
  void attach() noexcept { attached_ = true; }
  bool attached() const noexcept { return attached_; }

  struct Faults {
    WireFault kind = WireFault::none;
    int frames = 0;
  } faults;
  Vec3 rest = Vec3::Zero(); // [m], device frame, of the hand's spring
  Vec3 push = Vec3::Zero(); // [N], of the hand besides
  unsigned buttons = 0;     // bit i: button i of the four is down
  std::function<void(double t, const std::array<int, 3>& motors)>
      on_frame{}; // each that arrives whole

  // Runs it to now; where the handle is, device frame [m].
  Vec3 handle() noexcept;
  Vec3 velocity() const noexcept;
  Vec3 motorForce() const noexcept { return force_; } // [N], at the handle now
  std::uint64_t frames() const noexcept { return frames_; }
  bool runsFirmware() const noexcept { return runs_; }
  void loseFirmware() noexcept { runs_ = false; }
  void loseHoming() noexcept;

 private:
  friend class BenchTransport;
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
  void spoil(std::vector<std::byte> bytes);
  void reply(std::vector<std::byte> bytes, double after);
  void advance() noexcept;

  FalconBenchSpec spec_;
  std::shared_ptr<DeviceClock> clock_;
  std::mt19937 random_;
  bool attached_ = true, runs_, stalled_ = false;
  // The bridge.
  std::vector<Pending> to_host_;
  std::vector<std::byte> buffer_, from_host_;
  std::uint16_t baud_ = 0, modem_ = 0;
  double latency_ = 16e-3, last_packet_ = 0;
  // The boot loader.
  int greeted_ = 0;
  std::vector<std::byte> image_;
  // The firmware.
  std::uint64_t frames_ = 0;
  int homed_;
  double homing_for_ = 0;
  std::array<int, 3> offset_{};
  std::array<double, 3> encoder_{}; // [rad], with the play
  std::array<int, 3> motors_{};
  std::vector<std::byte> withheld_, before_;
  // The mechanics.
  ExactStep step_;
  std::array<Motion, 3> axes_{}; // about `anchor_`
  Vec3 anchor_ = Vec3::Zero();
  Vec3 force_ = Vec3::Zero();
  double moved_at_;
};

} // namespace patina
