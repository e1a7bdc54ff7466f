// The colours that came with a mesh, as the first paint of its object.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh/mesh_colors.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/object_paint.h"

namespace patina {

// The most texels a side of an image that is made for a mesh's colours.
inline constexpr int kMostColorTexels = 2048;

// Returns a paint whose colour is that of each face's point: of its picture, read through the
// mesh's own texture coordinates, of its vertices by barycentric weights of their sRGB values, or
// its own (see MeshColors). Its layout is textureLayout()'s. Its image has `least` texels a side,
// or twice, four times as many ... up to kMostColorTexels where pictures or 8 texels a face need
// them. Null if nothing has a colour. Pictures that cannot be read, and colours that are finer than
// what is kept, are one line each in `warnings`.
std::shared_ptr<const ObjectPaint> paintOf(const TriangleMesh& mesh, const MeshColors& colors,
                                           int least, std::vector<std::string>& warnings);

} // namespace patina
