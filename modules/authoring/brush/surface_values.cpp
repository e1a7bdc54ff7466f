#include "authoring/brush/surface_values.h"

#include <algorithm>

#include "scene/paint/grey_relief.h"

namespace patina {

SurfaceValues surfaceValues(const Scene& scene, std::size_t object, const SurfacePoint& point) {
  SurfaceValues values;
  values.material = baseMaterial(scene.haptics);
  const SceneObject& owner = scene.objects.at(object);
  if (!owner.paint || point.face < 0) return values;
  const ObjectPaint& paint = *owner.paint;
  if (paint.layout.uvs) {
    const std::array<Vec2, 3>& uv = paint.layout.uvs->at(static_cast<std::size_t>(point.face));
    const Vec3& w = point.barycentric;
    const Vec2 at = w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2];
    for (int c = 0; paint.color && c < kColorChannels; ++c)
      values.color[static_cast<std::size_t>(c)] = paint.color->sample(at.x(), at.y(), c);
    if (scene.relief.source == ReliefSource::color)
      values.height =
          scene.relief.height *
          std::clamp(grey({values.color[0], values.color[1], values.color[2]}), 0.0, 1.0);
    else if (paint.relief)
      values.height = scene.relief.height * paint.relief->sample(at.x(), at.y(), 0);
  }
  if (paint.material)
    values.material = paint.material->at(position(*owner.mesh, point), values.material);
  return values;
}

} // namespace patina
