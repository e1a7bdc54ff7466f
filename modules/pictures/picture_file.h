// Pictures on disk, through OpenImageIO, which is loaded with the first of them (linking it would
// cost every start 170 ms).
#pragma once

#include <filesystem>

#include "pictures/picture.h"

namespace patina {

// PNG, JPEG, TIFF, EXR and what else OpenImageIO reads; the first image of a file. Bounded: at most
// 16384 texels a side. Throws FileError naming file and cause, also where the library is missing.
Picture readPicture(const std::filesystem::path& path);

// Whether a file begins as a picture does, whatever its name: PNG, JPEG, TIFF, WebP, BMP, PNM, GIF,
// EXR, HDR, JPEG 2000, HEIF, PSD, DPX. Not whether all of it can be read.
bool isPictureByContent(const std::filesystem::path& path);

// By the extension: .png 16 bits a channel, or 8 (values clamped to [0, 1]), .exr 32-bit floats,
// bit for bit. Atomic.
void writePicture(const std::filesystem::path& path, const Picture& picture, int bits = 16);

} // namespace patina
