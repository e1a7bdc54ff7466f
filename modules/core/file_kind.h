// What a file is by its content, so that a table does not take the place of a mesh.
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
  exr,
  yaml,
  pnm,   // .pgm, a recording's frames
  poses, // .tum: eight numbers a line
  roff,  // a manual page
  other
};

// `head` is the file's beginning, 1 kB or the whole of it; `size` its bytes.
FileKind kindOf(std::string_view head, std::uint64_t size);
// "a JSON object", "a PLY mesh".
std::string_view nameOf(FileKind kind);

// What a file's ending says of it, in either case; nothing of an ending that is not ours.
std::optional<FileKind> kindOfName(const std::filesystem::path& path);

// FileError if `kind` may not be written to `path`: a file of another kind is there, or the name
// ends as that of another kind does. Nothing there, nothing in it, or the same kind is no error;
// `other` is the same as no other.
void requireSameKind(const std::filesystem::path& path, FileKind kind);

} // namespace patina
