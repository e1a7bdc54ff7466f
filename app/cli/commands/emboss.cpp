#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/mesh_output.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/io/mesh_io.h"
#include "session/open/mesh_export.h"

namespace patina::cli {

namespace {

constexpr double kToldShare = 0.05; // share of the relief's height; a larger loss is reported

struct EmbossOptions {
  std::filesystem::path input, output;
  SceneOptions scene;
  MeshUnit unit = MeshUnit::mm;
};

const Keys kEmbossKeys = {{"triangles", "", "triangles"},
                          {"vertices", "", "vertices", "", Shown::never},
                          {"watertight", "", "watertight"},
                          {"unit", "", "written in"},
                          {"voxel", "m", "voxel"},
                          {"highest", "m", "relief", "at most", Shown::if_any},
                          {"deviation_rms", "m", "deviation, rms", "", Shown::if_any},
                          {"deviation_max", "m", "deviation, at most", "", Shown::if_any}};

int runEmboss(const EmbossOptions& options, Console& console) {
  requireMeshOutput(options.output, options.unit, {options.input});
  Scene scene = openWith(options.input, options.scene, console);
  if (highestRelief(scene) == 0)
    console.warn(options.input.string() + ": there is no relief: the mesh is the field's surface");
  scene.relief.mode = ReliefMode::pulled; // baked later, into a separate field
  const auto compiled = compileFor(std::move(scene), console, FaceLayer::always);
  const EmbossedMesh made = embossedMesh(*compiled, console.progress());
  const ReliefDeviation& deviation = made.deviation;
  const MeshReport counts = inspect(made.mesh);
  console.progress().throwIfCancelled();
  writeMeshIn(options.output, made.mesh, options.unit);

  if (deviation.rms > kToldShare * deviation.highest)
    console.warn("the mesh misses the painted relief by " + formatLength(deviation.rms) +
                 " rms: a smaller --voxel keeps more of it");
  Report report(kEmbossKeys);
  report.set("triangles", counts.triangles).set("vertices", counts.vertices);
  report.set("watertight", counts.watertight);
  report.set("unit", std::string(name(options.unit))).set("voxel", made.voxel);
  report.set("highest", deviation.highest);
  report.set("deviation_rms", deviation.rms).set("deviation_max", deviation.most);
  return console.report(report);
}

} // namespace

Command embossCommand() {
  auto options = std::make_shared<EmbossOptions>();
  Command command{
      .name = "emboss",
      .summary = "relief made into a new mesh",
      .description =
          "Builds the field with the given voxel, bakes the painted relief into it, and writes its "
          "surface as a mesh: several objects become one. relief.height below 0 engraves. The grid "
          "loses height: of a pattern as long as 8 voxels 8 %, as 4 voxels 29 %; deviation is "
          "measured, from the painted texels, displaced along the normals, to the new mesh.",
      .examples = {"patina emboss cup -o cup.ply", "patina emboss cup -o cup.stl --voxel 0.2mm"},
      .keys = kEmbossKeys,
      .arguments = {input("WORKSPACE", "Painted workspace.", into(options->input)),
                    outputTo(options->output, "MESH", "Mesh file (.obj .ply .stl).")},
      .run = [options](Console& console) { return runEmboss(*options, console); }};
  addFieldOptions(command, options->scene);
  command.arguments.push_back(unitOfOutput(options->unit));
  return command;
}

} // namespace patina::cli
