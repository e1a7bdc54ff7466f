#include "acquisition/calibration/calibrate_camera.h"

#include <cmath>

#include "acquisition/files/camera_file.h"
#include "acquisition/vision_library.h"
#include "core/error.h"
#include "core/json.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kWorstTip = 1e-3; // standard deviation of what is no tip [m]

std::optional<BoardView> boardIn(const GreyFrame& image, const Board& board,
                                 const std::string& name) try {
  return findBoard(image, board);
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(name, 0, error.what());
}

} // namespace

std::array<double, 9> parametersOf(const Camera& c) {
  const auto& d = c.distortion;
  return {c.fx, c.fy, c.cx, c.cy, d[0], d[1], d[2], d[3], d[4]};
}

CalibratedCamera calibrateCamera(const std::vector<Frame>& frames, const Board& board,
                                 const std::string& board_text, const std::string& from,
                                 Progress& progress, const BoardSeen& seen) {
  CalibratedCamera found;
  std::vector<BoardView> views;
  Camera& camera = found.fit.camera;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(0.8 * static_cast<double>(i) / static_cast<double>(frames.size()), "views");
    const std::string name = frames[i].file.string();
    const GreyFrame image = readGrey(frames[i].file);
    if (i == 0) {
      camera.width = image.width;
      camera.height = image.height;
    } else if (image.width != camera.width || image.height != camera.height) {
      throw FileError(name, 0, "is of another size than the views before it");
    }
    const auto view = boardIn(image, board, name);
    if (view)
      views.push_back(*view);
    else
      found.rejected.push_back(i);
    if (seen) seen(i, view);
  }
  if (views.size() < 3)
    throw FileError(from, 0,
                    "the board " + board_text + " is seen in " + std::to_string(views.size()) +
                        " of " + std::to_string(frames.size()) +
                        " views; three at least are needed");
  progress.report(0.8, "camera");
  if (const std::string cause = visionLibrary().calibrate(views, found.fit); !cause.empty())
    throw FileError(from, 0, cause);
  return found;
}

std::string calibratedText(const CameraFit& fit, const std::string& board_text) {
  std::string lines = "avg_reprojection_error: " + formatNumber(fit.rms) + "\nboard: \"" +
                      board_text + "\"\ndeviations: !!opencv-matrix\n   rows: 1\n" +
                      "   cols: 9\n   dt: d\n   data: [ ";
  for (std::size_t i = 0; i < fit.deviation.size(); ++i)
    lines += (i ? ", " : "") + formatNumber(fit.deviation[i]);
  return cameraText(fit.camera, lines + " ]\n");
}

PivotFit tipOf(const std::vector<CameraPose>& poses, const std::string& from) {
  const auto fit = fitPivot(poses);
  if (!fit)
    throw FileError(from, 0,
                    "the poses do not tell the tip: ten at least, turned to all sides about a "
                    "point that stands still");
  const double deviation = std::sqrt(fit->covariance.diagonal().maxCoeff());
  if (deviation > kWorstTip)
    throw FileError(from, 0,
                    "the poses tell the tip to " + formatLength(deviation) +
                        " only: it must stand still while the probe turns about it to all sides");
  return *fit;
}

std::string rigWithTip(const std::string& text, const std::string& name, const PivotFit& fit) {
  Json rig = parseJson(text, name);
  if (!rig.isObject()) throw FileError(name, 0, "is no object");
  rig.set("tip", Json(Json::Array{fit.tip.x(), fit.tip.y(), fit.tip.z()}));
  return rig.dump() + "\n";
}

} // namespace patina
