// Extreme haptic values of a scene's objects, painted or not.
#pragma once

#include <array>
#include <span>

#include "haptics/law/haptic_object.h"
#include "scene/scene.h"

namespace patina {

struct PaintedRange {
  std::array<bool, kMaterialChannels> painted{}; // on any object
  Material min, max;                             // with the scene's own values
  // H, the largest |height| of relief that is not baked into the field [m]
  double relief = 0;
  bool baked = false;           // relief is part of the field
  double texture_stiffness = 0; // stiffest texture with its own stiffness [N/m]; 0: none
  double layer = 0;             // height of texture layers above their lowest point [m]
  double max_curvature = 0;     // largest maxTextureCurvature() [1/m]

  bool has(MaterialChannel channel) const { return painted[static_cast<std::size_t>(channel)]; }
  bool any() const;
};
// Largest h'' of an object's relief outside the field and of its roughness [1/m]: under a normal
// force P they have the tangential stiffness P h'' (F7). Texture layers are excluded, because the
// lateral coupling does not act on them.
double maxTextureCurvature(const HapticObject& object);
PaintedRange paintedRange(const Material& base, std::span<const HapticObject> objects);

// Largest height of roughness above the surface [m], from all rough nodes: the field's band must
// include it before samples exist.
double roughnessPeak(const Scene& scene);

// Returns `haptics` with the largest stiffness and the smallest damping, the worst case.
HapticProperties worstCase(HapticProperties haptics, const PaintedRange& range);

} // namespace patina
