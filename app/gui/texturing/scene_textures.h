// Textures of a scene, and their edits as functions that return a new scene. No Qt.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scan/scan_texture.h"
#include "scene/fourier/haptic_texture.h"
#include "scene/scene.h"

namespace patina {

// A texture of the library, which has those of the scene and those read from files.
struct TextureRow {
  std::int32_t number = 0;
  // nullptr: faces refer to it, but its file is missing.
  std::shared_ptr<const HapticTexture> texture;
  std::size_t faces = 0; // Faces with the texture.
};

// Returns the textures of all objects by number, then the unused ones of `read`.
std::vector<TextureRow> texturesOf(const Scene& scene, const std::vector<TextureRow>& read);
std::int32_t freeNumber(const std::vector<TextureRow>& rows); // Starts at 1.

// Maps the texture along strokes in the object frame. Throws Error if no face can take it.
Scene withLaid(const Scene& scene, std::size_t object, const std::vector<PathOnMesh>& strokes,
               const TextureRow& row, int rings, const Progress& progress);
// Replaces a texture on every face (A17).
Scene withSwapped(const Scene& scene, std::int32_t number,
                  std::shared_ptr<const HapticTexture> texture);
Scene withoutTexture(const Scene& scene, std::int32_t number);
// Textured faces in the world frame: selected or not; all are if no face has it. nullptr: none.
struct TexturedFaces {
  std::shared_ptr<const TriangleMesh> selected, others;
};
TexturedFaces texturedParts(const Scene& scene, std::optional<std::int32_t> number);

} // namespace patina
