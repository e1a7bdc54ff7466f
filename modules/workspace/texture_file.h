// Fourier textures as JSON (A27), and where they lie on an object.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/fourier/laid_textures.h"

namespace patina {

// {"format": "patina texture", "version": 1, "units": {...}, "convention": "...", "kind": "line",
// "harmonics": N, "omega": ..., ...}; numbers read back bit for bit.
std::string textureText(const FourierTexture& texture);
// Throws FileError(name): no JSON, another format or version, a key that is missing or of another
// kind, a number that is not finite, fewer coefficients than `harmonics` says, problemOf().
FourierTexture parseTexture(std::string_view text, const std::string& name);
FourierTexture readTexture(const std::filesystem::path& path);
void writeTexture(const std::filesystem::path& path, const FourierTexture& texture);

// An object's faces and library in one file.
std::string laidTexturesText(const LaidTextures& laid);
LaidTextures parseLaidTextures(std::string_view text, const std::string& name);

} // namespace patina
