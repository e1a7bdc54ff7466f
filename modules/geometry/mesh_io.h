// Bounds-checked readers and writers of OBJ, PLY (ascii, binary) and STL (ascii, binary).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/triangle_mesh.h"

namespace patina {

// By extension (.obj .ply .stl, any case). Coordinates are returned in the file's own unit.
// Polygons are fanned; negative OBJ indices, v/vt/vn, CRLF and comments are understood.
// STL vertices with identical coordinates are welded. NaN and infinite coordinates are kept:
// cleaned() drops their faces and says so. Throws FileError with the line (or the byte offset, for
// binary files, in the cause). `texture coordinates` are kept where every face has them.
TriangleMesh readMesh(const std::filesystem::path& path);

// The same from memory; `name` is used in messages. These are what the fuzzers call.
TriangleMesh parseObj(std::string_view bytes, const std::string& name);
TriangleMesh parsePly(std::string_view bytes, const std::string& name);
TriangleMesh parseStl(std::string_view bytes, const std::string& name);

// By extension; PLY and STL binary. Atomic. PLY stores doubles, OBJ shortest round-trip text.
void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh);

} // namespace patina
