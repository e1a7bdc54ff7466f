// A path that is held over a mesh by hand (A09): where it lies, how far it is from the surface, and
// the way back. No Qt.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scan/register_scans.h"

namespace patina {

// Of points from a surface.
struct Residuals {
  std::vector<double> distances; // [m], one a point
  std::vector<Vec3> feet;        // nearest of the surface [m], one a point
  double mean = 0, rms = 0, worst = 0;
};
Residuals residualsOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
                      const Pose& mesh_from_path);

// What the error is about a pose: by shifts along x, y, z and turns about the fixed axes through
// the points' middle, and over shifts along two axes at once.
struct Basin {
  double shift = 0, turn = 0;               // how far it was looked, to both sides [m, rad]
  std::array<std::vector<double>, 6> along; // rms [m], evenly from - to +; shifts, then turns
  int first = 0, second = 1;                // axes of the map
  int side = 0;                             // of the map
  std::vector<double> map;                  // rms [m], `first` fastest
};
// Throws Cancelled.
Basin basinOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
              const Pose& mesh_from_path, Progress& progress);

// Where each foot of the path lies on the mesh at a pose that a hand has found: all samples count.
Registration registeredAt(const SurfaceTarget& target, const std::vector<PathSample>& path,
                          const Pose& mesh_from_path);

class Alignment {
 public:
  // Either nullptr or empty: there is none. Begins anew, middle on middle. What distances need of a
  // mesh is made with the first path.
  void setMesh(std::shared_ptr<const TriangleMesh> mesh);
  void changeMesh(std::shared_ptr<const TriangleMesh> mesh); // the path stays where it lies
  void setPath(std::vector<PathSample> path);
  bool isReady() const { return target_ != nullptr && !path_.empty(); }

  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
  const std::vector<PathSample>& path() const { return path_; } // what of it takes part
  const std::vector<PathSample>& whole() const { return whole_; }
  // So many of the path's positions, evenly, as are looked at while a hand moves it.
  const std::vector<Vec3>& points() const { return points_; }
  const std::shared_ptr<const SurfaceTarget>& target() const { return target_; }

  const Pose& pose() const { return pose_; } // mesh_from_path
  Vec3 middle() const;                       // of the path, where it lies
  // Returns the fit that put the path where it is; nullopt where a hand did.
  const std::optional<Registration>& found() const;
  // Returns what the fit says of the path; where a hand has put it all samples count.
  Registration registration() const;
  bool isLaidByHand() const; // and not where it began
  void setPose(const Pose& pose);
  // A step that can be undone, if the pose has changed; `fit` has put the path there.
  void commit(std::optional<Registration> fit = {});
  bool undo(); // what is not committed goes too; false: there is nothing
  bool redo();
  std::vector<Pose> steps() const; // the first is the beginning
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
  std::vector<Vec3> points_;
  Pose pose_ = Pose::Identity();
  bool moved_ = false; // since the step that is done
  std::vector<Step> steps_;
  std::size_t at_ = 0;
};

} // namespace patina
