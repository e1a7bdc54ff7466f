#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/stroke_script.h"
#include "app/cli/input/workspace_place.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"
#include "session/build/compile_warnings.h"
#include "session/build/session.h"
#include "session/edit/editor.h"
#include "session/store/workspace_link.h"

namespace patina::cli {

namespace {

struct PaintOptions {
  std::filesystem::path input, output;
  std::vector<std::filesystem::path> strokes;
  std::optional<Seed> seed; // of all strokes, whatever they say
  OpenOptions open;
};

using BlockName = std::pair<std::size_t, MaterialMap::Index>; // object, block

struct PaintRun {
  std::size_t edits = 0; // strokes that painted something
  PaintReport sum;
  std::vector<double> dab_seconds;
  std::set<BlockName> blocks;
  double seconds = 0;
};

void count(PaintRun& run, const EditorNotice& notice) {
  if (!notice.changes) return;
  for (const PaintChange& change : *notice.changes)
    for (const MaterialMap::Index& block : change.material_blocks)
      run.blocks.insert({change.object, block});
}

bool paintsMaterial(const Brush& brush) {
  const std::vector<BrushLayer> layers = layersOf(brush);
  return std::any_of(layers.begin(), layers.end(),
                     [](const BrushLayer& layer) { return channelOf(layer.tool).has_value(); });
}

// A brush reaches all 8 nodes of a cell only from sqrt(3) voxels on (K22).
void warnOfVoxel(const ScriptStroke& script, double voxel, Console& console) {
  const Brush& brush = script.stroke.brush;
  const double whole = std::sqrt(3.0) * voxel;
  if (!paintsMaterial(brush) || brush.radius_per_force != 0 || brush.radius >= whole) return;
  console.warn(script.where + ": a radius of " + formatLength(brush.radius) +
               " does not fill a cell of " + formatLength(voxel) +
               ": values are felt diluted; from " + formatLength(whole) + " on they are not");
}

void warnOfNothing(const ScriptStroke& script, const PaintReport& report, double voxel,
                   Console& console) {
  const Brush& brush = script.stroke.brush;
  if (script.stroke.samples.empty())
    console.warn(script.where + " has no samples");
  else if (report.dabs > 0 && report.texels == 0 && report.nodes == 0 && paintsMaterial(brush))
    console.warn(script.where + " painted nothing: no node of the grid lies within the radius of " +
                 formatLength(brush.radius) + "; the voxel is " + formatLength(voxel));
  else if (report.dabs == 0)
    console.warn(script.where + " touched nothing: no surface within the radius of " +
                 formatLength(brush.radius) + "; positions are in metres, world frame");
  else
    console.warn(script.where + " changed nothing");
}

void paintOne(Editor& editor, const ScriptStroke& script, PaintRun& run, Console& console) {
  const double voxel = editor.compiled()->built.field->grid.voxel;
  const std::size_t before = editor.history().undoable();
  const PaintReport report = editor.apply(script.stroke, console.progress(), &run.dab_seconds);
  run.sum.dabs += report.dabs;
  run.sum.faces += report.faces;
  run.sum.texels += report.texels;
  run.sum.nodes += report.nodes;
  const bool changed = editor.history().undoable() > before;
  run.edits += changed;
  if (changed)
    warnOfVoxel(script, voxel, console);
  else
    warnOfNothing(script, report, voxel, console);
}

void paintAll(Editor& editor, const std::vector<ScriptStroke>& script, PaintRun& run,
              Console& console) {
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < script.size(); ++i) {
    console.progress().report(static_cast<double>(i) / static_cast<double>(script.size()),
                              "painting");
    try {
      paintOne(editor, script[i], run, console);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw Error(script[i].where + ": " + error.what());
    }
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What stands in the journal already stays; the next command would paint it anew.
void keepWhatIsDone(Editor& editor, const PaintRun& run, const std::filesystem::path& folder,
                    Console& console) {
  if (run.edits == 0) return;
  try {
    editor.save();
  } catch (const Error&) { // the first error is the one to tell
  }
  console.warn(formatCount(run.edits) + (run.edits == 1 ? " stroke is" : " strokes are") +
               " in the workspace: patina undo " + folder.string() + " --steps " +
               std::to_string(run.edits) + " takes them back");
}

void requireHeight(const Scene& scene, const std::vector<ScriptStroke>& script) {
  if (scene.relief.height != 0) return;
  for (const ScriptStroke& one : script)
    if (layerOf(one.stroke.brush, Tool::relief))
      throw Error(one.where + ": relief.height is 0: no relief can be painted");
}

const Keys kPaintKeys = {
    {"workspace", "", "workspace"},
    {"strokes", "", "strokes"},
    {"edits", "", "edits", "strokes that painted something", Shown::never},
    {"dabs", "", "dabs"},
    {"faces", "", "touched", "faces, summed over dabs, as texels and nodes"},
    {"texels", "", "texels", "", Shown::never},
    {"nodes", "", "nodes", "", Shown::never},
    {"blocks", "", "blocks", "of material, each once", Shown::never},
    {"seconds", "s", "painted in"},
    {"dab_ms", "ms", "a sample", "until it is felt", Shown::always, percentileParts()},
    {"history", "", "history", "edits that can be undone"}};

int report(const PaintOptions& options, const Editor& editor, std::size_t strokes,
           const PaintRun& run, Console& console) {
  Percentiles dab = percentiles(run.dab_seconds);
  for (double* value : {&dab.p50, &dab.p99, &dab.p999, &dab.max}) *value *= 1e3;
  const PaintReport& sum = run.sum;
  Report report(kPaintKeys);
  report.set("workspace", options.output.string());
  report.set("strokes", strokes,
             formatCount(strokes) + ", painted something " + formatCount(run.edits));
  report.set("edits", run.edits).set("dabs", sum.dabs);
  report.set("faces", sum.faces,
             formatCount(sum.faces) + " faces, " + formatCount(sum.texels) + " texels, " +
                 formatCount(sum.nodes) + " nodes in " + formatCount(run.blocks.size()) +
                 " blocks");
  report.set("texels", sum.texels).set("nodes", sum.nodes).set("blocks", run.blocks.size());
  report.set("seconds", run.seconds);
  report.set("dab_ms", toJson(dab), spreadText(dab, "ms") + ", until it is felt");
  const std::size_t undoable = editor.history().undoable();
  report.set("history", undoable, formatCount(undoable) + " to undo");
  return console.report(report);
}

int runPaint(const PaintOptions& options, Console& console) {
  std::vector<ScriptStroke> script;
  for (const std::filesystem::path& path : options.strokes)
    for (ScriptStroke& one : readScript(path, console)) {
      if (options.seed) one.stroke.brush.seed = *options.seed;
      script.push_back(std::move(one));
    }
  const std::filesystem::path input = inputPath(options.input);
  const bool in_place = sameFolder(input, options.output);
  requireWorkspacePlace(options.output);
  PaintRun run;
  const auto listener = [&run](const EditorNotice& notice) { count(run, notice); };
  std::unique_ptr<Editor> editor;
  if (std::filesystem::is_directory(input)) {
    const Editor::OpenSpec spec{.own = in_place};
    editor = Editor::open(workspaceFolder(input), spec, console.progress(), listener);
    for (const std::string& note : editor->notes()) console.warn(note);
    for (const SceneObject& object : editor->scene().objects)
      if (const auto line = layoutWarning(object)) console.warn(object.name + ": " + *line);
  } else {
    Scene scene = openWith(input, {options.open, {}}, console);
    editor = std::make_unique<Editor>(std::move(scene), console.progress(), listener);
  }
  for (const std::string& line : compileWarnings(*editor->compiled())) console.warn(line);
  requireHeight(editor->scene(), script);
  try {
    paintAll(*editor, script, run, console);
  } catch (...) {
    if (in_place) keepWhatIsDone(*editor, run, input, console);
    throw;
  }
  if (in_place)
    editor->save();
  else
    editor->saveAs(options.output);
  return report(options, *editor, script.size(), run, console);
}

} // namespace

Command paintCommand() {
  auto options = std::make_shared<PaintOptions>();
  Command command{
      .name = "paint",
      .summary = "replay strokes: colour, relief, stiffness, friction, damping, roughness",
      .description =
          "Strokes come from files of version 1 (docs/file_formats.md) or from the journal of a "
          "workspace (its journal-1.jsonl or the like), whose strokes that are not undone are "
          "painted again. The same strokes on the same scene give the same bits.\n"
          "With an output of its own the input stays as it is, byte for byte, and the output gets "
          "the whole history. With the input itself as output every stroke is on disk as soon as "
          "it is painted: what was painted before Ctrl-C, or before a stroke that fails, stays, "
          "and patina undo takes it back. A stroke that touches nothing is warned of and is no "
          "edit.\n"
          "A stroke may carry several layers, such as colour, stiffness and relief at once; it is "
          "one edit. Its brush starts from the surface's nearest point, or with seed segment from "
          "where the way from the tip goes through the surface.\n"
          "A radius below 1.73 voxels reaches some nodes of a cell only: painted stiffness and "
          "friction are then felt diluted.",
      .examples = {"patina paint cup --strokes glaze.json -o painted",
                   "patina paint cup --strokes painted/journal-1.jsonl -o cup",
                   "patina paint cup.ply --strokes glaze.json --strokes grip.json -o painted"},
      .keys = kPaintKeys,
      .arguments = {sceneInput(options->input, "WORKSPACE"),
                    {"--strokes", "STROKES.json", "", "", "What to paint.", into(options->strokes),
                     Times::at_least_once},
                    {"--seed", "nearest|segment", "", "",
                     "Where brushes start, whatever the strokes say.",
                     parsedInto(options->seed, parseSeed)},
                    outputTo(options->output, "WORKSPACE", "The folder, which may be the input.")},
      .run = [options](Console& console) { return runPaint(*options, console); }};
  addOpenOptions(command, options->open);
  return command;
}

} // namespace patina::cli
