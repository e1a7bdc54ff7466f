// The Falcon's own program, which its maker's licence keeps out of ours: the user's file, and how
// it gets into the device.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptics/devices/falcon/falcon_line.h"

namespace patina {

inline constexpr std::size_t kLeastFirmware = 7324, kMostFirmware = 8492; // bytes

// "any" trusts every file, otherwise its SHA-256 must be this one. Throws FileError that says what
// is wrong and, for a file that nobody has vouched for, what its SHA-256 is and how to do so.
std::vector<std::byte> readFalconFirmware(const std::filesystem::path& file,
                                          const std::string& trusted);

// Where the user's file is and what vouches for it: PATINA_FALCON_FIRMWARE and
// PATINA_FALCON_SHA256 of the environment.
struct FalconFirmwareSource {
  std::filesystem::path file{}; // empty: none was named
  std::string trusted{};
};
FalconFirmwareSource falconFirmwareSource();

// Puts an image into the device, a chunk at a time: each is echoed, and compared. One that was lost
// is sent again; one that came back changed, or twice, begins the whole anew, kFirmwareAttempts
// times.
class FirmwareLoader {
 public:
  FirmwareLoader(FalconLine& line, std::shared_ptr<DeviceClock> clock,
                 std::vector<std::byte> image);
  enum class State : std::uint8_t { going, loaded, refused };
  State step() noexcept; // 0.3 s at most
  bool gone() const noexcept { return gone_; }
  const std::string& cause() const noexcept { return cause_; } // one line, where it was refused

 private:
  enum class Stage : std::uint8_t { reset, hello, second_hello, chunks };
  State hello() noexcept;
  State chunk() noexcept;
  State again(const std::string& why) noexcept;

  FalconLine& line_;
  std::shared_ptr<DeviceClock> clock_;
  std::vector<std::byte> image_;
  Stage stage_ = Stage::reset;
  std::size_t sent_ = 0; // bytes that were echoed
  int attempts_ = 0, hellos_ = 0, repeats_ = 0;
  bool gone_ = false;
  double until_;
  std::string cause_;
};
inline constexpr int kFirmwareAttempts = 4;
inline constexpr double kFirmwareTime = 9.5; // [s], of all attempts together

} // namespace patina
