// Tests the judge of all time limits while two other threads load the processors.
#include "support/least_time.h"

#include <atomic>
#include <thread>

namespace patina::test {
namespace {

class TwoBusyThreads {
 public:
  ~TwoBusyThreads() {
    done_ = true;
    for (std::thread& each : threads_) each.join();
  }

 private:
  void spin() const {
    while (!done_) {
    }
  }
  alignas(256) std::atomic<bool> done_{false}; // on its own cache line: its readers slow no other
  alignas(256) std::thread threads_[2]{std::thread([this] { spin(); }),
                                       std::thread([this] { spin(); })};
};

PATINA_TIMED_TEST(LeastTime, DetectsDoubledWorkUnderLoad) {
  const TwoBusyThreads others;
  Reference once, twice, reference;
  const std::vector<double> least = minSeconds(
      {[&] { once.ticks(2000); }, [&] { twice.ticks(4000); }, [&] { reference.ticks(2000); }});
  EXPECT_TRUE(within("the same work", least[0], least[2], 1.1));
  EXPECT_FALSE(within("twice the work", least[1], least[2], 1.5));
  EXPECT_TRUE(within("twice the work", least[1], least[2], 2.2));
}

// 1.5 % of the steps are long: the 99th percentile shows it, the median does not.
PATINA_TIMED_TEST(LeastTime, DetectsAFewLongStepsUnderLoad) {
  const TwoBusyThreads others;
  constexpr std::size_t kSteps = 20000;
  Reference even, uneven;
  LeastSteps all(kSteps), few(kSteps);
  // A disturbed round is repeated: the minimum can only fall, and the cost of the code stays in it.
  const auto settled = [&] {
    return all.seconds().p99 <= 1.3 * all.seconds().p50 &&
           few.seconds().p50 <= 1.1 * all.seconds().p50;
  };
  for (int round = 0; round < 3 || (round < 40 && !settled()); ++round) {
    all.walk(0, [&](int, std::size_t) { even.tick(); });
    few.walk(0, [&](int, std::size_t i) { uneven.ticks(i % 200 < 3 ? 2 : 1); });
  }
  EXPECT_TRUE(within("p99 of even steps", all.seconds().p99, all.seconds().p50, 1.3));
  EXPECT_TRUE(within("p50 of uneven steps", few.seconds().p50, all.seconds().p50, 1.1));
  EXPECT_FALSE(within("p99 of uneven steps", few.seconds().p99, all.seconds().p99, 1.4));
}

PATINA_TIMED_TEST(LeastTime, EndsInTimeIfNothingSettles) {
  Reference reference;
  int calls = 0; // each call shorter than the one before, for ever
  const double begin = secondsOn(CLOCK_MONOTONIC);
  minSeconds({[&] { reference.ticks(1000000 / ++calls); }}, 1000, 0.5);
  EXPECT_GE(calls, 3);
  EXPECT_LT(secondsOn(CLOCK_MONOTONIC) - begin, 20);
}

} // namespace
} // namespace patina::test
