#include "scene/paint/object_paint.h"

namespace patina {
namespace {

template <typename T>
bool sameParts(const std::shared_ptr<const T>& a, const std::shared_ptr<const T>& b) {
  if (a == b) return true;
  return a && b && same(*a, *b);
}

} // namespace

std::size_t bytes(const ObjectPaint& paint) {
  return (paint.color ? paint.color->bytes() : 0) + (paint.relief ? paint.relief->bytes() : 0) +
         (paint.material ? paint.material->bytes() : 0) +
         (paint.textures ? paint.textures->faces.capacity() * sizeof(TexturedFace) : 0);
}

bool same(const ObjectPaint& a, const ObjectPaint& b) {
  const bool layouts = a.layout.uvs == b.layout.uvs ||
                       (a.layout.uvs && b.layout.uvs && *a.layout.uvs == *b.layout.uvs);
  return layouts && a.layout.generated == b.layout.generated && sameParts(a.color, b.color) &&
         sameParts(a.relief, b.relief) && sameParts(a.material, b.material) &&
         sameParts(a.textures, b.textures);
}

} // namespace patina
