// A camera from pictures of a board, and a tip from poses about it, with the files that say so
// (A05).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "acquisition/calibration/board.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/sources/sources.h"
#include "core/progress.h"

namespace patina {

struct CalibratedCamera {
  CameraFit fit;
  std::size_t frames = 0;            // that there were
  std::size_t views = 0;             // that the fit used
  std::size_t unlike = 0;            // with the board that it could do without, or blurred
  std::vector<std::size_t> rejected; // frames without the board, of those that were looked at
  std::string first_rejected;        // its name
  std::vector<std::string> notes;    // a line each: of the source, and of frames that are turned
  std::string doubt;                 // why it is no calibration; empty if it is one
};
// In the order of CameraFit::deviation.
inline constexpr const char* kCameraParameters[] = {"fx", "fy", "cx", "cy", "k1",
                                                    "k2", "p1", "p2", "k3"};

std::array<double, 9> parametersOf(const Camera& camera);

// Called for each frame as it is looked at, in the caller's thread.
using BoardSeen = std::function<void(std::size_t frame, const std::optional<BoardView>& view)>;
// All pictures are used. Of frames that follow one another, as in a video, 240 or more are
// looked at, and at most 60 used that are sharp and differ in the board's pose and in time; a live
// source ends when it has shown as many, or is cancelled, which then is no error. Throws FileError
// naming a picture, or `from`: another size than the first, a board that does not fit, fewer than
// three views, no camera that explains them; Cancelled.
CalibratedCamera calibrateCamera(FrameSource& frames, const Board& board,
                                 const std::string& board_text, const std::string& from,
                                 Progress& progress, const BoardSeen& seen = {});

// A view that could be used.
struct ViewChoice {
  std::array<Vec2, 4> outline; // of the board [px]
  double sharpness = 0;
  double t = 0; // [s]
};
// `most` of them or fewer: among the sharp ones again and again that which is farthest from all
// that were chosen before, in parts of the picture's diagonal, until the rest is like them. In
// order.
std::vector<std::size_t> chooseViews(const std::vector<ViewChoice>& views, double diagonal,
                                     std::size_t most);
// camera.yml with deviations.
std::string calibratedText(const CameraFit& fit, const std::string& board_text);

// fitPivot(); throws FileError(from) where the poses do not tell the tip to a millimetre.
PivotFit tipOf(const std::vector<CameraPose>& poses, const std::string& from);
// A rig.json with this tip, all else as it was. Throws FileError(name).
std::string rigWithTip(const std::string& rig, const std::string& name, const PivotFit& fit);

} // namespace patina
