#include "scan/filter_scan.h"

#include <cmath>

#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kFarthest = 20; // [m], a camera tracks no marker beyond

// Throws Error for poses that are not in metres.
void requireMetres(const std::vector<CameraPose>& poses) {
  std::vector<double> distances;
  for (const CameraPose& pose : poses) distances.push_back(pose.position.norm());
  const double median = distances.empty() ? 0 : percentiles(std::move(distances)).p50;
  if (median > kFarthest)
    throw Error("half of the poses are more than " + formatNumber(std::round(median)) +
                " m away from the camera; their unit is m, not mm");
}

} // namespace

ScanFilter filterOf(const std::optional<Rig>& rig, bool has_probe) {
  ScanFilter filter;
  filter.model =
      rig && rig->accelerometers && has_probe ? PathModel::fused : PathModel::acceleration;
  if (rig) filter.gravity = rig->gravity;
  return filter;
}

FilteredScan filterStreams(const ScanStreams& streams, const std::optional<Rig>& rig,
                           const ScanFilter& filter, Progress& progress) {
  requireMetres(streams.poses);
  ProbeModel probe = rig ? rig->probe : ProbeModel();
  if (!rig) probe.tip = Vec3::Zero();
  return filterScan(streams.poses, streams.samples, probe, filter, progress, streams.rates);
}

FilteredScan contactPath(const ScanStreams& streams, const std::optional<Rig>& rig,
                         Progress& progress) {
  FilteredScan scan =
      filterStreams(streams, rig, filterOf(rig, !streams.samples.empty()), progress);
  if (scan.path.empty()) throw Error("the probe never touches");
  return scan;
}

} // namespace patina
