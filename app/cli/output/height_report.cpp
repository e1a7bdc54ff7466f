#include "app/cli/output/height_report.h"

#include "acquisition/profile/roughness.h"
#include "app/cli/output/reports.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina::cli {

void reportHeights(const ScanHeights& scan, Report& report) {
  report.set("normal", vectorJson(scan.plane.normal));
  report.set("stretches", scan.heights.back().stretch + 1);
  std::vector<double> sigmas;
  for (const ScanHeight& height : scan.heights) sigmas.push_back(height.point.sigma);
  report.set("height_sigma", percentiles(sigmas).p50);
  if (const auto found = roughnessOf(scan.heights))
    report.set("roughness",
               Json::object()
                   .set("rq", found->rq)
                   .set("ra", found->ra)
                   .set("rq_deviation", found->rq_deviation)
                   .set("ra_deviation", found->ra_deviation)
                   .set("cutoff", kRoughnessCutoff)
                   .set("lengths", found->lengths),
               "Rq " + formatLength(found->rq) + " +- " + formatLength(found->rq_deviation) +
                   ", Ra " + formatLength(found->ra) + " +- " + formatLength(found->ra_deviation) +
                   ", waves up to " + formatLength(kRoughnessCutoff));
  if (const auto& found = scan.compliance) {
    const std::string presses =
        ", from " + formatCount(found->loadings) + (found->loadings == 1 ? " press" : " presses");
    if (found->isTold())
      report.set("stiffness",
                 Json::object()
                     .set("value", found->stiffness)
                     .set("deviation", found->stiffness_deviation)
                     .set("presses", found->loadings),
                 rounded(found->stiffness) + " N/m, deviation " +
                     rounded(found->stiffness_deviation) + " N/m" + presses);
    else {
      const double least = 1 / (found->compliance + 2 * found->compliance_deviation);
      report.set("stiffness", Json::object().set("least", least).set("presses", found->loadings),
                 "more than " + rounded(least) + " N/m" + presses +
                     ": it may be rigid, and heights are those of a rigid surface");
    }
  }
}

} // namespace patina::cli
