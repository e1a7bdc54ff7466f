// Reads the materials of an OBJ file. Internal to the readers.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh/mesh_colors.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct ObjMaterials {
  struct Use {
    std::size_t first_triangle = 0;
    std::string name;
  };
  std::vector<std::string> libraries; // as written after mtllib
  std::vector<Use> uses;              // of usemtl; each holds until the next

  // Adds what stands after mtllib or usemtl, a comment included, since a name may have a '#' in it.
  // `triangles` is the number of those before it.
  void addStatement(std::string_view keyword, std::string_view statement, std::size_t triangles);
};

// One material of a library.
struct MtlMaterial {
  std::string name;
  std::vector<double> color; // Kd: three finite numbers, or none
  std::string picture;       // map_Kd: as written, without its options; or empty
  MeshPicture mapped{};      // what its options -s, -o and -clamp say
  bool is_transparent = false;
  std::filesystem::path library{};
};

// Statements that are unknown or broken are skipped: a material never refuses its mesh.
std::vector<MtlMaterial> parseMtl(std::string_view bytes);

// Returns the file that `written` names beside `from`. Backslashes separate folders too; a folder
// that does not exist is ignored.
std::filesystem::path besideFile(const std::filesystem::path& from, const std::string& written);

// Returns the line for pictures that a mesh file names and that are not kept.
std::string picturesLeftOut(const std::set<std::string>& pictures, bool mapped);

// Reads the libraries beside `path`. A picture is looked for beside its library, then beside
// `path`. One grey Kd for all counts as no colour. The colours and pictures of the mesh's faces go
// into `colors`; one line goes into `warnings` for each kind of thing that is left out. Where
// `colors` is null all of them are.
void readMaterials(const ObjMaterials& materials, const std::filesystem::path& path,
                   const TriangleMesh& mesh, MeshColors* colors,
                   std::vector<std::string>* warnings);

} // namespace patina
