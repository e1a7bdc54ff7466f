// Data of a compiled scene for the brush.
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
  std::int32_t first_face = 0, faces = 0; // in the combined mesh
  Pose world_from_object = Pose::Identity();
  Vec3 middle = Vec3::Zero();             // box centre, object frame
  TextureLayout layout;                   // its paint's, if any; see withImages()
  std::shared_ptr<const TexelMap> texels; // null until withImages()
};

// Immutable and slow to make; any number of strokes share one.
struct PaintSurface {
  std::shared_ptr<const TriangleMesh> mesh;   // combined mesh, world
  std::shared_ptr<const SurfaceField> field;  // field of all objects without baked relief
  std::shared_ptr<const Adjacency> adjacency; // neighbours in the welded mesh
  std::vector<PaintObject> objects;           // in scene order
  // The combined mesh with vertices at equal positions of an object merged, so that the brush
  // crosses cracks in the indices; the combined mesh itself if there are none.
  std::shared_ptr<const TriangleMesh> welded;
  std::size_t bytes() const; // without mesh and field
};

// Throws Cancelled. `mesh` and `field` are those of the compiled scene.
std::shared_ptr<const PaintSurface> paintSurface(const Scene& scene,
                                                 std::shared_ptr<const TriangleMesh> mesh,
                                                 std::shared_ptr<const SurfaceField> field,
                                                 Progress& progress);
// Adds layouts and texel maps, which colour and relief need. An object without images gets a layout
// for images of scene.paint_size; others keep theirs.
std::shared_ptr<const PaintSurface> withImages(const PaintSurface& surface, const Scene& scene,
                                               Progress& progress);
bool hasImages(const PaintSurface& surface);

} // namespace patina
