// Limits on time that hold on any machine under any load: the time of the code is compared with
// that of a reference kernel in the same run, and the ratio is judged.
//
// The minimum time counts, because other programs can only add to it. Works of some 100 us and more
// take turns and are timed by the thread's own processor time, which excludes other threads.
// Shorter steps are timed by the clock, and each step of a path keeps the minimum of its repeats:
// preemption hits another step each time. Repeats follow one another within one time slice of the
// scheduler: the first call refills the cache, as it is filled while a scene is felt.
//
// There is always a verdict. Sanitizers multiply times by arbitrary factors: their builds leave out
// each PATINA_TIMED_TEST.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/percentiles.h"
#include "support/longer.h"
#include "support/sanitized.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PATINA_TIMED_TEST(suite, name) [[maybe_unused]] static void suite##name##Untimed()
#else
#define PATINA_TIMED_TEST(suite, name) TEST(suite, name)
#endif

namespace patina::test {

inline double secondsOn(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Processor time of the calling thread [s]: waiting, for a core or for another thread, is not in
// it.
inline double threadSeconds() {
  return secondsOn(CLOCK_THREAD_CPUTIME_ID);
}

using Work = std::function<void()>;

// Minimum thread time [s] of one call of each work. Rounds go on until `settled` of them in a row
// had the processor to themselves and found nothing shorter by a hundredth, but at most for
// `max_seconds`, except for three rounds; ten times either in the long form. Work given to other
// threads is not counted: see OneThread.
inline std::vector<double> minSeconds(const std::vector<Work>& works, int settled = 10,
                                      double max_seconds = 10) {
  constexpr double kAlone = 1.05; // processor's share of the clock time, for an undisturbed thread
  std::vector<double> least(works.size(), std::numeric_limits<double>::infinity());
  settled = static_cast<int>(longer(settled));
  const double end = secondsOn(CLOCK_MONOTONIC) + static_cast<double>(longer(1)) * max_seconds;
  int quiet = 0;
  for (int round = 0; round < 3 || (quiet < settled && secondsOn(CLOCK_MONOTONIC) < end); ++round) {
    const double clock = secondsOn(CLOCK_MONOTONIC), own = threadSeconds();
    bool shorter = false;
    for (std::size_t i = 0; i < works.size(); ++i)
      for (int in_a_row = least[i] < 1e-3 ? 3 : 1; in_a_row > 0; --in_a_row) {
        const double begin = threadSeconds();
        works[i]();
        const double seconds = threadSeconds() - begin;
        shorter = shorter || seconds < 0.99 * least[i];
        least[i] = std::min(least[i], seconds);
      }
    const bool alone = secondsOn(CLOCK_MONOTONIC) - clock <= kAlone * (threadSeconds() - own);
    quiet = shorter ? 0 : quiet + (alone ? 1 : 0);
  }
  return least;
}

// The minimum time of each step of a path.
class LeastSteps {
 public:
  explicit LeastSteps(std::size_t count)
      : seconds_(count, std::numeric_limits<double>::infinity()) {}

  // Calls step(state, i) for i = 0 .. count - 1, several times for each leg of the path, every time
  // from the state at the leg's beginning. May be called again; the minimum of all calls is kept.
  template <class State, class Step> void walk(State state, const Step& step) {
    for (std::size_t leg = 0; leg < seconds_.size(); leg += kLeg) {
      const std::size_t end = std::min(leg + kLeg, seconds_.size());
      const State begin = state;
      for (int repeat = 0; repeat < kRepeats; ++repeat) {
        state = begin;
        timed(clock_, [] {});
        for (std::size_t i = leg; i < end; ++i) timed(seconds_[i], [&] { step(state, i); });
      }
    }
  }
  // Returns the sum over the steps [s], without the clock's own time.
  Percentiles seconds() const {
    std::vector<double> own = seconds_;
    for (double& each : own) each = std::max(0.0, each - clock_);
    return percentiles(own);
  }

 private:
  template <class Step> static void timed(double& least, const Step& step) {
    timespec begin{}, end{};
    clock_gettime(CLOCK_MONOTONIC, &begin);
    step();
    clock_gettime(CLOCK_MONOTONIC, &end);
    least = std::min(least, static_cast<double>(end.tv_sec - begin.tv_sec) +
                                1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec));
  }
  static constexpr std::size_t kLeg = 250;
  static constexpr int kRepeats = 8;
  std::vector<double> seconds_;
  double clock_ = std::numeric_limits<double>::infinity();
};

// The reference: kernels whose steps depend on earlier results, as in a tick, so that neither a
// wide nor a narrow processor has much advantage.
class Reference {
 public:
  Reference() : next_(kLoads), from_(kCopied), to_(kCopied) {
    std::iota(next_.begin(), next_.end(), 0U);
    std::mt19937 random(1);
    for (std::size_t i = next_.size() - 1; i > 0; --i) // one cycle through all
      std::swap(next_[i], next_[random() % i]);
  }

  // 8 dependent loads from 64 kB, 40 dependent multiplications and additions.
  void tick() {
    for (int i = 0; i < 8; ++i) at_ = next_[at_];
    double x = 1 + 1e-9 * at_;
    for (int i = 0; i < 40; ++i) x = 0.99 * x + 0.01;
    at_ = next_[at_ ^ static_cast<std::uint32_t>(x > 2)]; // the next load depends on this one
    kept_ = x;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  // The main work of a dab or a bake: arithmetic that waits for memory, and a copy of memory (16
  // MB).
  void bake() {
    ticks(50000);
    std::memcpy(to_.data(), from_.data(), kCopied);
    from_[0] = to_[at_];
  }

 private:
  static constexpr std::size_t kLoads = 1 << 14, kCopied = 1 << 24;
  std::vector<std::uint32_t> next_;
  std::vector<char> from_, to_;
  std::uint32_t at_ = 0;
  volatile double kept_ = 0;
};

// Prints the times and returns whether their ratio is at most `most`: EXPECT_TRUE(within("tick",
// tick, reference, 2.5));
inline testing::AssertionResult within(const std::string& name, double seconds, double reference,
                                       double most) {
  const double ratio = seconds / reference;
  const auto& [scale, unit] = seconds < 1e-6   ? std::pair(1e9, "ns")
                              : seconds < 1e-3 ? std::pair(1e6, "us")
                                               : std::pair(1e3, "ms");
  char text[200];
  std::snprintf(text, sizeof text, "%-40s %8.1f %s, %7.2f of the reference; at most %g",
                name.c_str(), scale * seconds, unit, ratio, most);
  std::printf("%s\n", text);
  return (ratio <= most ? testing::AssertionSuccess() : testing::AssertionFailure()) << text;
}

} // namespace patina::test
