// Everything that the brush needs to know of a compiled scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "field/store/surface_field.h"
#include "geometry/atlas/texel_map.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/adjacency.h"
#include "scene/scene.h"

namespace patina {

struct PaintObject {
  std::int32_t first_face = 0, faces = 0; // in the joint mesh
  Pose world_from_object = Pose::Identity();
  Vec3 middle = Vec3::Zero();             // of the object's box, object frame: symmetry's plane
  TextureLayout layout;                   // the painted one where there is one; see withImages()
  std::shared_ptr<const TexelMap> texels; // null until withImages()
};

// Immutable and slow to make; any number of strokes share one.
struct PaintSurface {
  std::shared_ptr<const TriangleMesh> mesh;   // joint, world
  std::shared_ptr<const SurfaceField> field;  // of all objects, as built: relief is never baked in
  std::shared_ptr<const Adjacency> adjacency; // of the welded mesh
  std::vector<PaintObject> objects;           // in the scene's order
  // The joint mesh with one vertex for each place of an object, so that the brush crosses cracks in
  // the indices; the joint mesh itself where there are none.
  std::shared_ptr<const TriangleMesh> welded;
  std::size_t bytes() const; // beyond mesh and field
};

// Throws Cancelled. `mesh` and `field` are those of the compiled scene.
std::shared_ptr<const PaintSurface> paintSurface(const Scene& scene,
                                                 std::shared_ptr<const TriangleMesh> mesh,
                                                 std::shared_ptr<const SurfaceField> field,
                                                 Progress& progress);
// The same with layouts and texel maps, which only colour and relief need. An object that has no
// images yet gets its layout for images of scene.paint_size; one that has keeps its own.
std::shared_ptr<const PaintSurface> withImages(const PaintSurface& surface, const Scene& scene,
                                               Progress& progress);
bool hasImages(const PaintSurface& surface);

} // namespace patina
