#include "session/edit/lay_picture.h"

#include "session/store/replay.h"

namespace patina {

Projection usualProjection(const TriangleMesh& mesh) {
  return mesh.corner_uvs.size() == mesh.triangles.size() ? Projection::mapped : Projection::z;
}

void layPicture(Scene& scene, const CompiledScene& compiled, const PictureEdit& edit,
                const Picture& picture, std::shared_ptr<const PaintSurface>& surface,
                Progress& progress) {
  surface = paintSurfaceOf(compiled, scene, surface, true, progress);
  scene.objects[edit.object].paint =
      laid(*surface, scene, edit.object, picture, edit.projection, edit.target);
}

} // namespace patina
