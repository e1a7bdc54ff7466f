// An emulated probe on an emulated bus, in simulated time: reads advance it.
#pragma once

#include <algorithm>
#include <deque>
#include <random>

#include "acquisition/simulation/emulated_probe.h"
#include "usb/usb_transport.h"

namespace patina::test {

// Events and times of the bus besides the packets.
struct ProbeBus {
  double now = 0;                              // [s], true time
  double gone_at = 1e300;                      // [s]
  double stall_from = 1e300, stall_to = 1e300; // reads are refused between [s]
  double late = 125e-6,
         jitter = 0; // minimum delay of a packet, and the mean of the additional one [s]
  UsbResult claim = UsbResult::ok, read = UsbResult::ok, describe = UsbResult::ok;
  bool streams = true; // on request
  int starts = 0, stops = 0;
  std::size_t given = 0, lost = 0; // packets read, and lost before the last
};

class EmulatedProbeUsb final : public UsbTransport {
 public:
  EmulatedProbeUsb(EmulatedProbe& probe, ProbeBus& bus) : probe_(probe), bus_(bus) {}

  UsbResult claim(int number) noexcept override {
    return number == 0 ? bus_.claim : UsbResult::failed;
  }
  UsbCount controlOut(const UsbRequest& request, std::span<const std::byte>,
                      unsigned) noexcept override {
    if (request.request_type != 0x41 || request.request != 2) return {UsbResult::stall, 0};
    on_ = bus_.streams && request.value == 1;
    ++(request.value == 1 ? bus_.starts : bus_.stops);
    probe_.until(bus_.now, [](ProbePacket, double) {}); // packets measured meanwhile are dropped
    if (on_) probe_.start();
    waiting_.clear();
    return {};
  }
  UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                     unsigned) noexcept override {
    if (bus_.describe != UsbResult::ok) return {bus_.describe, 0};
    if (request.request_type != 0xc1 || request.request != 1) return {UsbResult::stall, 0};
    const auto packet = probe_.describe(request.value);
    std::ranges::copy(packet, data.begin());
    return {UsbResult::ok, packet.size()};
  }
  UsbCount write(std::uint8_t, std::span<const std::byte>, unsigned) noexcept override {
    return {UsbResult::stall, 0};
  }
  // A read ends when full, or when its time is up, as on a bus.
  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                unsigned timeout_ms) noexcept override {
    if (endpoint != 0x81) return {UsbResult::stall, 0};
    const bool stalls = bus_.now >= bus_.stall_from && bus_.now < bus_.stall_to;
    if (stalls || bus_.read != UsbResult::ok) {
      bus_.now += 1e-3;
      return {stalls ? UsbResult::stall : bus_.read, 0};
    }
    const double until = bus_.now + 1e-3 * timeout_ms;
    std::size_t filled = 0;
    while (filled < data.size()) {
      if (waiting_.empty()) {
        if (bus_.now >= bus_.gone_at) return {UsbResult::gone, filled};
        if (bus_.now >= until) return {UsbResult::timeout, filled};
        bus_.now = std::min(bus_.now + 250e-6, until);
        if (on_)
          probe_.until(bus_.now, [this](ProbePacket packet, double sent) {
            Waiting one{sent + bus_.late + bus_.jitter * delay_(random_), probe_.lost(), {}};
            std::ranges::copy(packet, one.packet.begin());
            waiting_.push_back(one);
          });
        continue;
      }
      bus_.now = std::max(bus_.now, waiting_.front().arrives);
      std::ranges::copy(waiting_.front().packet,
                        data.begin() + static_cast<std::ptrdiff_t>(filled));
      filled += kProbePacket;
      ++bus_.given;
      bus_.lost = waiting_.front().lost;
      waiting_.pop_front();
    }
    return {UsbResult::ok, filled};
  }

 private:
  struct Waiting {
    double arrives;
    std::size_t lost;
    std::array<std::byte, kProbePacket> packet;
  };
  EmulatedProbe& probe_;
  ProbeBus& bus_;
  bool on_ = false;
  std::deque<Waiting> waiting_;
  std::mt19937 random_{7};
  std::exponential_distribution<double> delay_{1};
};

} // namespace patina::test
