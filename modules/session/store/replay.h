// An edit of the past done again.
#pragma once

#include <memory>

#include "authoring/brush/painter.h"
#include "scene/edit.h"
#include "session/build/compile_scene.h"

namespace patina {

// The surface that strokes on `scene` need; `compiled` is of the same objects and field values,
// `earlier` (may be null) lends what still fits. Its field is the one that objects and field values
// alone give, so that a stroke paints the same nodes when it is replayed; slow to make where what
// is felt has a wider band or an older lattice.
std::shared_ptr<const PaintSurface> paintSurfaceOf(const CompiledScene& compiled,
                                                   const Scene& scene,
                                                   std::shared_ptr<const PaintSurface> earlier,
                                                   bool with_images, Progress& progress);
bool needsImages(const Brush& brush);

// What EditHistory calls to make a scene again: the same bits as when the edit was made. Compiles
// only where strokes must be replayed, and once for scenes of the same objects. Copies share what
// they compiled. One thread.
class Replayer {
 public:
  Replayer();
  // Something compiled that scenes of the past may fit to.
  void lend(std::shared_ptr<const CompiledScene> compiled,
            std::shared_ptr<const PaintSurface> surface);
  // invalid_argument for a SceneEdit: no record makes its scene.
  Scene operator()(const Scene& before, const Edit& edit) const;

 private:
  struct Known {
    std::shared_ptr<const CompiledScene> compiled;
    std::shared_ptr<const PaintSurface> surface;
  };
  std::shared_ptr<Known> known_;
};

} // namespace patina
