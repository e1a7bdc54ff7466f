#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/console.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/workspace_place.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/percentiles.h"
#include "scene/stroke.h"
#include "session/compile/compile_warnings.h"
#include "session/edit/editor.h"
#include "session/open/session.h"
#include "session/store/journal_fold.h"
#include "session/store/workspace_storage.h"

namespace patina::cli {
namespace {

// Strokes from a file, for patina paint.
struct ScriptStroke {
  Stroke stroke;
  std::string where; // "hand.json: stroke 3"
};

std::vector<Stroke> strokesOfJournal(const std::string& text, const std::string& name,
                                     Console& console) {
  const JournalText journal = parseJournal(text);
  if (journal.damaged_line) throw FileError(name, journal.damaged_line, journal.damage);
  if (journal.torn) console.warn(name + ": its last record was not finished and is left out");
  const FoldedJournal fold = folded(journal.events, name);
  std::vector<Stroke> strokes;
  const std::size_t heading = journal.from.empty() ? 0 : 1;
  for (std::size_t i = 0; i < fold.position; ++i) {
    const auto* stroke = std::get_if<Stroke>(fold.steps[i].event);
    if (!stroke) continue;
    try {
      requireSamples(*stroke);
    } catch (const Error& error) {
      throw FileError(name, fold.steps[i].number + heading, error.what());
    }
    strokes.push_back(*stroke);
  }
  if (const std::size_t others = fold.position - strokes.size())
    console.warn(name + ": " + formatCount(others) + (others == 1 ? " edit is" : " edits are") +
                 " no stroke and left out");
  return strokes;
}

// Reads a strokes file (version 1) or, for .jsonl, the strokes that are still applied at the end of
// a workspace's journal; other edits are skipped with a warning. Throws FileError.
std::vector<ScriptStroke> readScript(const std::filesystem::path& path, Console& console) {
  const std::string name = path.string();
  const std::string text = readFile(path);
  const bool journal =
      path.extension() == ".jsonl" || (isStandardStream(path) && text.starts_with(R"({"n":)"));
  std::vector<Stroke> strokes =
      journal ? strokesOfJournal(text, name, console) : parseStrokes(text, name);
  std::vector<ScriptStroke> script;
  for (Stroke& stroke : strokes) {
    std::string where = name + ": stroke " + std::to_string(script.size() + 1);
    script.push_back({std::move(stroke), std::move(where)});
  }
  return script;
}

struct PaintOptions {
  std::filesystem::path input, output;
  std::vector<std::filesystem::path> strokes;
  std::optional<DabAnchor> anchor; // replaces that of all strokes
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

// A brush covers all 8 nodes of a cell only from sqrt(3) voxels on (K22).
void warnOfVoxel(const ScriptStroke& script, double voxel, Console& console) {
  const Brush& brush = script.stroke.brush;
  const double whole = std::sqrt(3.0) * voxel;
  if (!paintsMaterial(brush) || brush.radius_per_force != 0 || brush.radius >= whole) return;
  console.warn(script.where + ": a radius of " + formatLength(brush.radius) +
               " does not fill a cell of " + formatLength(voxel) + ": values are diluted; from " +
               formatLength(whole) + " on they are not");
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
      if (options.anchor) one.stroke.brush.anchor = *options.anchor;
      script.push_back(std::move(one));
    }
  const std::filesystem::path input = inputPath(options.input);
  const bool in_place = sameFolder(input, options.output);
  requireWorkspacePlace(options.output);
  PaintRun run;
  const auto listener = [&run](const EditorNotice& notice) { count(run, notice); };
  std::unique_ptr<Editor> editor;
  const bool repeated = !in_place && isRepeatedIn(options.output, console);
  if (std::filesystem::is_directory(input)) {
    const Editor::OpenSpec spec{.own = in_place, .all_or_none = true, .intent = console.intent};
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
  if (repeated ||
      (in_place && editor->isRepeated() && isRepeated(options.output, {console.intent}, console)))
    return report(options, *editor, script.size(), run, console);
  paintAll(*editor, script, run, console);
  if (!in_place) {
    editor->saveAs(options.output, console.intent);
    console.markCommitted();
  } else if (run.edits > 0) {
    console.commit([&] { editor->commit(); });
    saveJournaled(options.output, console, [&] { editor->save(); });
  }
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
          "the whole history. With the input itself as output all strokes are added together "
          "at the end, or none after Ctrl-C or an error. A stroke that changes nothing gives a "
          "warning and is not an edit.\n"
          "A stroke may carry several layers, such as colour, stiffness and relief at once; it is "
          "one edit. Its brush starts from the surface's nearest point, or with seed segment from "
          "the point where the ray from the tip hits the surface.\n"
          "A radius below 1.73 voxels reaches some nodes of a cell only: painted stiffness and "
          "friction are then diluted.",
      .examples = {"patina paint cup --strokes glaze.json -o painted",
                   "patina paint cup --strokes painted/journal-1.jsonl -o cup",
                   "patina paint cup.ply --strokes glaze.json --strokes grip.json -o painted"},
      .keys = kPaintKeys,
      .arguments = {sceneInput(options->input, "WORKSPACE"),
                    {"--strokes", "STROKES.json", "", "", "What to paint.", into(options->strokes),
                     Times::at_least_once},
                    {"--dab-anchor", "nearest|segment", "", "",
                     "Where brushes start; overrides the strokes.",
                     parsedInto(options->anchor, parseDabAnchor)},
                    outputTo(options->output, "WORKSPACE", "The folder, which may be the input.")},
      .run = [options](Console& console) { return runPaint(*options, console); },
      .changes_workspace = true};
  addOpenOptions(command, options->open);
  return command;
}

} // namespace patina::cli
