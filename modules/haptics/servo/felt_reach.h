// How far from the surface it is felt, and the band of the field that this takes.
#pragma once

#include <span>

#include "field/store/field_grid.h"
#include "haptics/servo/felt_object.h"
#include "scene/haptic_properties.h"

namespace patina {

inline constexpr double kBandBeyondReach = 3; // voxels

struct FeltReach {
  double tip = 0;    // [m], its radius
  double raised = 0; // [m], the highest relief that is pulled, roughness included (raisedBy())
  double beyond = 0; // [m], offset or magnetic range, whichever is more

  double length() const { return tip + raised + beyond; } // [m]
  // The band that a field of this voxel [m] must have, in voxels.
  double band(double voxel) const { return length() / voxel + kBandBeyondReach; }
  // `spec` with its band widened to that, where need be, about a shape in this box.
  FieldSpec widened(const FieldSpec& spec, const Box3& box) const {
    return patina::widened(spec, box, length(), kBandBeyondReach);
  }
};

FeltReach feltReach(const HapticProperties& haptics, double raised = 0);
// [m], of the surface that is felt over the one in the field: kRoughnessPeak times the roughest
// paint and the highest pulled relief.
double raisedBy(std::span<const FeltObject> objects);

} // namespace patina
