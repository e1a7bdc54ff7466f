// Converts the colours of a mesh to the first paint of its object.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh/mesh_colors.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/object_paint.h"

namespace patina {

// Largest side of an image for a mesh's colours [texels].
inline constexpr int kMaxColorTexels = 2048;

// Returns a paint with the colours of the mesh: of each face's picture, read through the mesh's own
// texture coordinates, of its vertices by barycentric weights of sRGB values, or its own (see
// MeshColors). Its layout is textureLayout()'s. The image has `least` texels a side, doubled up to
// kMaxColorTexels as pictures or 8 texels a face require. Null without colours. `warnings` gets a
// line each for unreadable pictures and for colours finer than the image.
std::shared_ptr<const ObjectPaint> paintOf(const TriangleMesh& mesh, const MeshColors& colors,
                                           int least, std::vector<std::string>& warnings);

} // namespace patina
