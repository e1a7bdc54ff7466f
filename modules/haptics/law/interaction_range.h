// Interaction range of the surface, and the field's band that it requires.
#pragma once

#include <span>

#include "field/store/field_grid.h"
#include "haptics/law/haptic_object.h"
#include "scene/haptic_properties.h"

namespace patina {

inline constexpr double kBandBeyondReach = 3; // [voxels]

struct InteractionRange {
  double tip = 0;        // radius of the tip [m]
  double max_relief = 0; // highest relief outside the field, with roughness (reliefOver()) [m]
  double beyond = 0;     // offset or magnetic range, the larger one [m]

  double length() const { return tip + max_relief + beyond; } // [m]
  // Band [voxels] that a field of this voxel size [m] needs.
  double band(double voxel) const { return length() / voxel + kBandBeyondReach; }
  // Returns `spec` with its band widened to that if necessary, for a shape in this box.
  FieldSpec widened(const FieldSpec& spec, const Box3& box) const {
    return patina::widened(spec, box, length(), kBandBeyondReach);
  }
};

InteractionRange interactionRange(const HapticProperties& haptics, double max_relief = 0);
// Largest height of the haptic surface above the field's [m]: kRoughnessPeak times the largest
// painted roughness plus the highest relief outside the field.
double reliefOver(std::span<const HapticObject> objects);

} // namespace patina
