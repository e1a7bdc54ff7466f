// Decodes a probe's packets to samples and counts the missing ones.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/sources/probe_packet.h"
#include "acquisition/sources/sources.h"

namespace patina {

// Estimates the relative rate of a source's clock from arrival times.

// Transport delay is never negative, so arrival - stamp lies above a line whose slope is the skew.
// The line below all points that is nearest to their mean (Moon, Skelly & Towsley 1999) is an edge
// of the lower convex hull (Zhang, Liu & Xia 2002). The error is at most the spread of the least
// delays over the time span.
class ClockSkew {
 public:
  static constexpr double kMinSpan = 10; // shortest time span for an estimate [s]

  void add(double stamp, double arrival); // stamps in increasing order [s]
  // stamps = (1 + skew) * true times, those of arrivals.
  std::optional<double> skew() const;

 private:
  struct Point {
    double x, y;
  };
  static constexpr std::size_t kMaxPoints = 1024; // longer hulls lose every other point

  std::vector<Point> hull_;
};

// Times are those of the probe's clock, from 0 at the first sample; after a restart they continue
// by the elapsed time of this machine. Samples before their description wait for it.
class ProbeDecoder {
 public:
  // Decodes one packet, or the bytes received in its place; `arrival` is the time on this machine's
  // clock [s]. A probe with a gyroscope appends as many readings to `rates`, if it is given. Throws
  // Error if the description is unusable or missing, or if a gyroscope comes or goes.
  void take(ProbePacket packet, double arrival, std::vector<ProbeSample>& into,
            std::vector<RateSample>* rates = nullptr);
  bool hasDescription() const { return has_description_; }
  const ProbeDescription& description() const { return parts_.description(); }
  ProbeHealth health() const;

 private:
  struct Last {
    std::uint32_t packet, next_sample;
    std::uint64_t time_ns;
    double arrival;
  };
  struct Waiting {
    ProbeSamples samples;
    double t, arrival;
  };
  struct Arrived {
    ProbeSamples samples;
    double arrival;
  };
  std::vector<Arrived> inOrder(const ProbeSamples& samples, double arrival);
  double timeOf(const Arrived& packet);
  void give(const Waiting& packet, std::vector<ProbeSample>& into, std::vector<RateSample>* rates);

  DescriptionAssembler parts_;
  bool has_description_ = false;
  std::size_t channels_ = 0; // channels of the samples given; 0: none was given
  std::vector<Waiting> waiting_;
  std::optional<Last> last_;
  bool last_begins_ = false;     // the next packet is the first after a restart
  std::vector<Arrived> earlier_; // consecutive packets with known numbers
  std::uint64_t begin_ns_ = 0;   // probe clock at begin_
  double begin_ = 0;
  ProbeHealth health_;
  ClockSkew skew_;
};

} // namespace patina
