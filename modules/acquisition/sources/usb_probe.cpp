#include "acquisition/sources/usb_probe.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "acquisition/sources/probe_decoder.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr std::uint8_t kIn = 0x81;
constexpr std::uint8_t kFromProbe = 0xc1, kToProbe = 0x41; // vendor, interface
constexpr std::uint8_t kDescribe = 1, kStream = 2;
constexpr unsigned kAnswer = 500, kWait = 100; // [ms]
// longest time without data before the probe is called silent [s]
constexpr double kSilence = 2;
constexpr double kMended = 7;      // [s]: the kernel may take 5 to clear a halt
constexpr double kTogether = 0.01; // [s]: packets of this time are read in one transfer
constexpr std::size_t kMaxTogether = 16;

const char* const kUndescribed =
    "does not send the description of docs/usb_protocol.md: load firmware of this version";

[[noreturn]] void fail(const std::string& name, const std::string& cause) {
  throw DeviceError("the probe " + name + " " + cause);
}

void claim(UsbTransport& usb, const std::string& name) {
  const UsbResult result = usb.claim(0);
  if (result == UsbResult::gone) fail(name, "is gone: plug it in again");
  if (result != UsbResult::ok) fail(name, "is in use by another program: close that program");
}

template <class Take> void askParts(UsbTransport& usb, const std::string& name, const Take& take) {
  std::size_t parts = kProbeChannels + 1; // known better once one has come
  for (std::uint16_t part = 0; part < parts; ++part) {
    std::array<std::byte, kProbePacket> packet;
    const UsbCount got = usb.controlIn({kFromProbe, kDescribe, part, 0}, packet, kAnswer);
    if (got.result == UsbResult::gone)
      fail(name, "is gone: it was pulled out, or its hub lost power");
    if (got.result != UsbResult::ok) continue;
    const ProbePacket answer = std::span(packet).first(got.bytes);
    const ProbeContent content = parseProbePacket(answer);
    if (const auto* one = std::get_if<ProbePart>(&content)) parts = one->parts;
    take(answer);
  }
}

class UsbProbe final : public ProbeSource {
 public:
  UsbProbe(std::unique_ptr<UsbTransport> usb, std::string name, std::function<double()> now)
      : usb_(std::move(usb)), name_(std::move(name)), now_(std::move(now)) {
    claim(*usb_, name_);
    stream(false); // if a program that was killed had started it
    discard();
    askParts(*usb_, name_, [this](ProbePacket packet) {
      std::vector<ProbeSample> none;
      decoder_.take(packet, 0, none);
    });
    if (!decoder_.hasDescription()) fail(name_, kUndescribed);
    const ProbeDescription& probe = decoder_.description();
    together_ = std::clamp<std::size_t>(
        static_cast<std::size_t>(kTogether / (probe.period * probe.samples_per_packet)), 1,
        kMaxTogether);
    stream(true);
    heard_ = now_();
  }
  ~UsbProbe() override { stream(false); }

  bool read(std::vector<ProbeSample>& into, std::vector<RateSample>* rates) override {
    for (const std::size_t before = into.size(); into.size() == before;) {
      if (stopped_) return false;
      std::array<std::byte, kMaxTogether * kProbePacket> bytes;
      const UsbCount got = usb_->read(kIn, std::span(bytes).first(together_ * kProbePacket), kWait);
      const double now = now_();
      if (got.bytes > 0) heard_ = now;
      for (std::size_t at = 0; at < got.bytes; at += kProbePacket)
        decoder_.take(std::span(bytes).subspan(at, std::min(kProbePacket, got.bytes - at)), now,
                      into, rates);
      if (into.size() > before) return true; // data before a fault are returned first
      if (got.result == UsbResult::gone)
        fail(name_, "is gone: it was pulled out, or its hub lost power");
      const bool refused = got.result != UsbResult::ok && got.result != UsbResult::timeout;
      if (now - heard_ > (got.result == UsbResult::stall ? kMended : kSilence))
        fail(name_, refused ? "cannot be read: plug it in again, without a hub"
                            : "has sent nothing for 2 s: plug it in again");
      // Packets lost while a stalled endpoint is cleared are detected by their numbers.
      if (refused) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  bool isLive() const override { return true; }
  void stop() noexcept override { stopped_ = true; }
  std::optional<ProbeHealth> health() const override { return decoder_.health(); }

 private:
  void stream(bool on) noexcept {
    usb_->controlOut({kToProbe, kStream, static_cast<std::uint16_t>(on), 0}, {}, kAnswer);
  }
  void discard() noexcept {
    std::array<std::byte, kProbePacket> packet;
    for (int i = 0; i < 256 && usb_->read(kIn, packet, 5).bytes > 0; ++i) {
    }
  }

  const std::unique_ptr<UsbTransport> usb_;
  const std::string name_;
  const std::function<double()> now_;
  std::size_t together_ = 1;
  double heard_ = 0;
  ProbeDecoder decoder_;
  std::atomic<bool> stopped_{false};
};

} // namespace

std::unique_ptr<ProbeSource> makeUsbProbe(std::unique_ptr<UsbTransport> usb, std::string name,
                                          std::function<double()> now) {
  return std::make_unique<UsbProbe>(std::move(usb), std::move(name), std::move(now));
}

ProbeDescription describeProbe(UsbTransport& usb, const std::string& name) {
  claim(usb, name);
  DescriptionAssembler parts;
  bool complete = false;
  try {
    askParts(usb, name, [&](ProbePacket packet) {
      const ProbeContent content = parseProbePacket(packet);
      if (const auto* part = std::get_if<ProbePart>(&content))
        complete = parts.take(*part) || complete;
    });
  } catch (const DeviceError&) {
    throw;
  } catch (const Error& error) {
    throw DeviceError(error.what());
  }
  if (!complete) fail(name, kUndescribed);
  return parts.description();
}

} // namespace patina
