// Parser of a probe's packets (docs/usb_protocol.md), written independently of the encoder.
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
inline constexpr std::size_t kMaxProbeChannels = 8; // channels with a gyroscope
using ProbePacket = std::span<const std::byte>;

struct ProbeChannel {
  std::string name, unit;
  double scale = 1, zero = 0;   // value = scale (count - zero)
  double low = 0, high = 0;     // measuring range, in `unit`
  double noise = 0;             // standard deviation at rest
  std::uint32_t calibrated = 0; // days since 1970-01-01; 0: never
};
struct ProbeDescription {
  std::string name, serial;
  std::uint32_t firmware = 0; // 65536 * major + minor
  double period = 0;          // sampling interval [s]
  unsigned samples_per_packet = 1;
  // force, two axes of each of two accelerometers, and perhaps the gyroscope's three rates
  std::vector<ProbeChannel> channels;
  bool hasGyroscope() const { return channels.size() == kMaxProbeChannels; }
};

struct ProbeSamples {
  std::uint32_t packet = 0;   // packet number
  std::uint32_t first = 0;    // number of its first sample
  std::uint64_t time_ns = 0;  // time of this sample on the probe's clock
  bool saturated = false;     // a value is beyond its measuring range
  bool sensor_silent = false; // a sensor gave no value
  std::size_t count = 0;
  std::size_t channels = kProbeChannels; // kMaxProbeChannels with a gyroscope
  std::array<std::array<std::int16_t, kMaxProbeChannels>, 4> counts{};
};
struct ProbePart {
  std::uint32_t id = 0;            // equal in all parts of a description
  std::size_t part = 0, parts = 0; // its number, from 0, and how many there are
  std::array<std::byte, 48> content{};
};
// monostate: wrong length, check sum or number. Accepts any bytes.
using ProbeContent = std::variant<std::monostate, ProbeSamples, ProbePart>;
ProbeContent parseProbePacket(ProbePacket packet) noexcept;

// Assembles a description from its parts, in any order.
class DescriptionAssembler {
 public:
  // Returns true if this part completes the description. Throws Error for a probe that is not
  // supported: other channels or units, numbers that are not finite.
  bool take(const ProbePart& part);
  const ProbeDescription& description() const { return description_; }

 private:
  std::uint32_t id_ = 0;
  std::vector<std::optional<ProbePart>> parts_;
  ProbeDescription description_;
};

// Extracts packets from a serial line's bytes, in pieces of any size. An invalid frame gives an
// empty packet, to be counted, except the first, whose beginning may be missing.
class ProbeFrames {
 public:
  void take(std::span<const std::byte> bytes, const std::function<void(ProbePacket)>& on_packet);

 private:
  std::vector<std::byte> frame_;
  bool begun_ = false;
};

} // namespace patina
