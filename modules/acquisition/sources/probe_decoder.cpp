#include "acquisition/sources/probe_decoder.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace patina {
namespace {

constexpr std::int32_t kLate = 1024;       // packets: a number further back is a new start
constexpr std::size_t kAgain = 8;          // packets in a row that were there: a new start, too
constexpr std::size_t kMostWaiting = 8192; // packets without a description: two seconds at least

} // namespace

void ProbeDecoder::take(ProbePacket packet, double arrival, std::vector<ProbeSample>& into) {
  const ProbeContent content = parseProbePacket(packet);
  if (const auto* part = std::get_if<ProbePart>(&content)) {
    described_ = parts_.take(*part) || described_;
  } else if (const auto* samples = std::get_if<ProbeSamples>(&content)) {
    for (const Arrived& each : inOrder(*samples, arrival)) {
      ++health_.packets;
      waiting_.push_back({each.samples, timeOf(each), each.arrival});
    }
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

// The packets that go on with this one. One whose number was there is left out; several such in a
// row are no repeats but a probe that has begun anew, whose first packets may be lost.
std::vector<ProbeDecoder::Arrived> ProbeDecoder::inOrder(const ProbeSamples& samples,
                                                         double arrival) {
  const Arrived now{samples, arrival};
  if (!last_) return {now};
  const auto ahead = static_cast<std::int32_t>(samples.packet - last_->packet - 1);
  const bool goes_on = ahead >= 0 && samples.time_ns > last_->time_ns;
  const bool begins =
      ahead < -kLate || (samples.packet == 0 && ahead < 0 && samples.time_ns < last_->time_ns &&
                         samples.time_ns != begin_ns_);
  if (goes_on || begins) {
    earlier_.clear();
    if (begins) last_begins_ = true;
    return {now};
  }
  ++health_.repeated;
  if (!earlier_.empty() && samples.packet != earlier_.back().samples.packet + 1) earlier_.clear();
  earlier_.push_back(now);
  if (earlier_.size() < kAgain) return {};
  health_.repeated -= earlier_.size();
  last_begins_ = true;
  return std::exchange(earlier_, {});
}

// Of its first sample. Counts what lies before it.
double ProbeDecoder::timeOf(const Arrived& packet) {
  const ProbeSamples& samples = packet.samples;
  const Last now{samples.packet, samples.first + static_cast<std::uint32_t>(samples.count),
                 samples.time_ns, packet.arrival};
  if (!last_) {
    begin_ns_ = samples.time_ns;
  } else if (std::exchange(last_begins_, false)) {
    ++health_.restarts;
    begin_ += 1e-9 * static_cast<double>(last_->time_ns - begin_ns_) +
              std::max(packet.arrival - last_->arrival, 1e-4 * samples.count);
    begin_ns_ = samples.time_ns;
    skew_ = {};
  } else {
    const auto missing = static_cast<std::size_t>(samples.packet - last_->packet - 1);
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
