// Painted objects as files that ParaView reads. Written atomically; all throw FileError.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace patina {

// An object's surface in the world frame [m], in triangles as fine as its images' texels and its
// material's grid (about half a million at most), with the array "face" of each triangle, texture
// coordinates where it has images, and what is painted as point data: "color" (RGB bytes, over the
// object's own colour), "relief [m]", and material as felt: "stiffness [N/m]", "friction.static",
// "friction.dynamic", "damping [N s/m]", "roughness [m]". Only what exists. Throws invalid_argument
// for an object without paint.
void writePaintVtp(const std::filesystem::path& path, const Scene& scene, std::size_t object);

// The box of its material's blocks, one point a node, turned and placed as the object is; the same
// arrays of material, as felt. invalid_argument for an object without material.
void writeMaterialVti(const std::filesystem::path& path, const Scene& scene, std::size_t object);

} // namespace patina
