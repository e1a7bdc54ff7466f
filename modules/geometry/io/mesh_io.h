// Bounds-checked readers and writers of OBJ, PLY (ascii, binary) and STL (ascii, binary).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh/mesh_colors.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

enum class MeshFileType { obj, ply, stl };

// Returns the format by extension, in any case. Throws FileError naming the choices. A stream ("-"
// or a path below /dev) has no extension: PLY is written to it.
MeshFileType meshFileType(const std::filesystem::path& path);
// The same for reading `bytes`; the format of a stream follows from its content.
MeshFileType meshFileType(const std::filesystem::path& path, std::string_view bytes);

// Reads a mesh by extension (.obj .ply .stl, any case), or a stream ("-", /dev/fd/3) by content.
// Coordinates are returned in the file's own unit, as doubles. Throws FileError with the line, or
// line 0 and the byte in the cause for binary data; a file without a face is an error too.
// - Polygons are split into triangles that keep their outline (polygon_split.h).
// - OBJ: v, v/vt, v//vn, v/vt/vn, negative indices, comments, any line end and lines continued by a
//   backslash are read; normals, groups and unknown statements are skipped.
// - PLY: ascii and both binary orders, 1.0; faces and triangle strips (an index of -1 begins the
//   next one). Other elements and properties, lists among them, are skipped. Counts that the bytes
//   cannot contain are refused before memory is allocated; data beyond the counts is an error.
// - STL: the size decides whether a file is binary, since a binary header may begin with "solid".
//   Bytes after the last triangle or the last solid are left out; a count of 0 is replaced by the
//   one that the size allows; the end may be missing. Corners with identical coordinates are welded
//   (-0 is 0). Stored normals are skipped.
// - NaN and infinite coordinates and repeated corners are kept: cleaned() drops their faces and
//   reports them. Texture coordinates are kept where every face has them.
// Colours of vertices, of faces and of materials (MTL: Kd, map_Kd with -s, -o, -clamp) and the
// names of pictures (PLY: comment TextureFile, texnumber) go into `colors`, those of STL do not.
// Appends one line to `warnings` for each kind of thing that is not kept: colours where `colors` is
// null, libraries of materials that cannot be read, texture coordinates, indices out of range,
// bytes left over.
TriangleMesh readMesh(const std::filesystem::path& path,
                      std::vector<std::string>* warnings = nullptr, MeshColors* colors = nullptr);

// The same from memory. `name` is used in messages, and materials and pictures are searched beside
// it. The fuzzers call these.
TriangleMesh parseObj(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings = nullptr, MeshColors* colors = nullptr);
TriangleMesh parsePly(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings = nullptr, MeshColors* colors = nullptr);
TriangleMesh parseStl(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings = nullptr);

// Writes by extension, or PLY to a stream; PLY and STL are binary. Atomic. PLY stores doubles and
// OBJ the shortest text, so both read back bit for bit; STL stores floats and no texture.
void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh);
// The same for a mesh in metres with the file's numbers in `unit`, which is not MeshUnit::fit.
void writeMeshIn(const std::filesystem::path& path, TriangleMesh mesh, MeshUnit unit);
std::string plyBytes(const TriangleMesh& mesh); // PLY as written by writeMesh()

} // namespace patina
