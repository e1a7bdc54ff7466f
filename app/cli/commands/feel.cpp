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
#include "session/open/stage_cost.h"
#include "visualization/export/export_files.h"

namespace patina::cli {

namespace {

struct FeelOptions {
  std::filesystem::path input, path, output;
  SceneOptions scene;
};

Keys stepParts() {
  Keys parts = percentileParts();
  parts.push_back({"timer", "", "", "what reading the clock adds"});
  return parts;
}

const Keys kFeelKeys = {
    {"ticks", "", "ticks"},
    {"stages", "", "stages"},
    {"step_ns", "ns", "step", "time of a tick", Shown::always, stepParts()},
    {"contact_ticks", "", "in contact", "ticks", Shown::never},
    {"deep_ticks", "", "deep", "ticks that found contact from inside, not by the way in",
     Shown::if_any},
    {"fault_ticks", "", "faults", "ticks faded by a force jump", Shown::if_any},
    {"pauses", "", "pauses", "in which the tip was lifted: longer than 20 ms and than 4 ticks",
     Shown::if_any},
    {"bad_tips", "", "bad tips", "NaN or infinite: no force there", Shown::if_any},
    {"max_force", "N", "largest force"},
    {"max_depth", "m", "largest depth"},
    {"field", "", "as patina field"}};

int runFeel(const FeelOptions& options, Console& console) {
  requireWritable(options.output, {options.input, options.path}, FileKind::table);
  TipPathReader path(options.path);
  // An invalid path is rejected before the field is built.
  std::optional<TimedTip> first = path.next();
  console.warn(path.table().leftOut());
  const auto compiled = compileFor(openWith(options.input, options.scene, console), console);

  std::size_t ticks = 0, bad_tips = 0, contact_ticks = 0, deep_ticks = 0, faults = 0;
  double max_force = 0, max_depth = 0;
  std::map<std::uint32_t, std::size_t> step_ns;
  CsvWriter rows_out(options.output, toolSampleColumns());
  const auto next = [&]() -> std::optional<TimedTip> {
    if (ticks % 4096 == 0) console.progress().report(path.table().fraction(), "feeling");
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
  const std::size_t pauses = feel(*compiled->snapshot, next, take, console.progress());
  console.progress().throwIfCancelled();
  rows_out.commit();

  const Percentiles step = percentilesOfCounts(step_ns);
  const double timer = timerNs();

  const std::vector<std::string> stages = namesIn(compiled->snapshot->why, &StageInfo::name);
  Report report(kFeelKeys);
  report.set("ticks", ticks, formatCount(ticks) + ", in contact " + formatCount(contact_ticks));
  report.set("contact_ticks", contact_ticks).set("stages", jsonOf(stages));
  report.set("step_ns", toJson(step).set("timer", timer),
             spreadText(step, "ns") + "; of these the clock takes " + rounded(timer));
  report.set("max_force", max_force).set("max_depth", max_depth);
  report.set("deep_ticks", deep_ticks,
             formatCount(deep_ticks) + " ticks found contact from inside");
  report.set("fault_ticks", faults, formatCount(faults) + " ticks faded by a force jump");
  report.set("pauses", pauses);
  report.set("bad_tips", bad_tips);
  report.set("field", fieldReport(*compiled->built.field, compiled->built.report));
  if (bad_tips)
    console.warn(options.path.string() + ": " + formatCount(bad_tips) +
                 (bad_tips == 1 ? " tip is" : " tips are") + " NaN or infinite, no force there; " +
                 path.table().firstNotFinite());
  if (contact_ticks == 0 && bad_tips < ticks)
    console.warn(options.path.string() +
                 ": the path never touches the object; compare their positions and check --unit");
  return console.report(report);
}

} // namespace

Command feelCommand() {
  auto options = std::make_shared<FeelOptions>();
  Command command{
      .name = "feel",
      .summary = "replay a tip path through the servo's own code",
      .description =
          "The output has one row per tick: force on the hand, contact, depth, virtual contact "
          "point, normal and the time of the step. The path has the columns t [s],x [m],y [m],z "
          "[m], its times increasing; the time between two rows is the tick. A pause longer than "
          "20 ms and than four ticks lifts the tip: contact starts again where it comes down.",
      .examples = {"patina feel bunny.ply --path tip.csv -o forces.csv --stiffness 800",
                   "patina feel workspace --path tip.csv -o forces.csv --tip-radius 1mm --json"},
      .keys = kFeelKeys,
      .arguments = {sceneInput(options->input, "MESH"),
                    {"--path", "TIP.csv", "", "", "The tip's path.", into(options->path),
                     Times::once},
                    outputTo(options->output, "FORCES.csv", "One row a tick.")},
      .run = [options](Console& console) { return runFeel(*options, console); }};
  addHapticOptions(command, options->scene);
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
