// A camera from pictures of a board, and a tip from poses about it, with the files that say so
// (A05).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "acquisition/calibration/board.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/files/frame_files.h"
#include "core/progress.h"

namespace patina {

struct CalibratedCamera {
  CameraFit fit;
  std::vector<std::size_t> rejected; // frames without the board
};
// In the order of CameraFit::deviation.
inline constexpr const char* kCameraParameters[] = {"fx", "fy", "cx", "cy", "k1",
                                                    "k2", "p1", "p2", "k3"};

std::array<double, 9> parametersOf(const Camera& camera);

// Called for each frame as it is looked at, in the caller's thread.
using BoardSeen = std::function<void(std::size_t frame, const std::optional<BoardView>& view)>;
// Throws FileError naming a picture, or `from`: another size than the first, a board that does not
// fit, fewer than three views, no camera that explains them; Cancelled.
CalibratedCamera calibrateCamera(const std::vector<Frame>& frames, const Board& board,
                                 const std::string& board_text, const std::string& from,
                                 Progress& progress, const BoardSeen& seen = {});
// camera.yml with deviations.
std::string calibratedText(const CameraFit& fit, const std::string& board_text);

// fitPivot(); throws FileError(from) where the poses do not tell the tip to a millimetre.
PivotFit tipOf(const std::vector<CameraPose>& poses, const std::string& from);
// A rig.json with this tip, all else as it was. Throws FileError(name).
std::string rigWithTip(const std::string& rig, const std::string& name, const PivotFit& fit);

} // namespace patina
