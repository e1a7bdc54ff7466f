#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/tip_path.h"
#include "app/cli/output/reports.h"
#include "app/cli/output/stability_report.h"
#include "session/open/scene_export.h"

namespace patina::cli {

namespace {

struct ExportOptions {
  std::filesystem::path input, output, path;
  bool stability = false;
  SceneOptions scene;
};

const Keys kExportKeys = {{"folder", "", "folder", "", Shown::never},
                          {"files", "", "files", "in the folder", Shown::never},
                          {"stability", "", "as patina render"}};

int runExport(const ExportOptions& options, Console& console) {
  const std::filesystem::path& folder = options.output;
  std::vector<TimedTip> path;
  if (!options.path.empty()) {
    TipPathReader reader(options.path);
    console.warn(reader.table().leftOut());
    while (const auto tip = reader.next()) path.push_back(*tip);
  }
  const auto compiled =
      compileFor(openWith(options.input, options.scene, console), console, FaceLayer::always);
  std::optional<SurfaceStability> stability;
  if (options.stability) stability = requiredStability(*compiled, console.progress());
  console.progress().throwIfCancelled();

  ExportExtras extras{.inputs = {options.input, options.path},
                      .warn = [&](const std::string& line) { console.warn(line); }};
  if (!path.empty()) extras.samples = feel(*compiled->snapshot, path, console.progress());
  if (stability) extras.stability = &*stability;
  const auto written = exportScene(*compiled, folder, extras, console.progress());

  Report report(kExportKeys);
  Json files = Json::array();
  for (const ExportedFile& file : written) {
    files.push(file.name);
    report.tell(file.what, (folder / file.name).string());
  }
  report.set("folder", folder.string()).set("files", files);
  if (stability) report.set("stability", stabilityReport(*stability, compiled->scene));
  return console.report(report);
}

} // namespace

Command exportCommand() {
  auto options = std::make_shared<ExportOptions>();
  Command command{
      .name = "export",
      .summary = "write everything for ParaView",
      .description =
          "Into the folder: mesh.vtp (of several objects with the index of each triangle's), "
          "surface.vtp (the surface that the tip's centre feels, without relief that is pulled), "
          "field.vti, vertices.csv (the field at the mesh's vertices), scene.vtm, which opens them "
          "together, and with --path also path.vtp and forces.csv (as patina feel). Painted images "
          "go beside them, as .png (16 bits) and .exr (floats); paint-NAME.vtp has an object's "
          "mesh with all that was painted on it, material-NAME.vti its painted material.\n"
          "With --stability the vertices of surface.vtp carry K*(x)/K, below 1 where the loop is "
          "unstable, and the min stiffness over directions, below 0 where the tip slips off.",
      .examples = {"patina export workspace -o paraview",
                   "patina export bunny.ply -o paraview --path tip.csv"},
      .keys = kExportKeys,
      .arguments = {sceneInput(options->input),
                    outputTo(options->output, "FOLDER", "Where to; made if it is missing."),
                    {"--path", "TIP.csv", "", "", "A tip path to feel and write too.",
                     into(options->path)},
                    {"--stability", "", "", "", "Where would it buzz: arrays on surface.vtp.",
                     into(options->stability)}},
      .run = [options](Console& console) { return runExport(*options, console); }};
  addHapticOptions(command, options->scene);
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
