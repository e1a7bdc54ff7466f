// Markers in a picture (A04).
#pragma once

#include "acquisition/tracking/edge_fit.h"
#include "acquisition/tracking/marker_code.h"

namespace patina {

struct SeenMarker {
  std::string family;
  int id = 0;
  int wrong = 0;                      // bits that were forgiven
  std::array<FittedCorner, 4> corner; // as the marker has them: top left, then clockwise
  double roughness = 0;               // of its edges [px]
};

struct FinderOptions {
  // Looks with three splits of dark and bright, and at twice the size: small, blurred and crowded
  // markers, at ten times the cost.
  bool thorough = false;
};

// Each marker once for each place where it is seen. `lens` straightens; see FittedCorner.
std::vector<SeenMarker> findMarkers(const GreyFrame& image, const std::vector<CodeBook>& books,
                                    const Camera* lens, const FinderOptions& options = {});

} // namespace patina
