// How rough a surface is along a path: Ra and Rq of its heights beyond a cutoff wavelength.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/profile/scan_heights.h"

namespace patina {

// Longer waves are the surface's shape. A standard cutoff, and what accelerometers still tell of a
// hand's strokes: 10 Hz at 25 mm/s [m].
inline constexpr double kRoughnessCutoff = 2.5e-3;

struct RoughnessEstimate {
  double rq = 0, ra = 0;                     // rms and mean size of the heights left [m]
  double rq_deviation = 0, ra_deviation = 0; // by how much sampling lengths differ [m]
  std::size_t lengths = 0;                   // that were averaged, each as long as the cutoff
};

// Heights less their mean by a Gaussian of which waves of the cutoff's length pass half; the
// cutoff's half at each end of a stretch is left out. The deviation says how well so many lengths
// tell the mean of the surface, and nothing of what heights' own errors add to it: compare with
// their sigma. Absent with fewer than four lengths.
std::optional<RoughnessEstimate> roughnessOf(const std::vector<ScanHeight>& heights,
                                             double cutoff = kRoughnessCutoff);

} // namespace patina
