#include "acquisition/sources/probe_decoder.h"

#include <algorithm>

#include "core/error.h"

namespace patina {
namespace {

constexpr std::int32_t kLate = 1024;       // packets: a number further back is a new start
constexpr std::size_t kMostWaiting = 8192; // packets without a description: two seconds at least

} // namespace

void ProbeDecoder::take(ProbePacket packet, double arrival, std::vector<ProbeSample>& into) {
  const ProbeContent content = parseProbePacket(packet);
  if (const auto* part = std::get_if<ProbePart>(&content)) {
    described_ = parts_.take(*part) || described_;
  } else if (const auto* samples = std::get_if<ProbeSamples>(&content)) {
    const auto t = timeOf(*samples, arrival);
    if (!t) return;
    ++health_.packets;
    waiting_.push_back({*samples, *t, arrival});
    if (waiting_.size() > kMostWaiting)
      throw Error("the probe sends samples and never says what they mean: its firmware must send a "
                  "part of its description every 100 ms (docs/usb_protocol.md)");
  } else {
    ++health_.corrupt;
  }
  if (!described_) return;
  for (const Waiting& each : waiting_) give(each, into);
  waiting_.clear();
}

// Of its first sample; nothing of a packet that is to be left out. Counts what lies before it.
std::optional<double> ProbeDecoder::timeOf(const ProbeSamples& samples, double arrival) {
  const Last now{samples.packet, samples.first + static_cast<std::uint32_t>(samples.count),
                 samples.time_ns, arrival};
  if (!last_) {
    begin_ns_ = samples.time_ns;
    last_ = now;
    return begin_;
  }
  const auto ahead = static_cast<std::int32_t>(samples.packet - last_->packet - 1);
  const bool restarted =
      ahead < -kLate || (samples.packet == 0 && ahead < 0 && samples.time_ns < last_->time_ns &&
                         samples.time_ns != begin_ns_);
  if (restarted) {
    ++health_.restarts;
    begin_ += 1e-9 * static_cast<double>(last_->time_ns - begin_ns_) +
              std::max(arrival - last_->arrival, 1e-4 * samples.count);
    begin_ns_ = samples.time_ns;
    skew_ = {};
  } else if (ahead < 0 || samples.time_ns <= last_->time_ns) {
    ++health_.repeated;
    return std::nullopt;
  } else {
    const auto missing = static_cast<std::size_t>(ahead);
    health_.lost_packets += missing;
    health_.lost_samples += std::min<std::size_t>(samples.first - last_->next_sample, 4 * missing);
  }
  last_ = now;
  return begin_ + 1e-9 * static_cast<double>(samples.time_ns - begin_ns_);
}

void ProbeDecoder::give(const Waiting& packet, std::vector<ProbeSample>& into) {
  const ProbeDescription& probe = description();
  const ProbeSamples& samples = packet.samples;
  double t = packet.t;
  for (std::size_t i = 0; i < samples.count; ++i) {
    std::array<double, kProbeChannels> value{};
    bool saturated = samples.saturated;
    for (std::size_t k = 0; k < kProbeChannels; ++k) {
      const ProbeChannel& channel = probe.channels[k];
      value[k] = channel.scale * (samples.counts[i][k] - channel.zero);
      saturated = saturated || value[k] < channel.low || value[k] > channel.high;
    }
    health_.saturated += saturated;
    if (i > 0) t += probe.period;
    into.push_back({t, value[0], {value[1], value[2], value[3], value[4]}});
  }
  health_.silent += samples.sensor_silent;
  skew_.add(t, packet.arrival);
}

ProbeHealth ProbeDecoder::health() const {
  ProbeHealth health = health_;
  health.skew = skew_.skew();
  return health;
}

} // namespace patina
