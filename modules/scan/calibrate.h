// A camera from pictures of a board; a probe's tip, accelerometers and force from what it shows:
// what `patina calibrate` and the card Calibrate run.
#pragma once

#include <string>
#include <vector>

#include "acquisition/calibration/calibrate_camera.h"
#include "acquisition/calibration/calibrate_rig.h"
#include "acquisition/calibration/probe_calibration.h"
#include "acquisition/files/scan_tables.h"

namespace patina {

struct CameraCalibrationOptions {
  std::string frames; // see openFrames(); a folder of pictures needs no times
  Board board;
  std::string board_text; // text that parseBoard() has read
  double rate = 0;        // [Hz], see openFrames()
};
struct CameraCalibration : CalibratedCamera {
  std::string file; // the text of camera.yml, with deviations; empty where there is a `doubt`
};
// Throws as openFrames() and fitCameraToFrames() do. `seen` is called in the caller's thread.
CameraCalibration calibrateCamera(const CameraCalibrationOptions& options, Progress& progress,
                                  const BoardSeen& seen = {});

// A rig.json to which a calibration is added; without a text there is none.
struct RigText {
  std::string text, name;
};

struct TipCalibration {
  PivotFit fit;
  std::string file; // the text of rig.json
};
// Estimates the tip from poses of a probe that turned about its resting tip. Throws FileError: the
// poses (`from`) do not determine the tip to a millimetre, or the rig is invalid.
TipCalibration calibrateTip(const std::vector<CameraPose>& poses, const std::string& from,
                            const RigText& rig);

struct RigCalibrationOptions {
  std::string frames; // see openFrames()
  double rate = 0;    // [Hz], see openFrames()
  Camera camera;
  FinderOptions finder{};
  RigFitOptions fit{};
};
struct RigCalibration {
  RigFit fit;
  std::size_t frames = 0;            // frames that were searched
  std::string file;                  // the text of rig.json; empty where there is a `doubt`
  std::string doubt;                 // why the result is none, or empty
  std::vector<std::string> warnings; // remarks about the source, and what is wrong with the rig
};
// Estimates the markers' places and sizes, and the tip if the probe turned about it, from frames in
// which the rig is waved. Throws as openFrames(), viewsOfRig(), fitRig() and parseMarkers() do.
RigCalibration calibrateRig(const RigCalibrationOptions& options, const RigText& rig,
                            Progress& progress);

struct AxesCalibration {
  AccelerometerCalibration fit;
  ProbeModel probe; // the rig's probe
  std::string file; // the text of rig.json
};
// Estimates the accelerometers' axes from a scan of the probe held still in the air. The rig gives
// approximate axes; without one a common probe is assumed. Throws FileError: too few or too similar
// attitudes, or gravity is not read as 9.81 m/s^2.
AxesCalibration calibrateAxes(const std::filesystem::path& folder, const RigText& rig,
                              std::vector<std::string>& warnings);

struct ForceCalibration {
  ForceFit fit;
  std::size_t readings = 0;
  std::string file; // the text of rig.json
};
// Estimates zero and gain from a table of known forces and readings. Throws FileError with the
// line. Appends to `warnings` the columns that are not used and the readings that contradict the
// others.
ForceCalibration calibrateForce(const std::filesystem::path& table, const RigText& rig,
                                std::vector<std::string>& warnings);

} // namespace patina
