// Whether a time that was measured is the program's own or the machine's, which had more to do.
#pragma once

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace patina::test {

// Beyond its limit but within this factor a time is shown and skipped: a slower or busier
// processor. Beyond the factor it fails: the work has become slower.
inline constexpr double kSlowMachine = 1.3;

// A pass during which its thread had less than this share of a core says nothing.
inline constexpr double kCleanShare = 0.98;

// Share of one core that the calling thread got since construction; for work that never waits.
class CpuShare {
 public:
  double value() const {
    const double wall = seconds(CLOCK_MONOTONIC) - wall_;
    return wall > 0 ? (seconds(CLOCK_THREAD_CPUTIME_ID) - cpu_) / wall : 0;
  }

 private:
  static double seconds(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double wall_ = seconds(CLOCK_MONOTONIC);
  double cpu_ = seconds(CLOCK_THREAD_CPUTIME_ID);
};

// What `pass` returns, unless other work took the core away meanwhile.
template <class Pass> auto ifClean(Pass&& pass) -> std::optional<decltype(pass())> {
  const CpuShare share;
  auto result = pass();
  if (share.value() < kCleanShare) return std::nullopt;
  return result;
}

// Results of the clean ones among up to `tries` passes, at most `wanted`. Empty: skip the row.
template <class Pass>
auto cleanPasses(int wanted, int tries, Pass&& pass) -> std::vector<decltype(pass())> {
  std::vector<decltype(pass())> clean;
  for (int i = 0; i < tries && static_cast<int>(clean.size()) < wanted; ++i)
    if (auto result = ifClean(pass)) clean.push_back(std::move(*result));
  return clean;
}

// More wants to run here than there are processors: for times across several threads and programs,
// which no one thread's share of a core can judge. False where that is unknown.
inline bool machineIsCrowded() {
  double load = 0;
  return getloadavg(&load, 1) == 1 && load > std::thread::hardware_concurrency();
}

// Share of all processors' time since construction that a virtual machine's host gave to others, by
// the kernel's account. 0 where there is no host or no account.
class StolenTime {
 public:
  double share() const {
    const Account now;
    return now.all > begin_.all ? (now.stolen - begin_.stolen) / (now.all - begin_.all) : 0;
  }

 private:
  // user nice system idle iowait irq softirq steal; what follows is part of these.
  struct Account {
    Account() {
      std::ifstream file("/proc/stat");
      std::string name;
      file >> name;
      for (int i = 0; i < 8 && file >> stolen; ++i) all += stolen;
      if (!file) all = stolen = 0;
    }
    double all = 0, stolen = 0;
  };
  Account begin_;
};

} // namespace patina::test
