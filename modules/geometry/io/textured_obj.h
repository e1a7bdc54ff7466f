// OBJ files with haptic texture coordinates on their faces (A26).
#pragma once

#include <string>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh/textured_face.h"

namespace patina {

struct TexturedMesh {
  TriangleMesh mesh; // see readMesh()
  std::vector<TexturedFace> textured;
  std::vector<std::string> warnings; // see readMesh()
};

// Reads lines `h texture x1 y1 x2 y2 x3 y3`, one a face, in the order of the faces and their
// corners, in the file's own unit; texture -1 means none. A file without such lines has no texture.
// Throws FileError as readMesh() does, and if the number of lines differs from that of the faces,
// if a face has more than three corners, for a number that is not finite, and for a file that is no
// OBJ. `colors`: see readMesh().
TexturedMesh readTexturedObj(const std::filesystem::path& path, MeshColors* colors = nullptr);
TexturedMesh parseTexturedObj(std::string_view bytes, const std::string& name,
                              MeshColors* colors = nullptr);

// Writes the shortest text that reads back bit for bit. Atomic. Other programs skip `h` lines.
void writeTexturedObj(const std::filesystem::path& path, const TriangleMesh& mesh,
                      const std::vector<TexturedFace>& textured);

} // namespace patina
