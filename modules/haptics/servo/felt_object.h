// What the servo knows of one object beyond the field that all share.
#pragma once

#include <cstdint>
#include <memory>

#include "core/types.h"
#include "scene/paint/material_samples.h"
#include "scene/paint/relief_surface.h"

namespace patina {

struct FeltObject {
  std::int32_t first_face = 0; // in the joint mesh; objects follow one another
  Pose object_from_world = Pose::Identity();
  std::shared_ptr<const MaterialSamples> material; // absent: the scene's own values
  std::shared_ptr<const ReliefSurface> relief;     // what of relief and textures is pulled, if any
  bool baked = false;                              // relief is in the field
  double highest = 0;                              // [m], of |height| of `relief`
  // Textures where they are a layer of their own (HapticProperties::texture_gain); not in `relief`.
  std::shared_ptr<const ReliefSurface> layer;
  // [1/m], the largest |h''| of the relief along the surface, by its second differences. It decides
  // whether a loop is steady on it (F7).
  double bend = 0;
};

} // namespace patina
