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

Argument unitOfMesh(MeshUnit& unit) {
  return {"--unit",
          "UNIT",
          "",
          "mm",
          "Of the mesh: mm, cm, m, in or fit.",
          parsedInto(unit, parseMeshUnit)};
}

Argument tipRadius(std::optional<double>& radius, const std::string& fallback) {
  return {"--tip-radius",
          "LENGTH",
          "m",
          fallback,
          "Of the probe: its middle stays that far off.",
          numberInto(0, 1, radius, NumberKind::length)};
}

} // namespace patina::cli
