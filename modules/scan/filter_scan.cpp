#include "scan/filter_scan.h"

#include "core/error.h"

namespace patina {

ScanFilter filterOf(const std::optional<Rig>& rig, bool has_probe) {
  ScanFilter filter;
  filter.model =
      rig && rig->accelerometers && has_probe ? PathModel::fused : PathModel::acceleration;
  if (rig) filter.gravity = rig->gravity;
  return filter;
}

FilteredScan touchedPath(const ScanStreams& streams, const std::optional<Rig>& rig,
                         Progress& progress) {
  ProbeModel probe = rig ? rig->probe : ProbeModel();
  if (!rig) probe.tip = Vec3::Zero();
  FilteredScan scan = filterScan(streams.poses, streams.samples, probe,
                                 filterOf(rig, !streams.samples.empty()), progress);
  if (scan.path.empty()) throw Error("the probe never touches");
  return scan;
}

} // namespace patina
