// Painted scenes whose heights, slopes and values have closed forms.
#pragma once

#include <functional>

#include "scene/scene.h"

namespace patina {

// A closed slab, `side` wide and `thickness` high, with its top at z = 0 mapped to the whole unit
// square: u along x, v along y. The other faces share one point of the image.
Scene slabScene(double side, double thickness, int resolution);

// Adds an empty colour image, so that strokes keep the slab's own layout.
void layEmptyColor(Scene& slab, int image_size);

// Sets relief g(x, y) at the texels of the slab's top; x and y in metres from its middle.
void layRelief(Scene& slab, double side, int image_size,
               const std::function<double(double, double)>& g);

// Sets a channel's material at nodes of a grid of `voxel`, up to `depth` above and below the top.
// Full coverage.
void layMaterial(Scene& slab, double side, double voxel, double depth, MaterialChannel channel,
                 const std::function<double(const Vec3&)>& value);

} // namespace patina
