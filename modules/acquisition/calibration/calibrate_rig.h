// A marker rig that was made by hand, from frames in which it is waved: places and sizes of its
// markers and its tip, with deviations, in one bundle adjustment (A31).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/calibration/rig_views.h"
#include "core/decompose.h"

namespace patina {

// The measured side of one marker's black square.
struct MeasuredSize {
  int id = 0;
  double size = 0; // [m]
};

struct RigFitOptions {
  std::vector<MeasuredSize> measured;
  bool refine_camera = false; // focal lengths, center and the first five lens terms too
  // Standard deviations of the hand's and the printer's work, to which the fit adds what it finds.
  double place = 0.3e-3;     // a marker's place along each axis [m]
  double angle = 8.7e-3;     // its turn about each axis [rad]
  double print = 0.01;       // size of all markers, relative
  double own_print = 2e-3;   // size of one marker over the others', relative
  double calliper = 0.01e-3; // a measured size [m]
  double dimple = 0.03e-3;   // the tip's place while it turns in a dimple, each axis [m]
};

struct FittedMarker {
  RigMarker marker;      // place and size that were found
  std::size_t views = 0; // frames used that show it
  // Errors of rig.json, with standard deviations (rms over the axes).
  double shift = 0, shift_deviation = 0; // distance of its center [m]
  double turn = 0, turn_deviation = 0;   // [rad]
  double size_deviation = 0;             // [m]
  std::string finding; // "is where marker 2 should be", "lies 1.02 mm off", or empty
};

struct FittedTip {
  Vec3 place = Vec3::Zero();                            // in the probe's frame [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(); // [m^2]
  std::size_t views = 0, dimples = 0;
  double rms = 0; // distance of the tips from their dimples [m]
};

struct RigFit {
  std::vector<FittedMarker> markers;                 // in the order of the rig
  double print_scale = 1, print_scale_deviation = 0; // found sizes over those of rig.json
  std::optional<FittedTip> tip;                      // absent: the probe did not turn in a dimple
  Camera camera;
  std::array<double, 9> camera_deviation{}; // fx fy cx cy k1 k2 p1 p2 k3; 0: not refined
  std::size_t views = 0;                    // frames used
  double rms_before = 0, rms = 0;           // reprojection error [px]
  std::vector<std::string> held;            // lines about values that the motion did not determine
  // Joint covariance of the motions of the markers that were seen (shift, turn), of the logarithms
  // of their sizes and of the tip if present, in the frame that fits rig.json best.
  MatX covariance;
};

// Solves one problem (Triggs et al. 1999) for the rig, the tip and the pose of each frame. Throws
// FileError with the remedy if the views do not suffice: too few frames with two markers, too
// little turning, or a measured marker that the rig has not.
RigFit fitRig(const std::vector<RigView>& views, const std::vector<RigMarker>& rig,
              const Camera& camera, const RigFitOptions& options, const std::string& from);

} // namespace patina
