// Writes painted objects for ParaView. Files are written atomically; all functions throw FileError.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace patina {

// Writes an object's surface in the world frame [m], with triangles as fine as its images' texels
// and its material's grid (about half a million at most), the array "face" of each triangle,
// texture coordinates if it has images, and the paint as point data: "color" (RGB bytes, over the
// object's own colour), "relief [m]", and the rendered material: "stiffness [N/m]",
// "friction.static", "friction.dynamic", "damping [N s/m]", "roughness [m]". Absent paint is left
// out. Throws invalid_argument for an object without paint.
void writePaintVtp(const std::filesystem::path& path, const Scene& scene, std::size_t object);

// Writes the box of the material's blocks in the object's pose, one point per node, with the same
// material arrays. Throws invalid_argument for an object without material.
void writeMaterialVti(const std::filesystem::path& path, const Scene& scene, std::size_t object);

} // namespace patina
