#include "acquisition/sources/probe_decoder.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace patina {

void ClockSkew::add(double stamp, double arrival) {
  const Point point{stamp, arrival - stamp};
  // True if the last point is on or above the line through its neighbours.
  const auto bendsDown = [&] {
    const Point &a = hull_[hull_.size() - 2], &b = hull_.back();
    return (b.x - a.x) * (point.y - a.y) <= (b.y - a.y) * (point.x - a.x);
  };
  while (hull_.size() >= 2 && bendsDown()) hull_.pop_back();
  hull_.push_back(point);
  if (hull_.size() <= kMaxPoints) return;
  std::size_t kept = 1;
  for (std::size_t i = 2; i + 1 < hull_.size(); i += 2) hull_[kept++] = hull_[i];
  hull_[kept++] = hull_.back();
  hull_.resize(kept);
}

std::optional<double> ClockSkew::skew() const {
  if (hull_.size() < 2 || hull_.back().x - hull_.front().x < kMinSpan) return std::nullopt;
  const double mean = 0.5 * (hull_.front().x + hull_.back().x); // stamps are evenly spaced
  const auto after = std::find_if(hull_.begin() + 1, hull_.end() - 1,
                                  [&](const Point& point) { return point.x >= mean; });
  const Point &a = after[-1], &b = *after;
  const double slope = (b.y - a.y) / (b.x - a.x); // 1 / (1 + skew) - 1
  return -slope / (1 + slope);
}

namespace {

constexpr std::int32_t kLate = 1024; // packets: an older number is a restart
constexpr std::size_t kAgain = 8;    // number of repeated packets in a row that indicates a restart
constexpr std::size_t kMaxWaiting = 8192; // packets without a description: at least two seconds

} // namespace

void ProbeDecoder::take(ProbePacket packet, double arrival, std::vector<ProbeSample>& into,
                        std::vector<RateSample>* rates) {
  const ProbeContent content = parseProbePacket(packet);
  if (const auto* part = std::get_if<ProbePart>(&content)) {
    has_description_ = parts_.take(*part) || has_description_;
  } else if (const auto* samples = std::get_if<ProbeSamples>(&content)) {
    for (const Arrived& each : inOrder(*samples, arrival)) {
      ++health_.packets;
      waiting_.push_back({each.samples, timeOf(each), each.arrival});
    }
    if (waiting_.size() > kMaxWaiting)
      throw Error("the probe sends samples without their description: its firmware must send a "
                  "part of its description every 100 ms (docs/usb_protocol.md)");
  } else {
    ++health_.corrupt;
  }
  if (!has_description_) return;
  for (const Waiting& each : waiting_) give(each, into, rates);
  waiting_.clear();
}

// Returns the packets that continue the stream with this one. A repeated number is left out;
// several in a row indicate a restarted probe whose first packets may be lost.
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

// Returns the time of the first sample and counts the missing ones before it.
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

void ProbeDecoder::give(const Waiting& packet, std::vector<ProbeSample>& into,
                        std::vector<RateSample>* rates) {
  const ProbeDescription& probe = description();
  const ProbeSamples& samples = packet.samples;
  if (samples.channels != probe.channels.size())
    throw Error("the probe describes " + std::to_string(probe.channels.size()) +
                " channels and sends samples of " + std::to_string(samples.channels) +
                ": its firmware must start the packer again with each description");
  if (channels_ != 0 && channels_ != samples.channels)
    throw Error(std::string("the probe started again ") +
                (probe.hasGyroscope() ? "with" : "without") + " a gyroscope: record again");
  channels_ = samples.channels;
  double t = packet.t;
  for (std::size_t i = 0; i < samples.count; ++i) {
    std::array<double, kMaxProbeChannels> value{};
    bool saturated = samples.saturated;
    for (std::size_t k = 0; k < samples.channels; ++k) {
      const ProbeChannel& channel = probe.channels[k];
      value[k] = channel.scale * (samples.counts[i][k] - channel.zero);
      saturated = saturated || value[k] < channel.low || value[k] > channel.high;
    }
    health_.saturated += saturated;
    if (i > 0) t += probe.period;
    into.push_back({t, value[0], {value[1], value[2], value[3], value[4]}});
    if (rates && probe.hasGyroscope()) rates->push_back({t, {value[5], value[6], value[7]}});
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
