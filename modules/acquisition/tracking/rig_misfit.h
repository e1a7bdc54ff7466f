// Test whether a rig of markers is as its file has it: the corners of a whole scan together say so
// where those of one frame cannot (A32).
#pragma once

#include <string>
#include <vector>

#include "acquisition/tracking/rig_pose.h"
#include "acquisition/values/scan_samples.h"
#include "core/decompose.h"

namespace patina {

// Sums what each frame says of the markers' places and sizes, with its pose eliminated.
class RigMisfit {
 public:
  RigMisfit(const std::vector<RigMarker>& rig, const Camera& camera);
  void setCamera(const Camera& camera) { camera_ = camera; }
  // Adds a frame. `pose` is its place among the poses whose deviations may grow, or none.
  void add(const std::vector<SeenMarker>& markers, const SeenRig& seen,
           std::optional<std::size_t> pose);

  struct Diagnosis {
    std::string text; // "marker 3 lies 0.4 mm off; calibrate the rig"; empty: the rig is right
    std::vector<double> shift; // distances of the markers from their places, if seen [m]
    double scale = 0;          // excess of all sizes, relative
  };
  // Returns the probable cause if the frames contradict the rig, and then adds to the deviations
  // of the poses what the wrong rig may have done to them.
  Diagnosis judge(std::vector<CameraPose>& poses) const;

 private:
  struct FramePart {
    std::size_t pose;
    std::vector<std::size_t> used; // the markers that gave the pose
    Eigen::MatrixXf by_rig;        // derivatives of the pose by their motions, then by their sizes
  };
  // Counts of the frames that show a marker.
  struct Sightings {
    std::size_t seen = 0, far = 0;     // shown with others; too far from its place
    std::vector<std::size_t> in_place; // times it was in the place of another one, by marker
    std::size_t turned = 0;            // times it was in its place but turned
  };
  void countElsewhere(std::size_t i, const SeenMarker& image, const Pose& pose);

  std::vector<RigMarker> rig_;
  Camera camera_;
  MatX normal_; // order: for each marker motion, logarithm of the size, lasting errors of corners
  VecX gradient_;
  double squares_ = 0;
  std::size_t residuals_ = 0, frames_ = 0;
  double pixel_ = 0; // sum over frames of the size of a pixel at the rig [m]
  std::vector<Sightings> sightings_;
  std::vector<FramePart> parts_;
};

} // namespace patina
