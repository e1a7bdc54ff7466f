#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/tip_path.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/numbers.h"
#include "core/percentiles.h"
#include "session/build/stage_cost.h"
#include "visualization/export/export_files.h"

namespace patina::cli {

namespace {

struct FeelOptions {
  std::filesystem::path input, path, output;
  SceneOptions scene;
};

int runFeel(const FeelOptions& options, Console& console) {
  requireWritable(options.output, {options.input, options.path});
  TipPathReader path(options.path);
  // A path that is wrong from the start is refused before the field is built.
  std::optional<TimedTip> first = path.next();
  const auto compiled = compileFor(openWith(options.input, options.scene, console), console);

  std::size_t ticks = 0, bad_tips = 0, contact_ticks = 0, deep_ticks = 0, faults = 0;
  double max_force = 0, max_depth = 0;
  std::map<std::uint32_t, std::size_t> step_ns;
  CsvWriter rows_out(options.output, toolSampleColumns());
  const auto next = [&]() -> std::optional<TimedTip> {
    if (ticks % 4096 == 0) console.progress().report(path.fraction(), "feeling");
    auto tip = first ? std::exchange(first, std::nullopt) : path.next();
    bad_tips += tip && !tip->tip.allFinite();
    return tip;
  };
  const auto take = [&](const ToolSample& sample) {
    ++ticks;
    contact_ticks += sample.contact;
    deep_ticks += sample.deep;
    faults += sample.fault;
    max_force = std::max(max_force, sample.force.norm());
    max_depth = std::max(max_depth, sample.depth);
    ++step_ns[sample.step_ns];
    rows_out.add(toolSampleRow(sample));
  };
  feel(*compiled->snapshot, next, take, console.progress());
  console.progress().throwIfCancelled();
  rows_out.commit();

  const Percentiles step = percentilesOfCounts(step_ns);
  const double timer = timerNs();

  Json stages = Json::array();
  std::string stage_text;
  for (const StageInfo& stage : compiled->snapshot->why) {
    stages.push(stage.name);
    stage_text += (stage_text.empty() ? "" : ", ") + stage.name;
  }
  Json json = Json::object();
  json.set("ticks", ticks);
  json.set("stages", stages);
  Json step_json = toJson(step);
  step_json.set("timer", timer);
  json.set("step_ns", step_json);
  json.set("contact_ticks", contact_ticks);
  json.set("deep_ticks", deep_ticks);
  json.set("fault_ticks", faults);
  json.set("bad_tips", bad_tips);
  json.set("max_force", max_force);
  json.set("max_depth", max_depth);
  json.set("field", fieldJson(*compiled->built.field, compiled->built.report));

  TextRows rows = {{"ticks", formatCount(ticks) + ", in contact " + formatCount(contact_ticks)},
                   {"stages", stage_text},
                   {"step", rounded(step.p50) + " ns (p50), " + rounded(step.p99) + " (p99), " +
                                rounded(step.p999) + " (p99.9), " + rounded(step.max) +
                                " (max); of these the clock takes " + rounded(timer)},
                   {"largest force", rounded(max_force) + " N"},
                   {"largest depth", formatLength(max_depth)}};
  if (deep_ticks)
    rows.emplace_back("deep", formatCount(deep_ticks) + " ticks found contact from inside");
  if (faults) rows.emplace_back("faults", formatCount(faults) + " ticks faded by a force jump");
  const TextRows field = fieldRows(*compiled->built.field, compiled->built.report);
  rows.insert(rows.end(), field.begin(), field.end());
  if (bad_tips)
    console.warn(options.path.string() + ": " + formatCount(bad_tips) +
                 (bad_tips == 1 ? " tip is" : " tips are") + " NaN or infinite: no force there");
  if (contact_ticks == 0 && bad_tips < ticks)
    console.warn(options.path.string() +
                 ": the path never touches the object; compare their positions and check --unit");
  console.report(json, aligned(rows));
  return kDone;
}

} // namespace

Command feelCommand() {
  auto options = std::make_shared<FeelOptions>();
  Command command;
  command.name = "feel";
  command.summary = "replay a tip path through the servo's own code";
  command.description =
      "One row a tick goes out: force on the hand, contact, depth, virtual contact point, normal "
      "and the time of the step. The path has the columns t [s],x [m],y [m],z [m], its times "
      "increasing; the time between two rows is the tick.\n"
      "JSON: ticks, stages, step_ns (p50, p99, p999, max, and timer: what reading the clock adds), "
      "contact_ticks, deep_ticks (found contact from inside, not by the way in), fault_ticks, "
      "bad_tips (NaN or infinite), max_force [N], max_depth [m], field (as patina field).";
  command.examples = {"patina feel bunny.ply --path tip.csv -o forces.csv --stiffness 800",
                      "patina feel workspace --path tip.csv -o forces.csv --tip-radius 1mm --json"};
  command.input("MESH", "Mesh (.obj .ply .stl), workspace or volume (.vti).", options->input);
  command.file("--path", "TIP.csv", "The tip's path.", options->path).required = true;
  command.output("FORCES.csv", "One row a tick.", options->output);
  addHapticOptions(command, options->scene);
  addFieldOptions(command, options->scene);
  addSamplerOption(command, options->scene);
  addOpenOptions(command, options->scene.open);
  command.run = [options](Console& console) { return runFeel(*options, console); };
  return command;
}

} // namespace patina::cli
