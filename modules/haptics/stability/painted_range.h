// What the objects of a scene may feel like at most and at least, painted or not.
#pragma once

#include <array>
#include <span>

#include "haptics/servo/felt_object.h"
#include "scene/scene.h"

namespace patina {

struct PaintedRange {
  std::array<bool, kMaterialChannels> painted{}; // on some object
  Material least, most;                          // the scene's own values included
  double relief = 0;                             // H [m], of |height| of pulled relief
  bool baked = false;                            // relief is in the field
  double texture_stiffness = 0;                  // [N/m], of textures that have their own; or 0
  double layer = 0; // [m], of textures that are a layer, over their lowest
  double bend = 0;  // [1/m], of the sharpest textureBend()

  bool has(MaterialChannel channel) const { return painted[static_cast<std::size_t>(channel)]; }
  bool any() const;
};
// h'' of an object's pulled relief and roughness at most [1/m]: under a normal force P they are
// P h'' stiff along the surface (F7). Baked relief is the field's.
// A texture that is a layer is not in it: the lateral coupling does not act on one.
double textureBend(const FeltObject& object);
PaintedRange paintedRange(const Material& base, std::span<const FeltObject> objects);

// How far roughness can raise what is felt [m]: for the band a field must have, before there are
// any samples. Looks at every node that is painted rough.
double roughnessPeak(const Scene& scene);

// `haptics` with the stiffest surface and the least damping there is: what a loop must bear.
HapticProperties hardest(HapticProperties haptics, const PaintedRange& range);

} // namespace patina
