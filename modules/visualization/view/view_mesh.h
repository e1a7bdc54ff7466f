// Parts of a mesh for a view: what is drawn, frames the picture, or lies under the pointer.
#pragma once

#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene.h"
#include "visualization/values/camera.h"

namespace patina {

// Returns the scene's combined mesh without the objects whose entry is true.
TriangleMesh withoutObjects(const TriangleMesh& mesh, const Scene& scene,
                            const std::vector<bool>& left_out);

// Returns finite vertices that are extreme in every direction, and with `shell` > 0 [m] also those
// of an offset surface, moved away from `centre`. Of many triangles each vertex comes about once.
std::vector<Vec3> outermostPoints(const TriangleMesh& mesh, const Vec3& centre, double shell);

// Returns at most `most` vertices before the view ray's origin that are nearer to the ray than
// `reach` is at their depth, the nearest first.
std::vector<Vec3> verticesNear(const TriangleMesh& mesh, const Ray& view_ray, const Ray& reach,
                               std::size_t most);

} // namespace patina
