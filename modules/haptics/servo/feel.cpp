#include "haptics/servo/feel.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/servo/tick_record.h"

namespace patina {
namespace {

constexpr double kFirstPeriod = 1e-3; // [s], for a path of one row
constexpr std::size_t kPollEvery = 4096;

double period(const TimedTip& from, const TimedTip& to, std::size_t row) {
  if (to.t > from.t) return to.t - from.t;
  throw Error("tip path: time does not increase at row " + std::to_string(row) + " (" +
              formatNumber(from.t) + " s, then " + formatNumber(to.t) + " s)");
}

} // namespace

std::size_t feel(const HapticSnapshot& snapshot,
                 const std::function<std::optional<TimedTip>()>& next,
                 const std::function<void(const ToolSample&)>& take, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  ContactMemory memory;
  std::optional<TimedTip> tip = next(), following = tip ? next() : std::nullopt;
  double dt = following ? period(*tip, *following, 2) : kFirstPeriod;
  std::size_t pauses = 0;
  for (std::size_t row = 1; tip; ++row) {
    if (row % kPollEvery == 1) progress.throwIfCancelled();
    const auto before = Clock::now();
    const Contact contact = tick(snapshot, memory, tip->tip, dt);
    const auto ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - before).count();

    ToolSample sample;
    sample.t = tip->t;
    record(contact, sample);
    sample.step_ns = static_cast<std::uint32_t>(std::min<long long>(ns, UINT32_MAX));
    take(sample);
    if (following) {
      const double step = period(*tip, *following, row + 1);
      if (step > kMaxStateAge && step > kPause * dt) {
        memory.reset();
        ++pauses;
      } else {
        dt = step;
      }
    }
    tip = std::exchange(following, following ? next() : std::nullopt);
  }
  return pauses;
}

std::vector<ToolSample> feel(const HapticSnapshot& snapshot, const std::vector<TimedTip>& path,
                             Progress& progress) {
  std::vector<ToolSample> samples;
  samples.reserve(path.size());
  std::size_t given = 0;
  const auto next = [&]() -> std::optional<TimedTip> {
    if (given == path.size()) return std::nullopt;
    if (given % kPollEvery == 0)
      progress.report(static_cast<double>(given) / static_cast<double>(path.size()), "feeling");
    return path[given++];
  };
  feel(
      snapshot, next, [&](const ToolSample& sample) { samples.push_back(sample); }, progress);
  progress.report(1, "feeling");
  return samples;
}

} // namespace patina
