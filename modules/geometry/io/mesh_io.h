// Bounds-checked readers and writers of OBJ, PLY (ascii, binary) and STL (ascii, binary).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// By extension (.obj .ply .stl, any case); of a stream ("-", /dev/fd/3) by its content. Coordinates
// are returned in the file's own unit, as doubles. Throws FileError with the line, or line 0 and
// the byte in the cause for binary data; a file without a face is an error too.
// - Polygons are fanned from their first corner, whatever their shape: a concave one may fold over.
// - OBJ: v, v/vt, v//vn, v/vt/vn, negative indices, comments, CRLF and lines continued by a
//   backslash are understood; normals, groups, materials and unknown statements are passed over.
// - PLY: ascii and both binary orders, 1.0; elements and properties that mean nothing here, lists
//   among them, are passed over. Counts that the bytes could not hold are refused before memory is
//   taken, data beyond the counts is an error.
// - STL: the size decides whether a file is binary, since a binary header may begin with "solid".
//   Corners with identical coordinates are welded (-0 is 0). Stored normals are passed over.
// - NaN and infinite coordinates and repeated corners are kept: cleaned() drops their faces and
//   says so. Texture coordinates are kept where every face has them.
TriangleMesh readMesh(const std::filesystem::path& path);

// The same from memory; `name` is used in messages. These are what the fuzzers call.
TriangleMesh parseObj(std::string_view bytes, const std::string& name);
TriangleMesh parsePly(std::string_view bytes, const std::string& name);
TriangleMesh parseStl(std::string_view bytes, const std::string& name);

// By extension; PLY to a stream; PLY and STL binary. Atomic. PLY stores doubles and OBJ the
// shortest text, so both read back bit for bit; STL stores floats and no texture.
void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh);
std::string plyBytes(const TriangleMesh& mesh); // what it writes as PLY

} // namespace patina
