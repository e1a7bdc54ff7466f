// Codes of markers, and how they are read. The list of families is in vision/vision.cpp.
#pragma once

#include <memory>
#include <optional>

#include "acquisition/tracking/quad_finder.h"

namespace patina {

// Returns a family by its name in scan folders: "4x4_50", "apriltag_36h11" or another one of
// OpenCV, which is loaded for it and kept. Throws Error with the known names.
const MarkerFamily& markerFamily(const std::string& name);

// Codes of a family to search for, each in its four rotations.
class CodeBook {
 public:
  CodeBook(const MarkerFamily& family, const std::vector<int>& ids);
  explicit CodeBook(const MarkerFamily& family); // all of them

  struct Match {
    int id = 0;
    int quarter_turns = 0; // quarter turns: corner 0 of the marker is this corner of the quad
    int hamming_distance = 0;
  };
  std::optional<Match> match(std::uint64_t code) const;
  const MarkerFamily& family() const { return *family_; }

 private:
  const MarkerFamily* family_;
  std::vector<int> ids_;
  std::vector<std::array<std::uint64_t, 4>> turned_;
};

// Returns the homography from the unit square, (0, 0) at corner 0, (1, 0) at corner 1.
Eigen::Matrix3d homographyTo(const Quad& quad);

// Reads the code inside a quad with a black border; `quad` is in the image's pixels.
std::optional<CodeBook::Match> readCode(const GreyFrame& image, const Quad& quad,
                                        const CodeBook& book);

} // namespace patina
