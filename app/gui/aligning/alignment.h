// A path aligned with a mesh by hand (A09): its pose, distances and undo steps. No Qt.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scan/register_scans.h"

namespace patina {

// Distances of points from a surface.
struct Residuals {
  std::vector<double> distances; // One for each point [m].
  std::vector<Vec3> feet;        // Closest points of the surface, one for each point [m].
  double mean = 0, rms = 0, worst = 0;
};
Residuals residualsOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
                      const Pose& mesh_from_path);

// The rms distance around a pose: for shifts along x, y, z and rotations about the fixed axes
// through the points' centroid, and for shifts along two axes at once.
struct CostProfile {
  double shift = 0, turn = 0; // Half ranges [m, rad].
  // Rms [m] at even steps from - to +; shifts, then rotations.
  std::array<std::vector<double>, 6> along;
  int first = 0, second = 1; // Axes of the map.
  int side = 0;              // Steps along each side of the map.
  std::vector<double> map;   // Rms [m], `first` varies fastest.
};
// Throws Cancelled.
CostProfile costProfileAround(const SurfaceTarget& target, const std::vector<Vec3>& points,
                              const Pose& mesh_from_path, Progress& progress);

// Returns the closest points at a pose set by hand; all samples are inliers.
Registration registeredAt(const SurfaceTarget& target, const std::vector<PathSample>& path,
                          const Pose& mesh_from_path);

class Alignment {
 public:
  // nullptr or an empty path: none. Restarts with the path's centroid on the mesh's.
  void setMesh(std::shared_ptr<const TriangleMesh> mesh);
  void changeMesh(std::shared_ptr<const TriangleMesh> mesh); // the path stays where it lies
  // The samples are those of the middle of a round tip, `tip_radius` [m] off the surface.
  void setPath(std::vector<PathSample> path, double tip_radius = 0);
  bool isReady() const { return target_ != nullptr && !path_.empty(); }

  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
  const std::vector<PathSample>& path() const { return path_; } // The samples in contact.
  const std::vector<PathSample>& whole() const { return whole_; }
  // Positions of an even subset of the samples, evaluated during a drag.
  const std::vector<Vec3>& points() const { return points_; }
  const std::shared_ptr<const SurfaceTarget>& target() const { return target_; }

  const Pose& pose() const { return pose_; } // mesh_from_path
  Vec3 centroid() const;                     // Centroid of the path at its pose.
  // Returns the fit that gave the present pose; nullopt if it was set by hand.
  const std::optional<Registration>& found() const;
  // Returns the fit, or the residuals of all samples if the pose was set by hand.
  Registration registration() const {
    return found() ? *found() : registeredAt(*target_, path_, pose_);
  }
  bool isLaidByHand() const { // True if moved by hand away from the first pose.
    return !steps_.empty() && !found() && !pose_.isApprox(steps_[0].pose, 1e-12);
  }
  void setPose(const Pose& pose) {
    moved_ = true;
    pose_ = pose;
  }
  // Adds an undo step if the pose has changed; `fit` is the fit that gave it.
  void commit(std::optional<Registration> fit = {});
  bool undo(); // Commits the pose first; false: nothing to undo.
  bool redo();
  std::vector<Pose> steps() const; // The first is the initial pose.
  std::size_t done() const { return at_; }
  std::size_t undone() const { return steps_.empty() ? 0 : steps_.size() - 1 - at_; }

 private:
  struct Step {
    Pose pose;
    std::optional<Registration> fit;
  };
  void begin();
  void makeTarget();

  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const SurfaceTarget> target_;
  std::vector<PathSample> whole_, path_;
  double tip_radius_ = 0;
  std::vector<Vec3> points_;
  Pose pose_ = Pose::Identity();
  bool moved_ = false; // Moved since the current step.
  std::vector<Step> steps_;
  std::size_t at_ = 0;
};

} // namespace patina
