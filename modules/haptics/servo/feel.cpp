#include "haptics/servo/feel.h"

#include <algorithm>
#include <chrono>
#include <string>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/servo/tick_record.h"

namespace patina {
namespace {

constexpr double kFirstPeriod = 1e-3; // [s], of a path of one row
constexpr std::size_t kReportEvery = 4096;

void checkTimes(const std::vector<TimedTip>& path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i].t > path[i - 1].t) continue;
    throw Error("tip path: time does not increase at row " + std::to_string(i + 1) + " (" +
                formatNumber(path[i - 1].t) + " s, then " + formatNumber(path[i].t) + " s)");
  }
}

} // namespace

std::vector<ToolSample> feel(const HapticSnapshot& snapshot, const std::vector<TimedTip>& path,
                             Progress& progress) {
  using Clock = std::chrono::steady_clock;
  checkTimes(path);
  std::vector<ToolSample> samples;
  samples.reserve(path.size());
  ContactMemory memory;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i % kReportEvery == 0) {
      progress.throwIfCancelled();
      progress.report(static_cast<double>(i) / static_cast<double>(path.size()), "feeling");
    }
    const double dt = i > 0             ? path[i].t - path[i - 1].t
                      : path.size() > 1 ? path[1].t - path[0].t
                                        : kFirstPeriod;
    const auto before = Clock::now();
    const Contact contact = tick(snapshot, memory, path[i].tip, dt);
    const auto ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - before).count();

    ToolSample sample;
    sample.t = path[i].t;
    record(contact, snapshot.field.get(), sample);
    sample.step_ns = static_cast<std::uint32_t>(std::min<long long>(ns, UINT32_MAX));
    samples.push_back(sample);
  }
  progress.report(1, "feeling");
  return samples;
}

} // namespace patina
