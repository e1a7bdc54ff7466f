#include "haptics/servo/latency.h"

#include <gtest/gtest.h>

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "haptics/device/realtime.h"
#include "haptics/servo/run_delay.h"

namespace patina {
namespace {

using std::chrono::milliseconds;

void spinFor(std::int64_t ns) {
  for (const std::int64_t until = monotonicNs() + ns; monotonicNs() < until;) {
  }
}

// Restricts the calling thread and those it starts to one processor; the destructor restores the
// set.
class OneProcessor {
 public:
  OneProcessor() {
    sched_getaffinity(0, sizeof before_, &before_);
    int first = 0;
    while (!CPU_ISSET(first, &before_)) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    held_ = sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~OneProcessor() { sched_setaffinity(0, sizeof before_, &before_); }
  bool held() const { return held_; }

 private:
  cpu_set_t before_{};
  bool held_ = false;
};

TEST(RunDelay, EqualsTheProcessorTimeOfACompetitor) {
  const RunDelay wait;
  if (!wait.total()) GTEST_SKIP() << "this system does not account for it";
  const OneProcessor processor;
  ASSERT_TRUE(processor.held()) << "may not choose a processor";
  std::atomic<bool> done{false};
  std::thread competitor([&] {
    while (!done) {
    }
  });
  const std::int64_t before = *wait.total();
  spinFor(400'000'000);
  const std::int64_t waited = *wait.total() - before;
  done = true;
  competitor.join();
  EXPECT_GT(waited, 80'000'000) << "half of the time belonged to the competitor";
  EXPECT_LT(waited, 400'000'000 + 100'000'000);
}

TEST(RunDelay, DoesNotCountSleep) {
  const RunDelay wait;
  if (!wait.total()) GTEST_SKIP() << "this system does not account for it";
  const std::int64_t before = *wait.total();
  const std::int64_t start = monotonicNs();
  std::this_thread::sleep_for(milliseconds(100));
  const std::int64_t waited = *wait.total() - before;
  EXPECT_GE(waited, 0);
  EXPECT_LE(waited, monotonicNs() - start - 99'000'000);
}

TEST(Latency, CountsOneWakeUpAPeriod) {
  const Latency latency = measureLatency(0.2, 1000);
  EXPECT_EQ(latency.wakeups, 200u);
  EXPECT_FALSE(latency.policy.empty());
  EXPECT_GT(latency.rate_hz, 0);
  EXPECT_GT(latency.late_us.max, 0);
  EXPECT_LE(latency.late_us.p50, latency.late_us.p99);
  EXPECT_LE(latency.late_us.p99, latency.late_us.max);
  EXPECT_EQ(latency.wait_us.has_value(), RunDelay().total().has_value());
  EXPECT_EQ(latency.timer_us.has_value(), latency.wait_us.has_value());
}

TEST(Latency, RefusesTimesAndRatesOutOfRange) {
  EXPECT_THROW(measureLatency(0), std::invalid_argument);
  EXPECT_THROW(measureLatency(3601), std::invalid_argument);
  EXPECT_THROW(measureLatency(1, 50), std::invalid_argument);
  EXPECT_THROW(measureLatency(1, 20000), std::invalid_argument);
}

// 4 ms of every 8 belong to a thread of higher priority: half of the wake-ups wait for it, up to 4
// ms, and their lateness equals that wait.
TEST(MeasureLatency, SeparatesProcessorWaitFromTimerLateness) {
  if (!RunDelay().total()) GTEST_SKIP() << "this system does not account for the wait";
  const OneProcessor processor;
  ASSERT_TRUE(processor.held()) << "may not choose a processor";
  std::atomic<bool> done{false};
  std::atomic<int> refused{-1};
  std::thread first([&] {
    sched_param parameter{};
    parameter.sched_priority = 60; // the measured thread has 50
    refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
    while (!done && refused == 0) {
      spinFor(4'000'000);
      std::this_thread::sleep_for(milliseconds(4));
    }
  });
  while (refused < 0) std::this_thread::sleep_for(milliseconds(1));
  const Latency latency = measureLatency(1, 1000);
  done = true;
  first.join();
  if (refused != 0) {
    std::printf("no real-time priority here: nobody goes first, and nothing can be told apart\n");
    EXPECT_EQ(latency.wakeups, 1000u);
    return;
  }
  EXPECT_GT(latency.missed, 100u);
  EXPECT_GT(latency.wait_us->p99, 2000);
  EXPECT_GT(latency.late_us.p99, 2000);
  EXPECT_LT(latency.timer_us->p50, 1000);
  EXPECT_LT(latency.timer_us->p99, 0.5 * latency.late_us.p99);
}

} // namespace
} // namespace patina
