// A probe's packets become samples, and what is missing among them is counted.
#pragma once

#include "acquisition/sources/clock_skew.h"
#include "acquisition/sources/probe_packet.h"
#include "acquisition/sources/sources.h"

namespace patina {

// Times begin at 0 with the first sample and are the probe's own; where it starts anew in the
// middle they go on by what passed here. Samples that come before their description wait for it.
class ProbeDecoder {
 public:
  // One packet, or what came in its place, at `arrival` by this machine's clock [s]. Throws Error
  // for a description that cannot be used, or where none comes.
  void take(ProbePacket packet, double arrival, std::vector<ProbeSample>& into);
  bool described() const { return described_; }
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
  void give(const Waiting& packet, std::vector<ProbeSample>& into);

  ProbeParts parts_;
  bool described_ = false;
  std::vector<Waiting> waiting_;
  std::optional<Last> last_;
  bool last_begins_ = false;     // the packet that comes next is the first of a new start
  std::vector<Arrived> earlier_; // numbers that were there, one after the other
  std::uint64_t begin_ns_ = 0;   // where the probe's clock says begin_
  double begin_ = 0;
  ProbeHealth health_;
  ClockSkew skew_;
};

} // namespace patina
