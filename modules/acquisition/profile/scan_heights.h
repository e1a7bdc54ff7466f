// Surface properties from a scan: heights (A07), and compliance where a probe pressed (A08).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "acquisition/profile/compliance.h"
#include "acquisition/profile/height_profile.h"

namespace patina {

struct ScanHeight {
  double t = 0; // [s], on the camera's clock
  ProfilePoint point;
  std::size_t stretch = 0; // contact interval, from 0; each has its own `arc_length`
};

struct ScanHeights {
  Plane plane; // reference of the heights, in the camera's frame
  std::vector<ScanHeight> heights;
  std::optional<ComplianceEstimate> compliance; // absent without presses of a stationary probe
};

// Fits a plane to the contact points; its normal points to the side of the probe's shaft. Throws
// Error if they form a line rather than a plane, or if there are none.
Plane touchedPlane(const std::vector<PathSample>& path, const Vec3& tip);

// The surface under the tip: unit normal outwards, and the tip's height above it [m].
struct SurfaceUnderTip {
  Vec3 normal;
  double height;
};
// Returns the samples in contact whose tip is stationary along the surface. `velocityAt` returns
// the tip's velocity at a sample [m/s], and `over` the surface under it.
std::vector<PressSample>
pressSamples(const std::vector<PathSample>& path,
             const std::function<Vec3(std::size_t)>& velocityAt,
             const std::function<SurfaceUnderTip(const PathSample&)>& over);

// `scan` is a fused path made of `poses`. `normal` points outwards, in the camera's frame; the
// default is touchedPlane(). The compliance [m/N] corrects for indentation; the default is
// estimated from the presses, if any. Heights are those of the unloaded surface, along the normal,
// from the plane. Throws Error as touchedPlane() does, without contact, and if the accelerometers'
// axes do not span space.
ScanHeights scanHeights(const FilteredScan& scan, const std::vector<CameraPose>& poses,
                        const ProbeModel& probe, const Vec3& gravity,
                        const std::optional<Vec3>& normal = {},
                        const std::optional<double>& compliance = {});

} // namespace patina
