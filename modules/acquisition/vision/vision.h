// What the program asks of the library that holds OpenCV, which it loads with the first marker or
// board. Both sides are built together, so that C++ types may cross; exceptions may not.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "acquisition/camera.h"

namespace patina {

// Points of a board that one picture shows.
struct BoardView {
  std::vector<Vec2> board; // [m]
  std::vector<Vec2> pixel;
};

struct CameraFit {
  Camera camera;                     // its size is given
  std::array<double, 9> deviation{}; // of fx fy cx cy k1 k2 p1 p2 k3
  double rms = 0;                    // [px]
  std::vector<double> view_rms;      // [px]
};

// A marker as OpenCV's own search finds it, to compare with.
struct VisionMarker {
  int id = 0;
  std::array<Vec2, 4> corner; // as RigMarker::corners()
};
enum class VisionRefinement { none, subpix, contour, apriltag };

// Each returns an empty text, or why it could not.
struct VisionLibrary {
  // Its codes; not how many bits are forgiven.
  std::string (*family)(const std::string& name, MarkerFamily& out);
  // Inner corners of a chessboard by rows, to about a pixel; none if it is not seen.
  std::string (*chessboard)(const GreyFrame&, int columns, int rows, std::vector<Vec2>& corners);
  std::string (*markers)(const GreyFrame&, const std::string& family, VisionRefinement refinement,
                         std::vector<VisionMarker>& found);
  std::string (*calibrate)(const std::vector<BoardView>&, CameraFit& fit);
};

// The one symbol that is looked up.
inline constexpr const char* kVisionLibrarySymbol = "patinaVisionLibrary";
using VisionLibraryFunction = const VisionLibrary*();

} // namespace patina
