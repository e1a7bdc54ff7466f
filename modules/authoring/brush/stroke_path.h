// Where a stroke lays its dabs: samples in, places and radii out (K19).
#pragma once

#include <optional>
#include <vector>

#include "field/store/field_grid.h"
#include "scene/stroke.h"

namespace patina {

struct PathStep {
  Vec3 position = Vec3::Zero(); // [m], world; near the surface
  double radius = 0;            // [m]
  bool connected = false;       // with the step before
  std::optional<Vec3> tip{};    // [m], world; absent where either sample has none
};

class StrokePath {
 public:
  StrokePath(const Brush& brush, const FieldGrid& grid) : brush_(brush), grid_(grid) {}

  // The steps from the last sample to this one, which comes last unless the field does not reach
  // it: a quarter of the radius apart, or a 64th of a voxel, so that a needle of a brush comes to
  // an end. The radius follows the force through a low-pass of 50 ms of the samples' own time, so
  // that its noise leaves no notches. Samples that are not finite, or absurdly
  // far away, are as if they had not been.
  std::vector<PathStep> to(const StrokeSample& sample);
  bool reached() const { return reached_; } // whether the last step is at the last sample

 private:
  Brush brush_;
  FieldGrid grid_;
  std::optional<StrokeSample> last_;
  double radius_ = 0; // at the last sample
  bool reached_ = false;
};

} // namespace patina
