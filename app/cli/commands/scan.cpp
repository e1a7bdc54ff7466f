#include "app/cli/commands/commands.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "scan/run_scan.h"
#include "session/store/workspace_storage.h"

namespace patina::cli {

namespace {

const Keys kScanKeys = {
    {"steps",
     "",
     "steps",
     "that ran; what each found is in the folder's scan.json, too",
     Shown::never,
     {{"step", "", ""}, {"folder", "", ""}, {"found", "", ""}, {"seconds", "s", ""}}},
    {"done", "", "done", "false: a path is wrong or its pose uncertain, and no texture was mapped"},
    {"workspace", "", "workspace", "with the mesh and its textures", Shown::if_any},
    {"textured", "", "textured", "the mesh as an OBJ with haptic coordinates", Shown::if_any}};

ScanStep parseStep(const std::string& word) {
  const std::vector<std::string>& names = scanStepNames();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (word == names[i]) return static_cast<ScanStep>(i);
  throw Error("'" + word + "' is none of " + joined(names));
}

int runScanCommand(const RunScanOptions& options, Console& console) {
  if (options.from && *options.from > options.to)
    throw Error("--from: that step comes after the one of --to");
  if (options.to == ScanStep::texture && options.workspace.empty())
    throw Error("-o: names the workspace to be made; --to register ends before it");
  if (!options.workspace.empty()) requireWorkspacePlace(options.workspace);
  const RunScanReport found = runScan(options, console.progress());
  for (const std::string& line : found.warnings) console.warn(line);
  Report report(kScanKeys);
  Json steps = Json::array();
  for (const RunScanReport::Step& step : found.steps) {
    const std::string& name = scanStepNames()[static_cast<std::size_t>(step.step)];
    steps.push(Json::object()
                   .set("step", name)
                   .set("folder", step.folder.string())
                   .set("found", step.found)
                   .set("seconds", step.seconds));
    report.tell(name, step.folder.string() + ": " + step.found);
  }
  report.set("steps", steps).set("done", found.done);
  if (found.done && options.to == ScanStep::texture)
    report.set("workspace", options.workspace.string())
        .set("textured", (options.folders.front() / "textured.obj").string());
  if (!found.done && found.registered)
    console.warn(options.mesh.string() +
                 ": the pose of the scans is uncertain, so no texture was mapped");
  return console.report(report, found.done ? kDone : kNotSolved);
}

} // namespace

Command scanCommand() {
  auto options = std::make_shared<RunScanOptions>();
  return {
      .name = "scan",
      .summary = "make a textured workspace from scan folders",
      .description =
          "Runs the steps from frames to a textured workspace: track (poses.tum), filter "
          "(path.csv), register (registered.csv, registration.json) and texture (heights.csv, "
          "texture.json, the workspace, and textured.obj in the first FOLDER). Each leaves in the "
          "folder of its scan what the commands leave, tables and textures to the last bit, and "
          "what it found in scan.json. Existing results are kept, unless --from names their step; "
          "paths are registered again if mesh, unit or paths have changed, or if the pose was "
          "uncertain.\n"
          "All folders are scans of one body, made with one camera in one place. Where the scans "
          "tell "
          "a stiffness, it becomes that of the body. Exit code 1 where the pose on the mesh is "
          "uncertain: the steps before it are kept, and so is a certain pose of an earlier run.",
      .examples = {"patina scan ribs weave --with survey --mesh toy.obj -o toy",
                   "patina scan ribs --mesh toy.obj --from register -o toy2"},
      .keys = kScanKeys,
      .arguments =
          {input("FOLDER", "Scan folder: frames or poses.tum, probe.csv, rig.json.",
                 into(options->folders), Times::at_least_once),
           {"--mesh", "MESH", "", "", "Of the body that was scanned.", into(options->mesh),
            Times::once},
           {"-o,--output", "WORKSPACE", "", "", "The workspace to be made.",
            outInto(options->workspace), Times::at_most_once, true},
           {"--with", "FOLDER", "", "",
            "Another scan of the body, which only helps to find the place: no texture is made of "
            "it.",
            into(options->also), Times::any},
           {"--from", "STEP", "", "the first whose files are not there",
            "Run this step and those after it: track, filter, register or texture.",
            parsedInto(options->from, parseStep)},
           {"--to", "STEP", "", "texture", "The last step to run.",
            parsedInto(options->to, parseStep)},
           tipRadius(options->tip_radius, "that of rig.json"),
           unitOfMesh(options->unit)},
      .run = [options](Console& console) { return runScanCommand(*options, console); }};
}

} // namespace patina::cli
