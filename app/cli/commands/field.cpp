#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "session/compile/compile_warnings.h"
#include "visualization/files/field_io.h"

namespace patina::cli {

namespace {

struct FieldOptions {
  std::filesystem::path input, output;
  SceneOptions scene;
};

int runField(const FieldOptions& options, Console& console) {
  if (!isVolumeFile(options.output))
    throw Error("--output: a field is a .vti file, not '" + options.output.string() + "'");
  requireWritable(options.output, {options.input}, FileKind::image_data);
  const Scene scene = openWith(options.input, options.scene, console);
  if (scene.objects.empty())
    throw Error(options.input.string() + ": needs an object to build a field");
  // One object needs only its field, unless relief is baked.
  const bool baked = scene.relief.mode == ReliefMode::baked && highestRelief(scene) > 0;
  BuiltField built;
  if (scene.objects.size() == 1 && !baked) {
    built = buildField(worldMesh(scene), scene.field, console.progress());
  } else {
    const auto compiled = compile(scene, console.progress());
    built = compiled->built;
    built.field = compiled->paint.field;
  }
  console.progress().throwIfCancelled();
  if (scene.objects.size() == 1 && !baked)
    for (const std::string& line :
         surfaceWarnings(built.report, scene.field.sides, worldMesh(scene)))
      console.warn(line);
  writeField(options.output, *built.field);
  return console.report(fieldReport(*built.field, built.report));
}

} // namespace

Command fieldCommand() {
  auto options = std::make_shared<FieldOptions>();
  Command command{
      .name = "field",
      .summary = "build the sampled implicit surface of a mesh or scene",
      .description =
          "Writes signed distance [m], negative inside, and the nearest face of every node in a "
          "band about the surface, as a volume that ParaView opens. Baked relief is in it, pulled "
          "relief is not.",
      .examples = {"patina field bunny.ply -o bunny.vti --resolution 200",
                   "patina field bunny.ply -o bunny.vti --voxel 0.5mm --band 6 --json"},
      .keys = fieldKeys(),
      .arguments = {sceneInput(options->input, "MESH"),
                    outputTo(options->output, "FIELD.vti", "The field, compressed.")},
      .run = [options](Console& console) { return runField(*options, console); }};
  addFieldOptions(command, options->scene);
  addOpenOptions(command, options->scene.open);
  return command;
}

} // namespace patina::cli
