#include "app/cli/output/path_report.h"

#include "app/cli/output/reports.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina::cli {

Json gapsJson(const FilteredScan& scan) {
  Json list = Json::array();
  for (const auto& [stream, gaps] :
       {std::pair("poses", &scan.without_pose), {"probe", &scan.without_sample}})
    for (const Gap& gap : *gaps)
      list.push(Json::object().set("stream", stream).set("from", gap.from).set("to", gap.to));
  return list;
}

void reportSigma(const std::vector<PathSample>& path, Report& report) {
  std::vector<double> sigmas;
  for (const PathSample& sample : path) sigmas.push_back(sample.sigma);
  const double median = percentiles(sigmas).p50, most = percentiles(sigmas).max;
  report.set("sigma", Json::object().set("median", median).set("max", most),
             formatLength(median) + " (median), " + formatLength(most) + " (max)");
}

void reportClock(const ProbeClock& found, Report& report) {
  const ProbeClock clock = found.differs ? found : ProbeClock();
  report.set("clock_offset", clock.offset,
             found.differs
                 ? "the probe's is " + rounded(1e3 * clock.offset) + " ms ahead, +- " +
                       rounded(1e3 * clock.offset_deviation) + ", and " +
                       rounded(1e6 * clock.skew) + " us a second faster, +- " +
                       rounded(1e6 * clock.skew_deviation) + "; corrected"
                 : "as the camera's, within " + rounded(1e3 * found.offset_deviation) + " ms");
  report.set("clock_skew", clock.skew);
  report.set(
      "clock_deviation",
      Json::object().set("offset", found.offset_deviation).set("skew", found.skew_deviation));
}

} // namespace patina::cli
