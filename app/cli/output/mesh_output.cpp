#include "app/cli/output/mesh_output.h"

#include "app/cli/output/reports.h"
#include "core/error.h"
#include "geometry/io/mesh_io.h"

namespace patina::cli {

Argument unitOfOutput(MeshUnit& unit) {
  return {"--unit",
          "mm|cm|m|in",
          "",
          "mm",
          "Unit of the numbers in the file.",
          parsedInto(unit, parseMeshUnit)};
}

void requireMeshOutput(const std::filesystem::path& path, MeshUnit unit,
                       const std::vector<std::filesystem::path>& inputs) {
  if (unit == MeshUnit::fit) throw Error("--unit: fit is for reading; use mm, cm, m or in");
  constexpr FileKind kinds[] = {FileKind::obj, FileKind::ply, FileKind::stl};
  requireWritable(path, inputs, kinds[static_cast<std::size_t>(meshFileType(path))]);
}

} // namespace patina::cli
