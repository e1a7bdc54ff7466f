// Interface of the library with OpenCV, which is loaded at the first marker or board. Both sides
// are built together, so that C++ types may be passed; exceptions may not.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "acquisition/values/camera.h"

namespace patina {

// Points of a board in one picture.
struct BoardView {
  std::vector<Vec2> board; // [m]
  std::vector<Vec2> pixel;
};

struct CameraFit {
  Camera camera;                     // the size is input
  std::array<double, 9> deviation{}; // fx fy cx cy k1 k2 p1 p2 k3
  double rms = 0;                    // [px]
};

// Each function returns an empty text, or the cause of the failure.
struct VisionLibrary {
  // Sets the codes; `max_correction` stays unset.
  std::string (*family)(const std::string& name, MarkerFamily& out);
  // Inner corners of a chessboard by rows, to about a pixel; empty if not found.
  std::string (*chessboard)(const GreyFrame&, int columns, int rows, std::vector<Vec2>& corners);
  std::string (*calibrate)(const std::vector<BoardView>&, CameraFit& fit);
};

// The only symbol that is looked up.
inline constexpr const char* kVisionLibrarySymbol = "patinaVisionLibrary";
using VisionLibraryFunction = const VisionLibrary*();

} // namespace patina
