// Whatever the bytes: a mesh whose indices hold, or a FileError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "check_mesh.h"
#include "core/error.h"
#include "geometry/io/obj_materials.h"
#include "geometry/io/textured_obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const patina::MtlMaterial& material : patina::parseMtl(bytes))
    if (!material.color.empty() && material.color.size() != 3) std::abort();
  try {
    patina::fuzz::checkMesh(patina::parseObj(bytes, "fuzz"));
    patina::MeshColors colors;
    const patina::TexturedMesh read = patina::parseTexturedObj(bytes, "fuzz", &colors);
    patina::fuzz::checkWarnings(read.warnings);
    patina::fuzz::checkColors(colors, read.mesh);
    std::int32_t last = -1;
    for (const patina::TexturedFace& face : read.textured) {
      if (face.face <= last || face.texture < 0 ||
          static_cast<std::size_t>(face.face) >= read.mesh.triangles.size())
        __builtin_trap();
      last = face.face;
    }
  } catch (const patina::FileError&) {
  }
  return 0;
}
