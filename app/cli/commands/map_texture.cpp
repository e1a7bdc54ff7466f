#include <algorithm>
#include <cmath>

#include "acquisition/files/registered_file.h"
#include "app/cli/commands/commands.h"
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
    {"stretched", "", "stretched", "faces that would be more than --most-stretch, left without",
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
  LaidTexture laid;
  try {
    laid = layScanTexture(scaled.mesh, strokes, options.lay, console.progress());
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.path.string(), 0, error.what());
  }

  for (TexturedFace& face : laid.faces)
    for (Vec2& at : face.at) at /= scaled.scale;
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
      .set("stretch", Json::object().set("least", laid.least).set("most", laid.most),
           rounded(laid.least) + " to " + rounded(laid.most))
      .set("farthest", laid.farthest);
  return console.report(report);
}

} // namespace

Command mapTextureCommand() {
  auto options = std::make_shared<MapOptions>();
  LayOptions& lay = options->lay;
  return {
      .name = "map-texture",
      .summary = "lay a texture onto a mesh along a path",
      .description =
          "Gives the faces that the path runs over, and rings of their neighbours, coordinates: x "
          "is the way along the path, y the distance from it, positive to the left. They go into "
          "an OBJ as a line h TEXTURE x1 y1 x2 y2 x3 y3 a face, which other programs pass over. "
          "The path is that of `patina register`, or any points on the mesh: a scan that nobody "
          "made. Each stroke begins anew at x = 0.\n"
          "Where MESH has coordinates already they stay, but for the faces that this path takes: "
          "of textures that overlap the last one is felt.",
      .examples =
          {"patina map-texture dinosaur.obj registered.csv -o textured.obj --heights heights.csv",
           "patina map-texture textured.obj other.csv -o both.obj --texture 2 --rings 3"},
      .keys = kMapKeys,
      .arguments = {input("MESH", "Mesh.", into(options->mesh)),
                    input("PATH", "Path on it.", into(options->path)),
                    outputTo(options->output, "TEXTURED.obj", "The mesh with coordinates."),
                    {"--texture", "ID", "", "1", "Number of the texture.",
                     inRange(
                         0, 1e9, [&lay](double id) { lay.texture = static_cast<std::int32_t>(id); },
                         NumberKind::whole)},
                    {"--heights", "HEIGHTS.csv", "", "",
                     "Of this path, by patina filter: what the texture was made of tells how far "
                     "along each sample lies.",
                     into(options->heights)},
                    {"--rings", "N", "", "2", "Of neighbours beyond the faces on the way.",
                     inRange(
                         0, 1000, [&lay](double rings) { lay.rings = static_cast<int>(rings); },
                         NumberKind::whole)},
                    {"--by-edge", "", "", "", "Neighbours share an edge, not a corner alone.",
                     [&lay](const std::string&) { lay.neighbours = Neighbours::by_edge; }},
                    {"--most-stretch", "RATIO", "", "2",
                     "Faces whose coordinates are more are left out.",
                     inRange(1, 100, [&lay](double most) { lay.most_stretch = most; })},
                    {"--unit", "UNIT", "", "mm", "Of the mesh: mm, cm, m, in or fit.",
                     parsedInto(options->unit, parseMeshUnit)}},
      .run = [options](Console& console) { return runMapTexture(*options, console); }};
}

} // namespace patina::cli
