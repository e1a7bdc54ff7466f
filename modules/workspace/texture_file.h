// Fourier textures as JSON (A27), and the texture coordinates of an object's faces.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/fourier/texture_mappings.h"

namespace patina {

// {"format": "patina texture", "version": 1, "units": {...}, "convention": "...", "kind": "line",
// "harmonics": N, "omega": ..., ...}; numbers read back bit for bit.
std::string textureText(const FourierTexture& texture);
// Throws FileError(name): no JSON, another format or version, a missing key or one of another type,
// a number that is not finite, fewer coefficients than `harmonics`, a fault of problemOf().
FourierTexture parseTexture(std::string_view text, const std::string& name);
FourierTexture readTexture(const std::filesystem::path& path);
void writeTexture(const std::filesystem::path& path, const FourierTexture& texture);

// Faces and library of an object in one file.
std::string laidTexturesText(const TextureMappings& laid);
TextureMappings parseLaidTextures(std::string_view text, const std::string& name);

} // namespace patina
