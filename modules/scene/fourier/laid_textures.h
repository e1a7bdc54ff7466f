// Fourier textures on one object: where on its faces which lies, and what each is.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "geometry/mesh/textured_face.h"
#include "scene/fourier/felt_texture.h"

namespace patina {

// Faces name a texture by its number, so that another one may take its place on every face (A17).
struct LaidTextures {
  std::vector<TexturedFace> faces; // ascending
  // A number that is not here is a texture that is not known: its faces are rigid (A25).
  std::map<std::int32_t, std::shared_ptr<const FeltTexture>> library;
};

bool same(const LaidTextures& a, const LaidTextures& b); // bitwise

// Of those that lie on some face, of |h| [m].
double highest(const LaidTextures& laid);

// Throws Error: faces out of order, twice or beyond `triangles`; coordinates that are not finite.
void validate(const LaidTextures& laid, std::size_t triangles);

} // namespace patina
