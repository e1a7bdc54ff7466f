// Detects a file's kind by its content, so that a table never overwrites a mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace patina {

enum class FileKind : std::uint8_t {
  empty,
  table, // CSV: a header, then numbers
  json,
  obj,
  ply,
  stl,
  image_data, // .vti
  poly_data,  // .vtp
  png,
  tiff,
  svg,
  pdf,
  exr,
  yaml,
  pnm,   // .pgm, frames of a recording
  poses, // .tum: eight numbers per line
  roff,  // a manual page
  other
};

// `head`: first 1 kB of the file, or all of it; `size`: bytes of the file.
FileKind kindOf(std::string_view head, std::uint64_t size);
// Returns "a JSON file", "a PLY mesh".
std::string_view nameOf(FileKind kind);

// Kind by file name extension, in either case; absent for an unknown extension.
std::optional<FileKind> kindOfName(const std::filesystem::path& path);

// Throws FileError if a file of another kind exists at `path`, or if the extension belongs to
// another kind. An absent or empty file passes; `other` never equals an existing kind.
void requireSameKind(const std::filesystem::path& path, FileKind kind);

} // namespace patina
