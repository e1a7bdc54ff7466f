// Whatever the bytes: a mesh whose indices hold, or a FileError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "check_mesh.h"
#include "core/error.h"
#include "geometry/io/mesh_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    patina::fuzz::checkMesh(
        patina::parsePly(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz"));
  } catch (const patina::FileError&) {
  }
  return 0;
}
