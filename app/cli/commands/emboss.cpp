#include "authoring/images/emboss.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/mesh_output.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "session/build/relief_deviation.h"

namespace patina::cli {

namespace {

constexpr double kToldShare = 0.05; // of the relief's height that the grid may lose unsaid

struct EmbossOptions {
  std::filesystem::path input, output;
  SceneOptions scene;
  MeshUnit unit = MeshUnit::mm;
};

int runEmboss(const EmbossOptions& options, Console& console) {
  requireMeshOutput(options.output, options.unit, {options.input});
  Scene scene = openWith(options.input, options.scene, console);
  if (highestRelief(scene) == 0)
    console.warn(options.input.string() + ": there is no relief: the mesh is the field's surface");
  scene.relief.mode = ReliefMode::pulled; // baked below, into a field of its own
  const auto compiled = compileFor(std::move(scene), console, FaceLayer::kept);
  const std::vector<ReliefSource> sources = reliefSources(*compiled);
  const TriangleMesh mesh =
      embossed(compiled->built.field, *compiled->mesh, sources, console.progress());
  const MeshReport report = inspect(mesh);
  const ReliefDeviation deviation = reliefDeviation(*compiled, mesh);
  console.progress().throwIfCancelled();
  writeMeshIn(options.output, mesh, options.unit);

  const double voxel = compiled->built.field->grid.voxel;
  if (deviation.rms > kToldShare * deviation.highest)
    console.warn("the mesh misses the painted relief by " + formatLength(deviation.rms) +
                 " rms: a smaller --voxel keeps more of it");
  Json json = Json::object();
  json.set("triangles", report.triangles);
  json.set("vertices", report.vertices);
  json.set("watertight", report.watertight);
  json.set("unit", std::string(name(options.unit)));
  json.set("voxel", voxel);
  json.set("highest", deviation.highest);
  json.set("deviation_rms", deviation.rms);
  json.set("deviation_max", deviation.most);
  TextRows rows = {{"triangles", formatCount(report.triangles)},
                   {"watertight", report.watertight ? "yes" : "no"},
                   {"written in", std::string(name(options.unit))},
                   {"voxel", formatLength(voxel)}};
  if (deviation.highest > 0) {
    rows.emplace_back("relief", formatLength(deviation.highest) + " at most");
    rows.emplace_back("deviation", formatLength(deviation.rms) + " rms, " +
                                       formatLength(deviation.most) + " at most");
  }
  console.report(json, aligned(rows));
  return kDone;
}

} // namespace

Command embossCommand() {
  auto options = std::make_shared<EmbossOptions>();
  Command command;
  command.name = "emboss";
  command.summary = "relief made into a new mesh";
  command.description =
      "The field is built as fine as asked for, the painted relief baked into it, and its surface "
      "written as a mesh: several objects become one. relief.height below 0 engraves. "
      "The grid loses height: of a pattern as long as 8 voxels 8 %, as 4 voxels 29 %; deviation is "
      "measured, from the painted texels, displaced along the normals, to the new mesh.\n"
      "JSON: triangles, vertices, watertight, unit, voxel [m], highest [m, of the relief], "
      "deviation_rms, deviation_max [m].";
  command.examples = {"patina emboss cup -o cup.ply", "patina emboss cup -o cup.stl --voxel 0.2mm"};
  command.input("WORKSPACE", "Painted workspace.", options->input);
  command.output("MESH", "Mesh file (.obj .ply .stl).", options->output);
  addFieldOptions(command, options->scene);
  addUnitOfOutput(command, options->unit);
  command.run = [options](Console& console) { return runEmboss(*options, console); };
  return command;
}

} // namespace patina::cli
