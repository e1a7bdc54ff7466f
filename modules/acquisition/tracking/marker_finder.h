// Finds markers in a picture (A04).
#pragma once

#include "acquisition/tracking/edge_fit.h"
#include "acquisition/tracking/marker_code.h"

namespace patina {

struct SeenMarker {
  std::string family;
  int id = 0;
  int hamming_distance = 0;           // Hamming distance to the code
  std::array<FittedCorner, 4> corner; // in the marker's order: top left, then clockwise
  double roughness = 0;               // roughness of the edges [px]
};

struct FinderOptions {
  // Adds two thresholds and twice the resolution, for small and blurred markers; ten times slower.
  bool thorough = false;
};

// Returns each marker once per detected place. `lens` undistorts; see FittedCorner.
std::vector<SeenMarker> findMarkers(const GreyFrame& image, const std::vector<CodeBook>& books,
                                    const Camera* lens, const FinderOptions& options = {});

} // namespace patina
