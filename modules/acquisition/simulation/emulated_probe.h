// A probe as the wire sees it: the reference packer (firmware/probe_packer.h) with a clock of its
// own, and a line that loses and spoils packets.
#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "acquisition/firmware/probe_packer.h"
#include "acquisition/sources/probe_packet.h"

namespace patina {

struct EmulatedProbeSpec {
  double rate = 1000;              // samples a second, by the probe's clock
  unsigned samples_per_packet = 4; // 1 to 4
  double skew = 0;                 // by how much its clock runs faster
  double loss = 0, corrupt = 0;    // of packets, the part that is lost or spoilt on the way
  double describe_every = 0.1;     // [s] between parts of the description; 0: on request only
  std::uint32_t seed = 1;
};

// A pen that is pressed and let go, twice a second; accelerations at rest, the pen upright.
class EmulatedProbe {
 public:
  // Throws std::invalid_argument.
  explicit EmulatedProbe(const EmulatedProbeSpec& spec);
  EmulatedProbe(const EmulatedProbe&) = delete;
  EmulatedProbe& operator=(const EmulatedProbe&) = delete;

  void start(); // counts from 0, with a clock that goes on
  // Gives what leaves until the true time t [s]: `sent`, the true time of its last sample.
  void until(double t, const std::function<void(ProbePacket, double sent)>& send);
  std::array<std::byte, kProbePacket> describe(unsigned part) const;
  std::size_t made() const { return made_; }     // packets of samples
  std::size_t lost() const { return lost_; }     // of them
  std::size_t spoilt() const { return spoilt_; } // of them

 private:
  void emit(std::array<std::byte, kProbePacket>& packet, double sent, bool counts,
            const std::function<void(ProbePacket, double)>& send);

  EmulatedProbeSpec spec_;
  probe_description description_{};
  probe_packer packer_{};
  std::mt19937 random_;
  std::uint64_t tick_ = 0;
  double next_part_ = 0;
  unsigned part_ = 0;
  std::size_t made_ = 0, lost_ = 0, spoilt_ = 0;
};

} // namespace patina
