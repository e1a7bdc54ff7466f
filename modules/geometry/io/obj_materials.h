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
  std::vector<std::string> libraries; // names after mtllib
  std::vector<Use> uses;              // usemtl statements; each holds until the next

  // Adds the text after mtllib or usemtl, with its comment, since a name may contain a '#'.
  // `triangles` is the number of triangles before it.
  void addStatement(std::string_view keyword, std::string_view statement, std::size_t triangles);
};

// One material of a library.
struct MtlMaterial {
  std::string name;
  std::vector<double> color; // Kd: three finite numbers, or none
  std::string picture;       // map_Kd without its options; empty if absent
  MeshPicture mapped{};      // placement by the options -s, -o and -clamp
  bool is_transparent = false;
  std::filesystem::path library{};
};

// Parses a library. Unknown or broken statements are skipped: a material never rejects its mesh.
std::vector<MtlMaterial> parseMtl(std::string_view bytes);

// Returns the file called `written` beside `from`. Backslashes separate folders too; a folder that
// does not exist is ignored.
std::filesystem::path besideFile(const std::filesystem::path& from, const std::string& written);

// Returns the warning for pictures that a mesh file names and that are not kept.
std::string picturesLeftOut(const std::set<std::string>& pictures, bool mapped);

// Reads the libraries beside `path`. A picture is searched beside its library, then beside `path`.
// A single grey Kd counts as no colour. The colours and pictures of the mesh's faces go into
// `colors`, and one line into `warnings` for each kind of thing that is left out. If `colors` is
// null, all are left out.
void readMaterials(const ObjMaterials& materials, const std::filesystem::path& path,
                   const TriangleMesh& mesh, MeshColors* colors,
                   std::vector<std::string>* warnings);

} // namespace patina
