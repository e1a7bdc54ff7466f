#include "app/cli/input/mesh_input.h"

#include "geometry/io/mesh_io.h"

namespace patina::cli {

ScaledMesh readScaledMesh(const std::filesystem::path& path, MeshUnit unit, Console& console) {
  std::vector<std::string> warnings;
  ScaledMesh scaled = inMetres(readMesh(path, &warnings), unit);
  if (!scaled.warning.empty()) warnings.push_back(scaled.warning);
  for (const std::string& line : warnings) console.warn(path.string() + ": " + line);
  return scaled;
}

} // namespace patina::cli
