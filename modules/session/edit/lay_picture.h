// Lays a picture on an object, for the command `scene --image` and the window.
#pragma once

#include <memory>

#include "authoring/brush/paint_surface.h"
#include "authoring/images/apply_image.h"
#include "core/progress.h"
#include "pictures/picture.h"
#include "session/compile/compile_scene.h"

namespace patina {

struct PictureEdit {
  std::size_t object = 0;
  PictureTarget target = PictureTarget::color;
  Projection projection = Projection::z;
};

// Returns the projection if none is chosen: the mesh's own texture coordinates if it has them, or
// z.
Projection usualProjection(const TriangleMesh& mesh);

// Changes the paint of the object, over what was painted. `compiled` has the scene's objects and
// field values. `surface` is reused by the next picture; null at first. Throws Error if the edit
// needs coordinates that the mesh lacks, and Cancelled; the scene is then unchanged.
void layPicture(Scene& scene, const CompiledScene& compiled, const PictureEdit& edit,
                const Picture& picture, std::shared_ptr<const PaintSurface>& surface,
                Progress& progress);

} // namespace patina
