// What is written in a marker.
#pragma once

#include <memory>
#include <optional>

#include "acquisition/tracking/quad_finder.h"

namespace patina {

// Of the name in scan folders: "4x4_50", "apriltag_36h11" and what else OpenCV knows, which is
// loaded for it; each is kept. Throws Error naming those that there are.
const MarkerFamily& markerFamily(const std::string& name);

// Codes of a family that are looked for, each in its four turns.
class CodeBook {
 public:
  CodeBook(const MarkerFamily& family, const std::vector<int>& ids);
  explicit CodeBook(const MarkerFamily& family); // all of them

  struct Match {
    int id = 0;
    int turn = 0; // corner 0 of the marker is this corner of the quad
    int wrong = 0;
  };
  std::optional<Match> match(std::uint64_t code) const;
  const MarkerFamily& family() const { return *family_; }

 private:
  const MarkerFamily* family_;
  std::vector<int> ids_;
  std::vector<std::array<std::uint64_t, 4>> turned_;
};

// From the unit square, (0, 0) to corner 0 and (1, 0) to corner 1, to the quad.
Eigen::Matrix3d squareTo(const Quad& quad);

// The code inside of a quad whose border is black; `quad` in the image's pixels.
std::optional<CodeBook::Match> readCode(const GreyFrame& image, const Quad& quad,
                                        const CodeBook& book);

} // namespace patina
