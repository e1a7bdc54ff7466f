// What is done to the textures of a scene, as plain functions: each makes another scene. No Qt.
#pragma once

#include <memory>
#include <optional>

#include "acquisition/texture/lay_texture.h"
#include "app/gui/texturing/texture_card.h"
#include "scene/scene.h"

namespace patina {

// Of all objects, by number, then those of `read` that lie nowhere.
std::vector<TextureRow> texturesOf(const Scene& scene, const std::vector<TextureRow>& read);
std::int32_t freeNumber(const std::vector<TextureRow>& rows); // from 1

// The texture along strokes over one object, object frame. Throws Error where no face can take it.
Scene withLaid(const Scene& scene, std::size_t object, const std::vector<PathOnMesh>& strokes,
               const TextureRow& row, int rings, const Progress& progress);
// Another texture in a number's place, on every face (A17).
Scene withSwapped(const Scene& scene, std::int32_t number,
                  std::shared_ptr<const FeltTexture> texture);
Scene withoutTexture(const Scene& scene, std::int32_t number);
// Textured faces of all objects, world frame, each in one of the two: those that have the texture
// that is meant, and the rest. Where it lies nowhere all are meant. nullptr: there are none.
struct TexturedParts {
  std::shared_ptr<const TriangleMesh> meant, rest;
};
TexturedParts texturedParts(const Scene& scene, std::optional<std::int32_t> number);

} // namespace patina
