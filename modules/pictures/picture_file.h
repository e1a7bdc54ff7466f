// Picture files by OpenImageIO, which is loaded at first use (linking it would add 170 ms to every
// start).
#pragma once

#include <filesystem>

#include "pictures/picture.h"

namespace patina {

// Reads PNG, JPEG, TIFF, EXR and other formats of OpenImageIO; the first image of a file, at most
// 16384 texels a side. Throws FileError naming file and cause, also if the library is missing.
Picture readPicture(const std::filesystem::path& path);

// Returns true if a file begins like a picture, regardless of its name: PNG, JPEG, TIFF, WebP, BMP,
// PNM, GIF, EXR, HDR, JPEG 2000, HEIF, PSD, DPX. The rest may still be unreadable.
bool isPictureByContent(const std::filesystem::path& path);

// Writes by extension: .png with 16 or 8 bits a channel (values clamped to [0, 1]), .exr with
// 32-bit floats, bit for bit. Atomic.
void writePicture(const std::filesystem::path& path, const Picture& picture, int bits = 16);

} // namespace patina
