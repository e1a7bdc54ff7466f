#include "haptics/falcon/falcon_line.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patina {
namespace {

constexpr std::uint8_t kWritePipe = 0x02, kReadPipe = 0x81;
constexpr std::size_t kPacket = 64, kStatus = 2;
constexpr unsigned kWait = 100; // for replies of the bridge itself [ms]
constexpr unsigned kWriteWait = 1;

enum Request : std::uint8_t {
  kReset = 0,
  kModem = 1,
  kFlow = 2,
  kBaud = 3,
  kData = 4,
  kLatency = 9
};

// Rounds to whole milliseconds: a clock that advanced by a microsecond does not lose a millisecond
// of waiting, and a small remainder counts as none.
unsigned milliseconds(double seconds) {
  return static_cast<unsigned>(std::clamp(std::round(1e3 * seconds), 0.0, 1000.0));
}

} // namespace

UsbResult FalconLine::set(std::uint8_t request, std::uint16_t value) noexcept {
  return usb_->controlOut({0x40, request, value, 0}, {}, kWait).result;
}

UsbResult FalconLine::purge() noexcept {
  for (const std::uint16_t side : {1, 2})
    if (const UsbResult result = set(kReset, side); result != UsbResult::ok) return result;
  return UsbResult::ok;
}

UsbResult FalconLine::toBootLoader() noexcept {
  constexpr std::pair<std::uint8_t, std::uint16_t> kSteps[] = {
      {kReset, 1},     {kReset, 2},      {kLatency, 16},   {kBaud, 0x4138}, {kData, 8},
      {kFlow, 0},      {kModem, 0x0200}, {kModem, 0x0100}, // RTS low; DTR low, then high: reset
      {kModem, 0x0101}};
  for (const auto& [request, value] : kSteps)
    if (const UsbResult result = set(request, value); result != UsbResult::ok) return result;
  return UsbResult::ok;
}

UsbResult FalconLine::toLoading() noexcept {
  const UsbResult result = set(kModem, 0x0100);
  return result == UsbResult::ok ? set(kBaud, 0x15) : result;
}

UsbResult FalconLine::toRunning() noexcept {
  for (const auto& [request, value] :
       {std::pair<std::uint8_t, std::uint16_t>{kLatency, 1}, {kBaud, 2}, {kReset, 1}, {kReset, 2}})
    if (const UsbResult result = set(request, value); result != UsbResult::ok) return result;
  return UsbResult::ok;
}

UsbResult FalconLine::send(std::span<const std::byte> bytes) noexcept {
  const UsbCount sent = usb_->write(kWritePipe, bytes, kWriteWait);
  if (sent.result != UsbResult::ok) return sent.result;
  return sent.bytes == bytes.size() ? UsbResult::ok : UsbResult::failed;
}

LineRead FalconLine::receive(std::span<std::byte> into, double seconds) noexcept {
  const double until = clock_->now() + seconds;
  LineRead read;
  for (;;) {
    if (read.bytes == into.size()) return read;
    const unsigned left = milliseconds(until - clock_->now());
    if (left == 0) break;
    std::array<std::byte, kPacket> packet;
    const UsbCount got = usb_->read(kReadPipe, packet, left);
    if (got.result != UsbResult::ok && got.result != UsbResult::timeout) {
      read.result = got.result;
      return read;
    }
    if (got.bytes < kStatus || got.bytes > kPacket) continue;
    const std::size_t data = got.bytes - kStatus;
    const std::size_t taken = std::min(data, into.size() - read.bytes);
    std::copy_n(packet.begin() + kStatus, taken,
                into.begin() + static_cast<std::ptrdiff_t>(read.bytes));
    read.bytes += taken;
    read.surplus += data - taken;
  }
  read.result = UsbResult::timeout;
  return read;
}

LineRead FalconLine::listen(double seconds) noexcept {
  const double until = clock_->now() + seconds;
  LineRead read;
  for (int empty = 0; empty < 2;) {
    const unsigned left = milliseconds(until - clock_->now());
    if (left == 0) {
      read.result = UsbResult::timeout;
      return read;
    }
    std::array<std::byte, kPacket> packet;
    const UsbCount got = usb_->read(kReadPipe, packet, left);
    if (got.result != UsbResult::ok && got.result != UsbResult::timeout) {
      read.result = got.result;
      return read;
    }
    const std::size_t data = got.bytes > kStatus ? got.bytes - kStatus : 0;
    read.surplus += data;
    empty = data == 0 ? empty + 1 : 0;
  }
  return read;
}

} // namespace patina
