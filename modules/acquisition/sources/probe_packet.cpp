#include "acquisition/sources/probe_packet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace patina {
namespace {

constexpr std::size_t kCrcAt = kProbePacket - 4, kContentAt = 12, kSamplesAt = 20;
constexpr std::size_t kLongestFrame = kProbePacket + 1; // without its terminator

struct NameAndUnit {
  const char *name, *unit;
};
constexpr std::array<NameAndUnit, kMaxProbeChannels> kChannelTable{{{"force", "N"},
                                                                    {"a1u", "m/s^2"},
                                                                    {"a1v", "m/s^2"},
                                                                    {"a2u", "m/s^2"},
                                                                    {"a2v", "m/s^2"},
                                                                    {"wx", "rad/s"},
                                                                    {"wy", "rad/s"},
                                                                    {"wz", "rad/s"}}};

template <class Number> Number numberAt(std::span<const std::byte> bytes, std::size_t at) {
  Number number = 0;
  for (std::size_t i = sizeof number; i-- > 0;)
    number = static_cast<Number>(number << 8 | std::to_integer<Number>(bytes[at + i]));
  return number;
}

double realAt(std::span<const std::byte> bytes, std::size_t at) {
  return std::bit_cast<float>(numberAt<std::uint32_t>(bytes, at));
}

// Returns the text up to the first zero; unprintable characters become question marks.
std::string wordAt(std::span<const std::byte> bytes, std::size_t at, std::size_t room) {
  std::string word;
  for (const std::byte byte : bytes.subspan(at, room)) {
    const char c = static_cast<char>(byte);
    if (c == 0) break;
    word += c < 0x20 || c > 0x7e ? '?' : c;
  }
  return word;
}

// CRC-32 of IEEE 802.3, by bytes.
std::uint32_t crcOf(std::span<const std::byte> bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value & 1 ? 0xedb88320U : 0U);
      made[i] = value;
    }
    return made;
  }();
  std::uint32_t crc = 0xffffffffU;
  for (const std::byte byte : bytes)
    crc = crc >> 8 ^ table[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
  return ~crc;
}

ProbeChannel channelIn(const ProbePart& part, std::size_t channel) {
  const auto& from = part.content;
  ProbeChannel out{wordAt(from, 0, 8), wordAt(from, 8, 8), realAt(from, 16), realAt(from, 20),
                   realAt(from, 24),   realAt(from, 28),   realAt(from, 32), 0};
  out.calibrated = numberAt<std::uint32_t>(from, 36);
  const auto& [name, unit] = kChannelTable[channel];
  if (out.name != name || out.unit != unit)
    throw Error("the probe's channel " + std::to_string(channel + 1) + " is " + out.name + " [" +
                out.unit + "], where this version reads " + name + " [" + unit + "]");
  const auto sound = [](double value) { return std::isfinite(value) && std::abs(value) < 1e9; };
  if (!sound(out.scale) || out.scale == 0 || !sound(out.zero) || !sound(out.low) ||
      !sound(out.high) || !(out.low < out.high) || !sound(out.noise) || out.noise < 0)
    throw Error("the probe's calibration of " + out.name +
                " is no calibration: scale, zero, range and noise must be numbers, and the range "
                "not empty. Write it to the probe again.");
  return out;
}

} // namespace

ProbeContent parseProbePacket(ProbePacket packet) noexcept {
  if (packet.size() != kProbePacket || std::to_integer<int>(packet[0]) != 1 ||
      numberAt<std::uint32_t>(packet, kCrcAt) != crcOf(packet.first(kCrcAt)))
    return {};
  const auto kind = std::to_integer<unsigned>(packet[1]);
  const auto size = std::to_integer<std::size_t>(packet[2]);
  const auto flags = std::to_integer<unsigned>(packet[3]);
  const std::size_t channels = kind == 3 ? kMaxProbeChannels : kProbeChannels;
  if ((kind == 1 || kind == 3) && size >= 1 && size <= (kCrcAt - kSamplesAt) / (2 * channels)) {
    ProbeSamples out;
    out.channels = channels;
    out.packet = numberAt<std::uint32_t>(packet, 4);
    out.first = numberAt<std::uint32_t>(packet, 8);
    out.time_ns = numberAt<std::uint64_t>(packet, 12);
    out.saturated = flags & 1;
    out.sensor_silent = flags & 2;
    out.count = size;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t k = 0; k < channels; ++k)
        out.counts[i][k] = static_cast<std::int16_t>(
            numberAt<std::uint16_t>(packet, kSamplesAt + 2 * (channels * i + k)));
    return out;
  }
  const bool complete = flags == kProbeChannels + 1 || flags == kMaxProbeChannels + 1;
  if (kind == 2 && complete && size < flags) {
    ProbePart out{numberAt<std::uint32_t>(packet, 8), size, flags, {}};
    std::copy_n(packet.begin() + kContentAt, out.content.size(), out.content.begin());
    return out;
  }
  return {};
}

bool DescriptionAssembler::take(const ProbePart& part) {
  if (part.id != id_ || part.parts != parts_.size()) {
    parts_.clear();
    parts_.resize(part.parts);
  }
  id_ = part.id;
  parts_[part.part] = part;
  for (const auto& each : parts_)
    if (!each) return false;
  const auto& head = parts_[0]->content;
  ProbeDescription made;
  made.name = wordAt(head, 0, 16);
  made.serial = wordAt(head, 16, 16);
  made.firmware = numberAt<std::uint32_t>(head, 32);
  made.period = 1e-9 * numberAt<std::uint32_t>(head, 36);
  made.samples_per_packet = numberAt<std::uint16_t>(head, 42);
  if (const unsigned count = numberAt<std::uint16_t>(head, 40); count + 1 != parts_.size())
    throw Error("the probe has " + std::to_string(count) + " channels and describes " +
                std::to_string(parts_.size() - 1) +
                ": it must have 5, force and four accelerations, or 8 with a gyroscope");
  if (made.period < 1e-4 || made.period > 1 || made.samples_per_packet < 1 ||
      made.samples_per_packet > 4)
    throw Error("the probe describes a sample every " + std::to_string(made.period) +
                " s and sends " + std::to_string(made.samples_per_packet) +
                " at once: it must be 0.0001 to 1 s, and 1 to 4");
  for (std::size_t i = 0; i + 1 < parts_.size(); ++i)
    made.channels.push_back(channelIn(*parts_[i + 1], i));
  description_ = std::move(made);
  return true;
}

void ProbeFrames::take(std::span<const std::byte> bytes,
                       const std::function<void(ProbePacket)>& on_packet) {
  for (const std::byte byte : bytes) {
    if (byte != std::byte{0}) {
      if (frame_.size() <= kLongestFrame) frame_.push_back(byte); // one byte more than any packet
      continue;
    }
    // Each run begins with the offset of the packet's next zero (COBS, Cheshire & Baker 1999).
    std::array<std::byte, kProbePacket> packet;
    std::size_t size = 0;
    bool sound = frame_.size() == kLongestFrame;
    for (std::size_t at = 0; sound && at < frame_.size();) {
      const std::size_t next = at + std::to_integer<std::size_t>(frame_[at]);
      sound = next <= frame_.size();
      while (sound && ++at < next) packet[size++] = frame_[at];
      if (sound && next < frame_.size()) packet[size++] = std::byte{0};
    }
    if (sound)
      on_packet(packet);
    else if (begun_ && !frame_.empty())
      on_packet({});
    begun_ = true;
    frame_.clear();
  }
}

} // namespace patina
