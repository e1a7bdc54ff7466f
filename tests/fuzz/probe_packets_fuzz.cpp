// Any bytes of a probe give samples of finite numbers, or an Error, and the same from a serial line
// in any pieces. The checksum of each packet is corrected so that parsing goes on; the first byte
// selects the path.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "acquisition/sources/probe_decoder.h"
#include "core/error.h"

namespace {

using patina::kProbePacket;

std::vector<patina::ProbeSample> decoded(const std::vector<std::vector<std::byte>>& packets) {
  std::vector<patina::ProbeSample> samples;
  patina::ProbeDecoder decoder;
  double arrival = 0;
  try {
    for (const auto& packet : packets) decoder.take(packet, arrival += 0.01, samples);
  } catch (const patina::Error&) {
  }
  const patina::ProbeHealth health = decoder.health();
  if (health.packets + health.corrupt + health.repeated > packets.size()) std::abort();
  if (health.skew && !std::isfinite(*health.skew)) std::abort();
  for (const patina::ProbeSample& sample : samples)
    if (!std::isfinite(sample.t) || !std::isfinite(sample.force)) std::abort();
  return samples;
}

void repair(std::byte* packet) {
  std::uint32_t crc = ~0U;
  for (std::size_t i = 0; i < kProbePacket - 4; ++i) {
    crc ^= std::to_integer<std::uint32_t>(packet[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0U);
  }
  for (std::size_t i = 0; i < 4; ++i)
    packet[kProbePacket - 4 + i] = static_cast<std::byte>(~crc >> 8 * i);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const unsigned way = data[0];
  std::vector<std::byte> bytes;
  for (std::size_t i = 1; i < size; ++i) bytes.push_back(static_cast<std::byte>(data[i]));
  std::vector<std::vector<std::byte>> packets;
  if (way & 1) {
    for (std::size_t at = 0; at < bytes.size(); at += kProbePacket) {
      const std::size_t end = std::min(at + kProbePacket, bytes.size());
      if (way & 2 && end - at == kProbePacket) repair(&bytes[at]);
      packets.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                           bytes.begin() + static_cast<std::ptrdiff_t>(end));
    }
    decoded(packets);
    return 0;
  }
  const auto framed = [&](std::size_t piece) {
    std::vector<std::vector<std::byte>> found;
    patina::ProbeFrames frames;
    for (std::size_t at = 0; at < bytes.size(); at += piece)
      frames.take(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)),
                  [&](patina::ProbePacket packet) {
                    if (!packet.empty() && packet.size() != kProbePacket) std::abort();
                    found.emplace_back(packet.begin(), packet.end());
                  });
    return found;
  };
  packets = framed(bytes.size() + 1);
  if (packets != framed(1 + way / 2)) std::abort();
  decoded(packets);
  return 0;
}
