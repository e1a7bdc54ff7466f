// Calibration of a camera from a board and of a tip from poses about it, with their files (A05).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "acquisition/calibration/board_guide.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/sources/sources.h"
#include "core/progress.h"

namespace patina {

struct CalibratedCamera {
  CameraFit fit;
  std::size_t frames = 0;            // number of frames
  std::size_t views = 0;             // number of views in the fit
  std::size_t unlike = 0;            // redundant or blurred views that were not used
  std::vector<std::size_t> rejected; // searched frames without the board
  std::string first_rejected;        // name of the first of them
  std::vector<std::string> notes;    // remarks about the source and turned frames, one line each
  std::string doubt;                 // why the calibration is unreliable; else empty
};
// Names in the order of CameraFit::deviation.
inline constexpr const char* kCameraParameters[] = {"fx", "fy", "cx", "cy", "k1",
                                                    "k2", "p1", "p2", "k3"};

std::array<double, 9> parametersOf(const Camera& camera);

// A frame that was searched for the board. References are valid during the call only.
struct BoardLook {
  std::size_t frame;
  const GreyFrame& image;
  const std::optional<BoardView>& view;
  const BoardGuide& guide; // its state for a live source; else empty
};
// Called for each searched frame, in the caller's thread.
using BoardSeen = std::function<void(const BoardLook&)>;
// All pictures are used. Of frames that follow one another, as in a video, 240 or more are
// looked at, and at most 60 used that are sharp and differ in the board's pose and in time. Of a
// live source the good views of a BoardGuide are used, whose advice is the progress' phrase; it
// ends when the guide is complete, or is cancelled, which then is no error. Throws FileError naming
// a picture, or `from`: another size than the first, a board that does not fit, fewer than three
// views, no camera that explains them; Cancelled.
CalibratedCamera fitCameraToFrames(FrameSource& frames, const Board& board,
                                   const std::string& board_text, const std::string& from,
                                   Progress& progress, const BoardSeen& seen = {});

// A candidate view.
struct ViewChoice {
  std::array<Vec2, 4> outline; // outline of the board [px]
  double blur = 0;             // see blurOf() [px]
  double t = 0;                // [s]
};
// Chooses at most `most` views, in order: repeatedly the sharp view that is farthest from all
// chosen ones, in picture diagonals, until the rest is similar to them.
std::vector<std::size_t> chooseViews(const std::vector<ViewChoice>& views, double diagonal,
                                     std::size_t most);
// Returns camera.yml with deviations.
std::string calibratedText(const CameraFit& fit, const std::string& board_text);

// Pivot calibration by fitPivot(). Throws FileError(from) if the tip's deviation exceeds 1 mm.
PivotFit calibratePivot(const std::vector<CameraPose>& poses, const std::string& from);
// Returns rig.json with this tip, its deviation, and all else unchanged. Throws FileError(name).
std::string withTip(const std::string& rig, const std::string& name, const PivotFit& fit);

} // namespace patina
