// Novint Falcon: start-up, homing and exchange, over any transport.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptics/falcon/falcon_kinematics.h"
#include "haptics/falcon/falcon_line.h"
#include "haptics/link/device_link.h"
#include "haptics/link/force_guard.h"

namespace patina {

// Smallest and largest file of the Falcon's firmware, which its licence excludes from this program.
inline constexpr std::size_t kMinFirmware = 7324, kMaxFirmware = 8492; // bytes

// Reads the file. `trusted`: the expected SHA-256, or "any" to accept every file. Throws FileError
// with the fault and, for an unverified file, its SHA-256 and the remedy.
std::vector<std::byte> readFalconFirmware(const std::filesystem::path& file,
                                          const std::string& trusted);

// File and SHA-256 from PATINA_FALCON_FIRMWARE and PATINA_FALCON_SHA256 of the environment.
struct FalconFirmwareSource {
  std::filesystem::path file{}; // empty: not set
  std::string trusted{};
};
FalconFirmwareSource falconFirmwareSource();

// Writes an image to the device in chunks and compares each echo. A lost chunk is sent again; a
// changed or repeated echo restarts the transfer, at most kFirmwareAttempts times.
class FirmwareLoader {
 public:
  FirmwareLoader(FalconLine& line, std::shared_ptr<DeviceClock> clock,
                 std::vector<std::byte> image);
  enum class State : std::uint8_t { going, loaded, refused };
  State step() noexcept; // takes at most 0.3 s
  bool gone() const noexcept { return gone_; }
  const std::string& cause() const noexcept { return cause_; } // one line, if refused

 private:
  enum class Stage : std::uint8_t { reset, hello, second_hello, chunks };
  State hello() noexcept;
  State chunk() noexcept;
  State again(const std::string& why) noexcept;

  FalconLine& line_;
  std::shared_ptr<DeviceClock> clock_;
  std::vector<std::byte> image_;
  Stage stage_ = Stage::reset;
  std::size_t sent_ = 0; // bytes confirmed by echoes
  int attempts_ = 0, hellos_ = 0, repeats_ = 0;
  bool gone_ = false;
  double until_;
  std::string cause_;
};
inline constexpr int kFirmwareAttempts = 4;
inline constexpr double kFirmwareTime = 9.5; // for all attempts [s]

// Origin of the device frame: centre of the workspace, from the base [m].
inline const Vec3 kFalconCentre(0, 0, 0.12);
inline const Box3 kFalconWorkspace(Vec3(-0.05, -0.05, -0.045), Vec3(0.05, 0.05, 0.045));

inline constexpr double kFalconCount = 6.3589e-4;    // thigh angle per encoder count [rad]
inline constexpr double kFalconIndex = 0.6108652382; // angle of encoder zero: 35 deg [rad]
// Thigh torque at kMaxMotor [N m]: gives 8.9 N along z in the centre, the maker's peak force.
inline constexpr double kFalconFullTorque = 0.2242;

// Guard limits: about half the peak force, and an assumed permanent force of the motors. The maker
// states neither. The handle's weight is not compensated.
GuardSpec falconGuard();

// Opens the attached device. Throws DeviceError.
using OpenTransport = std::function<std::unique_ptr<UsbTransport>()>;

// First checks whether a firmware runs, and loads the user's file only if not. A reply is valid
// only if it arrives alone, complete, no sooner than physically possible, and gives a position that
// the hand can have reached since the last one. After any other reply (a fault) none is accepted
// until the line was quiet once and all outstanding replies have arrived or 10 ms have passed.
// After 4 ms without a position the next one is not used, but the one after it must agree with it.
// If sending was so slow that an older reply would look timely, the state has the age of that
// reply.
std::unique_ptr<DeviceLink> makeFalconLink(OpenTransport open, FalconFirmwareSource firmware,
                                           std::shared_ptr<DeviceClock> clock);

} // namespace patina
