// Three places of a path and the same three of its mesh, clicked in turn, and where they put it.
#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "app/gui/aligning/alignment.h"
#include "visualization/layers/path_layer.h"
#include "visualization/view/camera.h"

namespace patina {

class PointPicking {
 public:
  explicit PointPicking(const Alignment& alignment) : alignment_(alignment) {}

  void set(bool on); // anew
  bool on() const { return on_; }
  // Takes what is asked for if the sight meets it, by no more than reach [m] and apart from others.
  void pick(const Ray& sight, double reach);
  QString words() const; // what is asked for; empty: nothing is
  std::vector<DrawnMark> marks() const;
  std::optional<Pose> pose() const; // mesh_from_path; nullopt: places are missing

 private:
  const Alignment& alignment_;
  std::vector<Vec3> on_path_, on_mesh_;
  bool on_ = false;
};

} // namespace patina
