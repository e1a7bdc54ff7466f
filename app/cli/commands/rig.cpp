#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "scan/first_hour.h"
#include "scan/print_rig.h"

namespace patina::cli {

namespace {

struct RigOptions {
  RigPlan plan;
  bool status = false;
  std::filesystem::path folder, shown;
};

const Keys kStepParts = {{"done", "", ""}, {"figure", "", ""}, {"remedy", "", "what to do next"}};

const Keys kRigKeys = {
    {"markers", "", "markers"},
    {"marker_size", "m", "marker", "side of the black square"},
    {"pages", "", "pages"},
    {"board", "", "board", "to photograph; for calibrate --board"},
    {"files", "", "files", "in the folder"},
    {"print", "", "print", "of status, as what follows", Shown::always, kStepParts},
    {"photograph", "", "photograph", "camera.yml", Shown::always, kStepParts},
    {"wave", "", "wave", "the calibrated rig.json", Shown::always, kStepParts},
    {"scan", "", "scan", "", Shown::always, kStepParts},
    {"next", "", "next", "command", Shown::if_any}};

constexpr const char* kShapes[] = {"cube", "pen", "dodecahedron"};

RigShape parseShape(const std::string& word) {
  for (std::size_t i = 0; i < std::size(kShapes); ++i)
    if (word == kShapes[i]) return static_cast<RigShape>(i);
  throw Error("'" + word + "' is none of cube, pen and dodecahedron");
}

bool isStatus(const std::string& word) {
  if (word != "print" && word != "status")
    throw Error("'" + word + "' is no work on a rig; there are: print, status");
  return word == "status";
}

int reportStatus(const std::filesystem::path& folder, Console& console) {
  if (!std::filesystem::is_directory(folder))
    throw FileError(folder.string(), 0, "is no folder; patina rig print -o FOLDER makes one");
  const FirstHour hour = readFirstHour(folder);
  Report report(kRigKeys);
  const auto set = [&](const char* name, const FirstHourStep& step) {
    Json json = Json::object();
    json.set("done", step.done).set("figure", step.figure).set("remedy", step.remedy);
    const std::string between = step.figure.empty() || step.remedy.empty() ? "" : "; ";
    report.set(name, json, (step.done ? "done: " : "open: ") + step.figure + between + step.remedy);
  };
  set("print", hour.print);
  set("photograph", hour.photograph);
  set("wave", hour.wave);
  set("scan", hour.scan);
  return console.report(report.set("next", hour.command));
}

int runRig(const RigOptions& options, Console& console) {
  if (options.status) {
    if (options.shown.empty()) throw Error("rig status needs a FOLDER");
    if (!options.folder.empty()) throw Error("--output: not with rig status");
    console.warnOfNoEffect({"--shape", "--size", "--bore", "--tip", "--family"}, "but with print");
    return reportStatus(options.shown, console);
  }
  if (options.folder.empty()) throw Error("rig print needs -o FOLDER");
  if (!options.shown.empty()) throw Error("'" + options.shown.string() + "': print writes to -o");
  const PrintRigReport printed = printRig(options.plan, options.folder);
  Report report(kRigKeys);
  report.set("markers", printed.markers).set("marker_size", printed.marker_size);
  report.set("pages", printed.pages).set("board", printed.board);
  report.set("files", jsonOf(printed.files));
  return console.report(report);
}

} // namespace

Command rigCommand() {
  auto options = std::make_shared<RigOptions>();
  RigPlan& plan = options->plan;
  return {
      .name = "rig",
      .summary = "print a rig of markers for a pen, and what is still missing before a scan",
      .description =
          "rig print writes what a scan needs besides a camera: markers.pdf with the faces to "
          "be cut out, holder.stl to be printed in plastic and pushed onto a pen, board.pdf "
          "for the camera's calibration, the same sheets as SVG, and rig.json with the places "
          "that the markers should have.\n"
          "Print at 100 % and measure the ruler. What is glued by hand is never quite in its "
          "place. A rig.json that is calibrated already is not replaced.\n"
          "rig status shows what of the first hour is done in FOLDER and how well: printed, camera "
          "photographed (camera.yml), rig waved (rig.json with deviations), scanned (a subfolder), "
          "and the command that comes next.",
      .examples = {"patina rig print -o rig", "patina rig status rig",
                   "patina rig print --shape pen --size 14mm -o rig"},
      .keys = kRigKeys,
      .arguments = {input("WORK", "print or status.", parsedInto(options->status, isStatus)),
                    input("FOLDER", "Folder of status.", into(options->shown), Times::at_most_once),
                    writtenTo(options->folder, "-o,--output", "FOLDER",
                              "Folder for printed files."),
                    {"--shape", "SHAPE", "", "cube",
                     "cube (5 markers), pen (a hexagonal prism, 13) or dodecahedron (11).",
                     parsedInto(plan.shape, parseShape)},
                    {"--size", "LENGTH", "m", "36 mm", "Side of a marker with its white margin.",
                     numberInto(5e-3, 0.18, plan.size, NumberKind::length)},
                    {"--bore", "LENGTH", "m", "10 mm", "Diameter of the pen.",
                     numberInto(1e-3, 0.1, plan.bore, NumberKind::length)},
                    {"--tip", "LENGTH", "m", "120 mm",
                     "Distance of the pen's tip from the middle of the body.",
                     numberInto(1e-2, 1, plan.tip, NumberKind::length)},
                    {"--family", "NAME", "", "4x4_50", "Family of the markers.",
                     [options](const std::string& word) { options->plan.family = word; }}},
      .run = [options](Console& console) { return runRig(*options, console); }};
}

} // namespace patina::cli
