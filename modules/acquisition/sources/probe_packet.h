// A probe's packets, read: docs/usb_protocol.md. What makes them is firmware/probe_packer.h, whose
// code this does not share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace patina {

inline constexpr std::size_t kProbePacket = 64; // [bytes]
inline constexpr std::size_t kProbeChannels = 5;
inline constexpr std::size_t kProbeParts = 6; // of a description
using ProbePacket = std::span<const std::byte>;

struct ProbeChannel {
  std::string name, unit;
  double scale = 1, zero = 0;   // value = scale (count - zero)
  double low = 0, high = 0;     // what it can show
  double noise = 0;             // standard deviation at rest
  std::uint32_t calibrated = 0; // days since 1970-01-01; 0: never
};
struct ProbeDescription {
  std::string name, serial;
  std::uint32_t firmware = 0; // 65536 * major + minor
  double period = 0;          // between samples [s]
  unsigned samples_per_packet = 1;
  std::array<ProbeChannel, kProbeChannels> channels; // force, a1u, a1v, a2u, a2v
};

struct ProbeSamples {
  std::uint32_t packet = 0;  // its number
  std::uint32_t first = 0;   // number of its first sample
  std::uint64_t time_ns = 0; // of that, by the probe's clock
  bool saturated = false, sensor_silent = false;
  std::size_t count = 0;
  std::array<std::array<std::int16_t, kProbeChannels>, 4> counts{};
};
struct ProbePart {
  std::uint32_t id = 0; // the same in all parts of a description
  std::size_t part = 0;
  std::array<std::byte, 48> content{};
};
// monostate: none, as its length, its check or one of its numbers is wrong. Any bytes.
using ProbeContent = std::variant<std::monostate, ProbeSamples, ProbePart>;
ProbeContent parseProbePacket(ProbePacket packet) noexcept;

// Puts a description together from its parts, in any order.
class ProbeParts {
 public:
  // true where it is complete with this part. Throws Error where it describes no probe that we can
  // read: other channels or units, numbers that are none.
  bool take(const ProbePart& part);
  const ProbeDescription& description() const { return description_; }

 private:
  std::uint32_t id_ = 0;
  std::array<std::optional<ProbePart>, kProbeParts> parts_;
  ProbeDescription description_;
};

// Packets out of a serial line's bytes, as they come in any pieces. A frame that holds none is
// given as an empty one, to be counted; but not the first, whose beginning may have been missed.
class ProbeFrames {
 public:
  void take(std::span<const std::byte> bytes, const std::function<void(ProbePacket)>& on_packet);

 private:
  std::vector<std::byte> frame_;
  bool begun_ = false;
};

} // namespace patina
