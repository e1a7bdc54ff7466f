// Fourier textures of one object: texture coordinates of its faces, and the textures.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "geometry/mesh/textured_face.h"
#include "scene/fourier/haptic_texture.h"

namespace patina {

// Faces refer to a texture by number, so that it can be replaced on all faces at once (A17).
struct TextureMappings {
  std::vector<TexturedFace> faces; // ascending by face
  // Faces with a number that is missing here are rigid (A25).
  std::map<std::int32_t, std::shared_ptr<const HapticTexture>> library;
};

bool same(const TextureMappings& a, const TextureMappings& b); // bitwise

// Returns the largest |h| [m] of the textures in use.
double highest(const TextureMappings& laid);

// Throws Error for faces out of order, twice or beyond `triangles`, or non-finite coordinates.
void validate(const TextureMappings& laid, std::size_t triangles);

} // namespace patina
