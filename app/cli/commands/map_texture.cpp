#include <algorithm>
#include <cmath>

#include "acquisition/files/registered_file.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file_kind.h"
#include "core/numbers.h"
#include "geometry/io/textured_obj.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "scan/scan_texture.h"

namespace patina::cli {

namespace {

struct MapOptions {
  std::filesystem::path mesh, path, heights, output;
  MeshUnit unit = MeshUnit::mm;
  LayOptions lay{.texture = 1};
};

const Keys kMapKeys = {
    {"texture", "", "texture", "its number"},
    {"strokes", "", "strokes", "that have a length"},
    {"length", "m", "length", "of the longest stroke"},
    {"faces", "", "faces", "that got coordinates"},
    {"replaced", "", "replaced", "of them, faces that had a texture before", Shown::if_any},
    {"folded", "", "folded", "faces behind the centre of a bend, left without", Shown::if_any},
    {"ambiguous", "", "ambiguous", "faces between two parts of the path, left without",
     Shown::if_any},
    {"stretched", "", "stretched", "faces that would be more than --max-stretch, left without",
     Shown::if_any},
    {"stretch",
     "",
     "stretch",
     "of the way along the path over that over the face",
     Shown::always,
     {{"least", "", ""}, {"most", "", ""}}},
    {"farthest", "m", "farthest", "of the path's points from the mesh"}};

int runMapTexture(const MapOptions& options, Console& console) {
  if (kindOfName(options.output) != FileKind::obj)
    throw FileError(options.output.string(), 0, "only an .obj holds haptic coordinates");
  requireWritable(options.output, {options.mesh, options.path, options.heights}, FileKind::obj);
  TexturedMesh file =
      kindOfName(options.mesh) == FileKind::obj ? readTexturedObj(options.mesh) : TexturedMesh{};
  if (file.mesh.triangles.empty()) file.mesh = readMesh(options.mesh, &file.warnings);
  for (const std::string& line : file.warnings) console.warn(options.mesh.string() + ": " + line);
  ScaledMesh scaled = inMetres(file.mesh, options.unit);
  if (!scaled.warning.empty()) console.warn(options.mesh.string() + ": " + scaled.warning);
  std::vector<std::string> warnings;
  const std::vector<PathOnMesh> strokes = readStrokes(options.path, options.heights, &warnings);
  for (const std::string& line : warnings) console.warn(line);
  MappedTexture laid;
  try {
    laid = layScanTexture(scaled.mesh, strokes, options.lay, console.progress());
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.path.string(), 0, error.what());
  }

  for (TexturedFace& face : laid.faces)
    for (Vec2& at : face.coords) at /= scaled.scale;
  const std::vector<TexturedFace> merged = laidOver(laid.faces, file.textured);
  writeTexturedObj(options.output, file.mesh, merged);

  Report report(kMapKeys);
  report.set("texture", static_cast<std::size_t>(options.lay.texture))
      .set("strokes", laid.lengths.size())
      .set("length", *std::max_element(laid.lengths.begin(), laid.lengths.end()))
      .set("faces", laid.faces.size())
      .set("replaced", laid.faces.size() + file.textured.size() - merged.size())
      .set("folded", laid.folded)
      .set("ambiguous", laid.ambiguous)
      .set("stretched", laid.stretched)
      .set("stretch", Json::object().set("least", laid.min_stretch).set("most", laid.max_stretch),
           rounded(laid.min_stretch) + " to " + rounded(laid.max_stretch))
      .set("farthest", laid.max_distance);
  return console.report(report);
}

} // namespace

Command mapTextureCommand() {
  auto options = std::make_shared<MapOptions>();
  LayOptions& lay = options->lay;
  return {
      .name = "map-texture",
      .summary = "map a texture to a mesh along a path",
      .description =
          "Gives the faces that the path runs over, and rings of their neighbours, coordinates: x "
          "is the way along the path, y the distance from it, positive to the left. They go into "
          "an OBJ as a line h TEXTURE x1 y1 x2 y2 x3 y3 a face, which other programs pass over. "
          "The path is that of `patina register`, or any points on the mesh: a virtual scan. Each "
          "stroke starts again at x = 0.\n"
          "Existing coordinates of MESH stay, except on the faces of this path: where textures "
          "overlap, the last one is used.",
      .examples =
          {"patina map-texture dinosaur.obj registered.csv -o textured.obj --heights heights.csv",
           "patina map-texture textured.obj other.csv -o both.obj --texture 2 --rings 3"},
      .keys = kMapKeys,
      .arguments = {input("MESH", "Mesh.", into(options->mesh)),
                    input("PATH", "Path on it.", into(options->path)),
                    outputTo(options->output, "TEXTURED.obj", "The mesh with coordinates."),
                    {"--texture", "ID", "", "1", "Number of the texture.",
                     numberInto(0, 1e9, lay.texture, NumberKind::whole)},
                    {"--heights", "HEIGHTS.csv", "", "",
                     "Of this path, by patina filter: the texture's heights give the arc length of "
                     "each sample.",
                     into(options->heights)},
                    {"--rings", "N", "", "2", "Of neighbours beyond the faces on the way.",
                     numberInto(0, 1000, lay.rings, NumberKind::whole)},
                    {"--by-edge", "", "", "", "Neighbours share an edge, not a corner alone.",
                     [&lay](const std::string&) { lay.neighbours = Neighbours::by_edge; }},
                    {"--max-stretch", "RATIO", "", "2",
                     "Faces whose coordinates are more are left out.",
                     numberInto(1, 100, lay.max_stretch)},
                    unitOfMesh(options->unit)},
      .run = [options](Console& console) { return runMapTexture(*options, console); }};
}

} // namespace patina::cli
