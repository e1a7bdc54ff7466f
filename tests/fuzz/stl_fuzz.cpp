// Any bytes give a mesh with valid indices, or a FileError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "check_mesh.h"
#include "core/error.h"
#include "geometry/io/mesh_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> warnings;
  try {
    patina::fuzz::checkMesh(patina::parseStl(bytes, "fuzz", &warnings));
    patina::fuzz::checkWarnings(warnings);
    patina::fuzz::checkMesh(patina::parseStl(bytes, "fuzz"));
  } catch (const patina::FileError&) {
  }
  return 0;
}
