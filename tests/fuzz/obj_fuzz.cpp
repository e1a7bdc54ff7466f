// Any bytes give a mesh with valid indices, or a FileError. What follows a zero is the library of
// materials, which the mesh names 100.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

#include "check_mesh.h"
#include "core/error.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/obj_materials.h"
#include "geometry/io/textured_obj.h"

namespace {

constexpr const char* kName = "/proc/self/fd/fuzz.obj"; // The library is beside it.

void setLibrary(std::string_view bytes) {
  static const int file = fcntl(memfd_create("library", 0), F_DUPFD, 100);
  if (file != 100 || ftruncate(file, 0) != 0 ||
      pwrite(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    std::abort();
}

void checkTextured(const patina::TexturedMesh& read) {
  patina::fuzz::checkWarnings(read.warnings);
  std::int32_t last = -1;
  for (const patina::TexturedFace& face : read.textured) {
    if (face.face <= last || face.texture < 0 ||
        static_cast<std::size_t>(face.face) >= read.mesh.triangles.size())
      __builtin_trap();
    last = face.face;
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view whole(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = whole.find('\0');
  const std::string_view bytes = whole.substr(0, zero);
  const std::string_view library = zero == whole.npos ? whole : whole.substr(zero + 1);
  setLibrary(library);
  for (const patina::MtlMaterial& material : patina::parseMtl(library))
    if (!material.color.empty() && material.color.size() != 3) std::abort();
  try {
    patina::fuzz::checkMesh(patina::parseObj(whole, "fuzz"));
  } catch (const patina::FileError&) {
  }
  try {
    std::vector<std::string> warnings;
    patina::fuzz::checkMesh(patina::parseObj(bytes, kName, &warnings));
    patina::fuzz::checkWarnings(warnings);
  } catch (const patina::FileError&) {
  }
  try {
    patina::MeshColors colors;
    const patina::TexturedMesh read = patina::parseTexturedObj(bytes, kName, &colors);
    patina::fuzz::checkColors(colors, read.mesh);
    checkTextured(read);
  } catch (const patina::FileError&) {
  }
  return 0;
}
