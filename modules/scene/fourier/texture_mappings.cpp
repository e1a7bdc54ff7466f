#include "scene/fourier/texture_mappings.h"

#include <algorithm>

#include "core/error.h"

namespace patina {

void validate(const TextureMappings& laid, std::size_t triangles) {
  std::int64_t last = -1;
  for (const TexturedFace& face : laid.faces) {
    const std::string name = "textured face " + std::to_string(face.face);
    if (face.face < 0 || static_cast<std::size_t>(face.face) >= triangles)
      throw Error(name + " is not one of the " + std::to_string(triangles) + " faces");
    if (face.face <= last) throw Error(name + " is out of order or a duplicate");
    if (face.texture < 0) throw Error(name + " has the texture " + std::to_string(face.texture));
    for (const Vec2& at : face.coords)
      if (!at.allFinite()) throw Error(name + " has a coordinate that is not finite");
    last = face.face;
  }
}

bool same(const TextureMappings& a, const TextureMappings& b) {
  return a.faces == b.faces && std::equal(a.library.begin(), a.library.end(), b.library.begin(),
                                          b.library.end(), [](const auto& one, const auto& other) {
                                            return one.first == other.first &&
                                                   one.second->value == other.second->value;
                                          });
}

double highest(const TextureMappings& laid) {
  double most = 0;
  for (const TexturedFace& face : laid.faces)
    if (const auto known = laid.library.find(face.texture); known != laid.library.end())
      most = std::max(most, known->second->highest);
  return most;
}

} // namespace patina
