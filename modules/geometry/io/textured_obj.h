// An OBJ that also says where on its faces which haptic texture lies (A26).
#pragma once

#include <string>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh/textured_face.h"

namespace patina {

struct TexturedMesh {
  TriangleMesh mesh; // as of readMesh()
  std::vector<TexturedFace> textured;
  std::vector<std::string> warnings; // as of readMesh()
};

// `h texture x1 y1 x2 y2 x3 y3`, one a face, in the order of the faces and of their corners, in the
// file's own unit; texture -1: none there. A file without any such line has no texture. Throws
// FileError as readMesh() does, and where their number is not that of the faces, where a face with
// more than three corners would need one, for a number that is not finite, and for an OBJ by name
// alone. `colors` as of readMesh().
TexturedMesh readTexturedObj(const std::filesystem::path& path, MeshColors* colors = nullptr);
TexturedMesh parseTexturedObj(std::string_view bytes, const std::string& name,
                              MeshColors* colors = nullptr);

// Atomic; the shortest text that reads back bit for bit. Programs that know no `h` pass over it.
void writeTexturedObj(const std::filesystem::path& path, const TriangleMesh& mesh,
                      const std::vector<TexturedFace>& textured);

} // namespace patina
