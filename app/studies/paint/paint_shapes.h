// Painted scenes whose heights, slopes and values are known in closed form.
#pragma once

#include <functional>

#include "scene/scene.h"

namespace patina {

// A closed slab, `side` wide and `thickness` high, its top at z = 0 and laid out over the whole
// unit square: u along x, v along y. The other faces share one point of the image.
Scene slabScene(double side, double thickness, int resolution);

// An empty colour image, by which strokes keep the slab's own layout.
void layEmptyColor(Scene& slab, int image_size);

// The relief g(x, y) at each texel's place on the slab's top; x and y in metres from its middle.
void layRelief(Scene& slab, double side, int image_size,
               const std::function<double(double, double)>& g);

// Material of one channel, its node values given over the slab's own grid of `voxel`, reaching
// `depth` above and below its top. Whole coverage.
void layMaterial(Scene& slab, double side, double voxel, double depth, MaterialChannel channel,
                 const std::function<double(const Vec3&)>& value);

} // namespace patina
