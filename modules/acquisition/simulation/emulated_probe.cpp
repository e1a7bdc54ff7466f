#include "acquisition/simulation/emulated_probe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace patina {
namespace {

constexpr std::uint64_t kClockBegins = 123'456'789'000; // start of the clock [ns]

template <std::size_t room> void put(char (&into)[room], std::string_view word) {
  std::copy_n(word.data(), std::min(word.size(), room), into);
}

std::int16_t countOf(const probe_channel& channel, double value) {
  return static_cast<std::int16_t>(
      std::clamp(std::round(value / channel.scale + channel.zero), -32768., 32767.));
}

} // namespace

EmulatedProbe::EmulatedProbe(const EmulatedProbeSpec& spec) : spec_(spec), random_(spec.seed) {
  const auto isPart = [](double value) { return value >= 0 && value <= 1; };
  if (!(spec.rate >= 1 && spec.rate <= 10000) || spec.samples_per_packet < 1 ||
      spec.samples_per_packet > PROBE_SAMPLES || !(std::abs(spec.skew) < 0.01) ||
      !isPart(spec.loss) || !isPart(spec.corrupt) || !(spec.describe_every >= 0))
    throw std::invalid_argument("emulated probe: a number is out of range");
  put(description_.name, "Patina probe");
  put(description_.serial, "EMULATED-" + std::to_string(spec.seed));
  description_.firmware = 1 << 16;
  description_.period_ns = static_cast<std::uint32_t>(std::lround(1e9 / spec.rate));
  description_.gyroscope = spec_.gyroscope;
  const char* names[] = {"force", "a1u", "a1v", "a2u", "a2v", "wx", "wy", "wz"};
  for (std::size_t i = 0; i < PROBE_MAX_CHANNELS; ++i) {
    probe_channel& channel = description_.channel[i];
    put(channel.name, names[i]);
    const bool is_rate = i >= PROBE_CHANNELS;
    put(channel.unit, i == 0 ? "N" : is_rate ? "rad/s" : "m/s^2");
    channel.scale = i == 0 ? 0.02F : is_rate ? 5e-4F : 0.147F; // A02, A03
    channel.zero = i == 0 ? 12 : 0;
    channel.low = i == 0 ? -2 : is_rate ? -15 : -30;
    channel.high = i == 0 ? 10 : is_rate ? 15 : 30;
    channel.noise = i == 0 ? 0.005F : is_rate ? 0.003F : 0.02F;
    channel.calibrated = 20000;
  }
  start();
}

void EmulatedProbe::start() {
  probe_start(&packer_, &description_, spec_.samples_per_packet);
  made_ = lost_ = corrupted_ = 0;
}

std::array<std::byte, kProbePacket> EmulatedProbe::describe(unsigned part) const {
  std::array<std::uint8_t, kProbePacket> raw;
  probe_describe(&packer_, part, raw.data());
  return std::bit_cast<std::array<std::byte, kProbePacket>>(raw);
}

void EmulatedProbe::emit(std::array<std::byte, kProbePacket>& packet, double sent, bool counts,
                         const std::function<void(ProbePacket, double)>& send) {
  std::uniform_real_distribution<double> chance(0, 1);
  made_ += counts;
  if (spec_.loss > 0 && chance(random_) < spec_.loss) {
    lost_ += counts;
    return;
  }
  if (spec_.corrupt > 0 && chance(random_) < spec_.corrupt) {
    corrupted_ += counts;
    packet[random_() % kProbePacket] ^= static_cast<std::byte>(1U << random_() % 8);
  }
  send(packet, sent);
}

void EmulatedProbe::until(double t, const std::function<void(ProbePacket, double sent)>& send) {
  const double own_period = 1 / spec_.rate;
  for (;; ++tick_) {
    const double own = own_period * static_cast<double>(tick_), sent = own / (1 + spec_.skew);
    if (sent > t) return;
    if (spec_.describe_every > 0 && own >= next_part_) {
      next_part_ += spec_.describe_every;
      auto packet = describe(part_++ % parts());
      emit(packet, sent, false, send);
    }
    const double press = std::max(0., std::sin(2 * std::numbers::pi * 2 * own));
    std::array<std::int16_t, PROBE_MAX_CHANNELS> counts{};
    counts[0] = countOf(description_.channel[0], press);
    for (const std::size_t upright : {2, 4})
      counts[upright] = countOf(description_.channel[upright], 9.80665);
    counts[7] = countOf(description_.channel[7], 2 * std::sin(2 * std::numbers::pi * own));
    std::array<std::uint8_t, kProbePacket> raw;
    if (probe_add(&packer_, counts.data(),
                  kClockBegins + static_cast<std::uint64_t>(std::llround(1e9 * own)), 0,
                  raw.data()) == 0)
      continue;
    auto packet = std::bit_cast<std::array<std::byte, kProbePacket>>(raw);
    emit(packet, sent, true, send);
  }
}

} // namespace patina
