// Time of a tick along the fixed contact test.
#pragma once

#include "app/studies/haptics/contact_test_path.h"
#include "haptics/law/snapshot.h"
#include "support/least_time.h"

namespace patina::test {

inline ContactMemory ledIn(const HapticSnapshot& snapshot, const ContactTest& test) {
  ContactMemory memory;
  for (const Vec3& tip : test.lead_in) tick(snapshot, memory, tip, kContactTestPeriod);
  return memory;
}

struct TickTime {
  Percentiles tick, reference; // [s], over the ticks of the path and as many of the reference
};
inline TickTime tickTime(const HapticSnapshot& snapshot, const ContactTest& test) {
  LeastSteps ticks(test.tips.size()), references(test.tips.size());
  Reference reference;
  for (int round = 0; round < longer(3); ++round) {
    ticks.walk(ledIn(snapshot, test), [&](ContactMemory& memory, std::size_t i) {
      tick(snapshot, memory, test.tips[i], kContactTestPeriod);
    });
    references.walk(0, [&](int, std::size_t) { reference.tick(); });
  }
  return {ticks.seconds(), references.seconds()};
}

// Time [s] of the beginning of the path, one entry per snapshot, for comparing snapshots more
// precisely than by single ticks.
inline std::vector<double>
pathSeconds(const std::vector<std::shared_ptr<const HapticSnapshot>>& snapshots,
            const ContactTest& test) {
  constexpr std::size_t kTicks = 2000;
  std::vector<Work> works;
  for (const auto& snapshot : snapshots)
    works.emplace_back([&snapshot, &test, begin = ledIn(*snapshot, test)] {
      ContactMemory memory = begin;
      for (std::size_t i = 0; i < kTicks; ++i)
        tick(*snapshot, memory, test.tips[i], kContactTestPeriod);
    });
  return minSeconds(works);
}

} // namespace patina::test
