#include "geometry/io/mesh_io.h"

#include <cctype>

#include "core/error.h"
#include "core/file.h"
#include "geometry/io/mesh_file_type.h"

namespace patina {

MeshFileType meshFileType(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".obj") return MeshFileType::obj;
  if (extension == ".ply") return MeshFileType::ply;
  if (extension == ".stl") return MeshFileType::stl;
  throw FileError(path.string(), 0,
                  "a mesh file's name must end in .obj, .ply or .stl" +
                      (extension.empty() ? std::string() : ", not in '" + extension + "'"));
}

TriangleMesh readMesh(const std::filesystem::path& path) {
  const MeshFileType type = meshFileType(path);
  const std::string bytes = readFile(path);
  switch (type) {
  case MeshFileType::obj:
    return parseObj(bytes, path.string());
  case MeshFileType::ply:
    return parsePly(bytes, path.string());
  case MeshFileType::stl:
    break;
  }
  return parseStl(bytes, path.string());
}

} // namespace patina
