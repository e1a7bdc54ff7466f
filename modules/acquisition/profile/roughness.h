// Roughness of a surface along a path: Ra and Rq of its heights below a cutoff wavelength.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/profile/scan_heights.h"

namespace patina {

// Longer waves count as shape. This standard cutoff is what accelerometers still measure in a
// hand's strokes: 10 Hz at 25 mm/s [m].
inline constexpr double kRoughnessCutoff = 2.5e-3;

struct RoughnessEstimate {
  double rq = 0, ra = 0;                     // rms and mean absolute height [m]
  double rq_deviation = 0, ra_deviation = 0; // standard deviation of their mean [m]
  std::size_t lengths = 0;                   // number of averaged sampling lengths of one cutoff
};

// Applies the Gaussian high-pass filter of ISO 16610-21, which passes half of a wave of the
// cutoff's length; half a cutoff is lost at each end of an interval. The deviation is that of the
// mean over the sampling lengths, without the heights' own errors: compare with their sigma.
// Returns nullopt for fewer than four lengths.
std::optional<RoughnessEstimate> roughnessOf(const std::vector<ScanHeight>& heights,
                                             double cutoff = kRoughnessCutoff);

} // namespace patina
