// Files for ParaView, for `patina export`. Written atomically; all functions throw FileError.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "scene/tool_sample.h"

namespace patina {

struct VertexValues {
  std::string name;          // with its unit: "stability [K*/K]"
  std::vector<float> values; // one per vertex
};

// Triangles in metres, with "face" (the index), "object" (the index of its object; left out if
// empty) and further values per vertex. Texture coordinates are per corner and stay in OBJ.
void writeMeshVtp(const std::filesystem::path& path, const TriangleMesh& mesh,
                  const std::vector<VertexValues>& values = {},
                  const std::vector<std::int32_t>& object = {});

// Tool path as one line, with arrays "t [s]", "force [N]", "vcp [m]", "depth [m]", "contact".
void writeToolPathVtp(const std::filesystem::path& path, const std::vector<ToolSample>& samples);

// One file that opens the others together: (block name, file name relative to the .vtm).
void writeCollectionVtm(const std::filesystem::path& path,
                        const std::vector<std::pair<std::string, std::string>>& files);

// Columns of the `feel` output, and the values of one row.
const std::vector<std::string>& toolSampleColumns();
std::vector<double> toolSampleRow(const ToolSample& sample);
void writeToolSamplesCsv(const std::filesystem::path& path, const std::vector<ToolSample>& samples);
// Reads such a table. Throws FileError with the line; for times that decrease, too.
std::vector<ToolSample> readToolSamplesCsv(const std::filesystem::path& path);

} // namespace patina
