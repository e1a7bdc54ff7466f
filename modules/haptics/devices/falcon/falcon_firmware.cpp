#include "haptics/devices/falcon/falcon_firmware.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/file.h"
#include "core/sha256.h"

namespace patina {
namespace {

constexpr std::size_t kChunk = 62;
constexpr double kEchoWait = 0.2; // [s]: an echo that is late has come by then
constexpr double kHelloWait = 0.04;
constexpr int kHellos = 100, kRepeats = 8; // of a greeting; of one chunk

constexpr std::byte operator""_b(unsigned long long value) {
  return static_cast<std::byte>(value);
}
constexpr std::array kHello{0x0a_b, 0x43_b, 0x0d_b};
constexpr std::array kHelloAnswer{0x0a_b, 0x44_b, 0x2c_b, 0x0d_b};
constexpr std::array kSecond{0x41_b};

} // namespace

std::vector<std::byte> readFalconFirmware(const std::filesystem::path& file,
                                          const std::string& trusted) {
  const std::string text = readFile(file);
  std::ostringstream cause;
  if (text.size() < kLeastFirmware || text.size() > kMostFirmware) {
    cause << "is no firmware of a Falcon: it has " << text.size() << " bytes, a firmware has "
          << kLeastFirmware << " to " << kMostFirmware;
  } else if (trusted != "any") {
    const std::string digest = sha256(text);
    if (trusted.empty())
      cause << "nobody has vouched for this firmware: if its SHA-256 is that of the maker's file, "
               "set PATINA_FALCON_SHA256="
            << digest;
    else if (digest != trusted)
      cause << "is another firmware than the one vouched for: its SHA-256 is " << digest
            << ", PATINA_FALCON_SHA256 is " << trusted;
  }
  if (!cause.str().empty()) throw FileError(file.string(), 0, cause.str());
  std::vector<std::byte> image(text.size());
  std::ranges::transform(text, image.begin(), [](char c) { return static_cast<std::byte>(c); });
  return image;
}

FalconFirmwareSource falconFirmwareSource() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::string(text ? text : "");
  };
  return {value("PATINA_FALCON_FIRMWARE"), value("PATINA_FALCON_SHA256")};
}

FirmwareLoader::FirmwareLoader(FalconLine& line, std::shared_ptr<DeviceClock> clock,
                               std::vector<std::byte> image)
    : line_(line), clock_(std::move(clock)), image_(std::move(image)),
      until_(clock_->now() + kFirmwareTime) {}

FirmwareLoader::State FirmwareLoader::again(const std::string& why) noexcept {
  if (++attempts_ >= kFirmwareAttempts || clock_->now() >= until_) {
    cause_ = "the Falcon does not take its firmware: " + why + ", " + std::to_string(attempts_) +
             " times; take its power and USB plugs out and put them in again";
    return State::refused;
  }
  stage_ = Stage::reset;
  sent_ = 0;
  hellos_ = repeats_ = 0;
  return State::going;
}

FirmwareLoader::State FirmwareLoader::step() noexcept {
  switch (stage_) {
  case Stage::reset:
    if (const UsbResult result = line_.toBootLoader(); result != UsbResult::ok) {
      gone_ = result == UsbResult::gone;
      return again("its line cannot be set");
    }
    stage_ = Stage::hello;
    return State::going;
  case Stage::hello:
  case Stage::second_hello:
    return hello();
  case Stage::chunks:
    break;
  }
  return chunk();
}

FirmwareLoader::State FirmwareLoader::hello() noexcept {
  const bool first = stage_ == Stage::hello;
  const std::span<const std::byte> greeting =
      first ? std::span<const std::byte>(kHello) : std::span<const std::byte>(kSecond);
  const std::span<const std::byte> answer =
      first ? std::span<const std::byte>(kHelloAnswer) : std::span<const std::byte>(kSecond);
  if (hellos_++ >= kHellos || clock_->now() >= until_)
    return again("it does not answer a greeting");
  if (const UsbResult result = line_.send(greeting); result != UsbResult::ok) {
    gone_ = result == UsbResult::gone;
    return gone_ ? again("it is gone") : State::going;
  }
  std::array<std::byte, 5> got{}; // a zero may lead the first
  const LineRead read = line_.receive(std::span(got).first(first ? 5 : 1), kHelloWait);
  const auto end = got.begin() + static_cast<std::ptrdiff_t>(read.bytes);
  if (std::search(got.begin(), end, answer.begin(), answer.end()) == end) return State::going;
  hellos_ = 0;
  if (!first) {
    stage_ = Stage::chunks;
    return State::going;
  }
  if (line_.toLoading() != UsbResult::ok) return again("its line cannot be set");
  stage_ = Stage::second_hello;
  return State::going;
}

FirmwareLoader::State FirmwareLoader::chunk() noexcept {
  const std::size_t size = std::min(kChunk, image_.size() - sent_);
  const std::span<const std::byte> chunk = std::span(image_).subspan(sent_, size);
  if (clock_->now() >= until_) return again("it takes too long");
  if (const UsbResult result = line_.send(chunk); result != UsbResult::ok) {
    gone_ = result == UsbResult::gone;
    if (gone_) return again("it is gone");
  }
  std::array<std::byte, kChunk> echo{};
  const LineRead read = line_.receive(std::span(echo).first(size), kEchoWait);
  const std::string where = "chunk " + std::to_string(sent_ / kChunk + 1) + " of " +
                            std::to_string((image_.size() + kChunk - 1) / kChunk);
  if (read.result == UsbResult::timeout && read.bytes == 0) {
    if (++repeats_ > kRepeats) return again(where + " never came back");
    return State::going; // it is sent again
  }
  if (read.bytes != size || read.surplus > 0 ||
      !std::ranges::equal(std::span(echo).first(size), chunk))
    return again(where + " came back changed");
  repeats_ = 0;
  sent_ += size;
  return sent_ == image_.size() ? State::loaded : State::going;
}

} // namespace patina
