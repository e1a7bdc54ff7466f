// Emulated probe: reference packer (firmware/probe_packer.h), own clock, and a faulty line.
#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "acquisition/firmware/probe_packer.h"
#include "acquisition/sources/probe_packet.h"

namespace patina {

struct EmulatedProbeSpec {
  double rate = 1000;              // samples per second of the probe's clock
  unsigned samples_per_packet = 4; // 1 to 4, or to 2 with a gyroscope
  bool gyroscope = false;
  double skew = 0;                 // relative excess rate of its clock
  double loss = 0, corrupt = 0;    // share of the packets that are lost or corrupted
  double describe_every = 0.1;     // time between parts of the description [s]; 0: on request only
  std::uint32_t seed = 1;
};

// A pen that is pressed and released twice a second; accelerations of an upright pen at rest, and
// the rates of one that swings about its shaft once a second.
class EmulatedProbe {
 public:
  // Throws std::invalid_argument.
  explicit EmulatedProbe(const EmulatedProbeSpec& spec);
  EmulatedProbe(const EmulatedProbe&) = delete;
  EmulatedProbe& operator=(const EmulatedProbe&) = delete;

  void start(); // counts from 0; the clock continues
  // Sends the packets until the true time t [s]; `sent` is the true time of the last sample.
  void until(double t, const std::function<void(ProbePacket, double sent)>& send);
  std::array<std::byte, kProbePacket> describe(unsigned part) const;
  unsigned parts() const { return probe_parts(&packer_); } // packets per description
  std::size_t made() const { return made_; }           // number of sample packets
  std::size_t lost() const { return lost_; }           // lost ones of them
  std::size_t corrupted() const { return corrupted_; } // corrupted ones of them

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
  std::size_t made_ = 0, lost_ = 0, corrupted_ = 0;
};

} // namespace patina
