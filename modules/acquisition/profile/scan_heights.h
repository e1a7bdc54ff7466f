// What a scan says of the surface under its path: heights from acceleration (A07), and how far it
// yields where the probe was pressed (A08).
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
  std::size_t stretch = 0; // of contact, from 0; each has an `along` of its own
};

struct ScanHeights {
  Plane plane; // from which heights are measured, in the camera's frame
  std::vector<ScanHeight> heights;
  std::optional<ComplianceEstimate> compliance; // absent where nobody pressed while standing
};

// The plane through where the tip touched, outwards where the probe's shaft is. Throws Error where
// that is more of a line than of a plane, or nowhere.
Plane touchedPlane(const std::vector<PathSample>& path, const Vec3& tip);

// Where a surface is felt: outwards and unit, and how far above it the tip is [m].
struct TipOver {
  Vec3 normal;
  double height;
};
// Samples of the touching path in which the probe stood and pressed. `velocityAt` says how the tip
// moved at a sample [m/s], by its number, and `over` where it is.
std::vector<PressSample> pressesOf(const std::vector<PathSample>& path,
                                   const std::function<Vec3(std::size_t)>& velocityAt,
                                   const std::function<TipOver(const PathSample&)>& over);

// `scan` is of a fused path, `poses` are those that it was made of. `normal`: outwards, in the
// camera's frame; else that of touchedPlane(). compliance [m/N]: what the surface yields by;
// else what its presses say, if any. Heights are of the surface as nobody presses it,
// along that normal, from the plane. Throws Error as touchedPlane() does, where nothing touches,
// and where the accelerometers' axes do not span space.
ScanHeights scanHeights(const FilteredScan& scan, const std::vector<CameraPose>& poses,
                        const ProbeModel& probe, const Vec3& gravity,
                        const std::optional<Vec3>& normal = {},
                        const std::optional<double>& compliance = {});

} // namespace patina
