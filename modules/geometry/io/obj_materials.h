// Reads the materials of an OBJ file for its warnings. Internal to the readers.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct ObjMaterials {
  std::vector<std::string> libraries; // as written after mtllib
  std::vector<std::string> used;      // names after usemtl, possibly repeated

  void addStatement(std::string_view keyword, std::string_view statement);
};

// One material of a library.
struct MtlMaterial {
  std::string name;
  std::vector<double> color; // Kd: three numbers, or none
  std::string picture;       // map_Kd: as written, without its options; or empty
};

// Statements that are unknown or broken are skipped: a material never refuses its mesh.
std::vector<MtlMaterial> parseMtl(std::string_view bytes);

// Returns the file that `written` names beside `from`. Backslashes separate folders too; a folder
// that does not exist is ignored.
std::filesystem::path besideFile(const std::filesystem::path& from, const std::string& written);

// Returns the line for pictures that a mesh file names after `keyword`. They are not shown; the
// line names the option that shows them.
std::string picturesLeftOut(const std::filesystem::path& path, const std::string& keyword,
                            const std::vector<std::string>& pictures, bool has_texture_coordinates);

// Reads the libraries beside `path` and adds one line for each kind of thing that is left out:
// libraries that cannot be read, pictures, colours.
void addMaterialWarnings(const ObjMaterials& materials, const std::filesystem::path& path,
                         const TriangleMesh& mesh, std::vector<std::string>& warnings);

} // namespace patina
