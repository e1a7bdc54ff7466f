#include "geometry/io/mesh_io.h"

#include <cctype>

#include "core/error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "geometry/io/commented_file.h"

namespace patina {
namespace {

bool isStream(const std::filesystem::path& path) {
  return isStandardStream(path) || path.string().starts_with("/dev/");
}

} // namespace

MeshFileType meshFileType(const std::filesystem::path& path, std::string_view bytes) {
  if (!isStream(path)) return meshFileType(path);
  const FileKind kind = kindOf(bytes, bytes.size());
  if (kind == FileKind::ply) return MeshFileType::ply;
  return kind == FileKind::stl ? MeshFileType::stl : MeshFileType::obj;
}

MeshFileType meshFileType(const std::filesystem::path& path) {
  if (isStream(path)) return MeshFileType::ply;
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".obj") return MeshFileType::obj;
  if (extension == ".ply") return MeshFileType::ply;
  if (extension == ".stl") return MeshFileType::stl;
  throw FileError(path.string(), 0,
                  "a mesh file's name must end in .obj, .ply or .stl" +
                      (extension.empty() ? std::string() : ", not in '" + extension + "'"));
}

TriangleMesh readMesh(const std::filesystem::path& path, std::vector<std::string>* warnings,
                      MeshColors* colors) {
  // Rejects an unknown extension before the file is read.
  const bool commented = meshFileType(path) == MeshFileType::obj;
  const std::string bytes = commented ? readCommented(path) : readFile(path);
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
    throw FileError(path.string(), 1, "the text is UTF-16; save it as UTF-8");
  switch (meshFileType(path, bytes)) {
  case MeshFileType::obj:
    return parseObj(bytes, path.string(), warnings, colors);
  case MeshFileType::ply:
    return parsePly(bytes, path.string(), warnings, colors);
  case MeshFileType::stl:
    break;
  }
  return parseStl(bytes, path.string(), warnings);
}

} // namespace patina
