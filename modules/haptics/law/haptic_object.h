// Data of one object that the servo needs beside the common field.
#pragma once

#include <cstdint>
#include <memory>

#include "core/types.h"
#include "scene/paint/material_samples.h"
#include "scene/paint/relief_surface.h"

namespace patina {

struct HapticObject {
  std::int32_t first_face = 0; // in the combined mesh; objects follow one another
  Pose object_from_world = Pose::Identity();
  std::shared_ptr<const MaterialSamples> material; // absent: the scene's values
  std::shared_ptr<const ReliefSurface>
      relief;         // relief and textures not baked into the field, if any
  bool baked = false; // relief is part of the field
  double highest = 0; // largest |height| of `relief` [m]
  // Textures that form a separate layer (HapticProperties::texture_gain); not in `relief`.
  std::shared_ptr<const ReliefSurface> layer;
  // Largest |h''| of the relief along the surface, from second differences [1/m]. It decides
  // whether the loop is stable on it (F7).
  double max_curvature = 0;
};

} // namespace patina
