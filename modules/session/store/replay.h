// Replays recorded edits.
#pragma once

#include <memory>

#include "authoring/brush/painter.h"
#include "scene/edit.h"
#include "session/compile/compile_scene.h"

namespace patina {

// Returns the surface for strokes on `scene`. `compiled` has the same objects and field values;
// parts of `earlier` (may be null) are reused. Its field depends only on objects and field values,
// so that a replayed stroke paints the same nodes. Slow if the compiled field has a wider band or
// an older lattice.
std::shared_ptr<const PaintSurface> paintSurfaceOf(const CompiledScene& compiled,
                                                   const Scene& scene,
                                                   std::shared_ptr<const PaintSurface> earlier,
                                                   bool with_images, Progress& progress);
bool needsImages(const Brush& brush);

// Replay function of EditHistory: gives the same bits as the original edit. Compiles only if
// strokes must be replayed, and once for scenes with the same objects. Copies share the cache.
// Single-threaded.
class Replayer {
 public:
  Replayer();
  void cacheCompiled(std::shared_ptr<const CompiledScene> compiled,
                     std::shared_ptr<const PaintSurface> surface);
  // Throws invalid_argument for a SceneEdit, which holds its scene itself.
  Scene operator()(const Scene& before, const Edit& edit) const;

 private:
  struct Cache {
    std::shared_ptr<const CompiledScene> compiled;
    std::shared_ptr<const PaintSurface> surface;
  };
  std::shared_ptr<Cache> cache_;
};

} // namespace patina
