#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/simulation_start.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"
#include "haptics/contact/plane.h"
#include "haptics/devices/simulation.h"

namespace patina::cli {

namespace {

constexpr double kDefaultPress = 1; // [N], where nothing else sets the tip in motion

// "0.3": a share of the period to both sides; "0.5-2ms" or "0.0005-0.002": from and to.
struct Jitter {
  std::optional<double> share;
  std::optional<PeriodRange> range;
};
Jitter parseJitter(const std::string& text) {
  const Error bad("'" + text +
                  "': it must be a share of the period from 0 to 1 (0.3), or a range (" +
                  "0.5-2ms)");
  if (const std::optional<double> share = parseNumber(text)) {
    if (!(*share >= 0 && *share < 1)) throw bad;
    return {share, std::nullopt};
  }
  std::string body = text;
  double unit = 1;
  if (body.ends_with("ms")) {
    body.resize(body.size() - 2);
    unit = 1e-3;
  } else if (body.ends_with("s")) {
    body.resize(body.size() - 1);
  }
  const std::size_t dash = body.find('-');
  if (dash == std::string::npos) throw bad;
  const auto shortest = parseNumber(body.substr(0, dash));
  const auto longest = parseNumber(body.substr(dash + 1));
  if (!shortest || !longest || !(*shortest > 0 && *longest >= *shortest && *longest * unit <= 1))
    throw bad;
  return {std::nullopt, PeriodRange{*shortest * unit, *longest * unit}};
}

struct SimulateOptions {
  std::filesystem::path input, output;
  bool plane = false;
  SceneOptions scene;
  bool naive = false;
  bool limited = false; // --force-limit was given
  std::optional<double> depth, gap, speed, press;
  Jitter jitter;
  SimulationSpec spec;
};

// A number that may be given from `lowest` to `highest`.
void addValue(Command& command, const std::string& names, const std::string& value,
              const std::string& help, const std::string& fallback, double lowest, double highest,
              std::function<void(double)> set, bool length = false) {
  command.arguments.push_back(
      {names, value, help, fallback, false, false, [=](const std::string& text) {
         const std::optional<double> number = length ? parseLength(text) : parseNumber(text);
         if (!number) throw Error("'" + text + "' is not a number");
         if (!(*number >= lowest && *number <= highest))
           throw Error("'" + text + "': it must be between " + formatNumber(lowest) + " and " +
                       formatNumber(highest));
         set(*number);
       }});
}

struct Felt {
  Scene scene;
  std::shared_ptr<const HapticSnapshot> snapshot;
  std::shared_ptr<const CompiledScene> compiled; // keeps a model's field; null for the plane
  SimulationStart start{Vec3::Zero(), -Vec3::UnitZ()};
};

Felt feltBy(const SimulateOptions& options, Console& console) {
  Felt felt;
  if (options.plane) {
    applySettings(felt.scene, options.scene.settings);
    // A limit of the force would hide where the loop ends.
    if (!options.limited) felt.scene.haptics.force_limit = std::numeric_limits<double>::infinity();
  } else {
    felt.scene = openWith(options.input, options.scene, console);
  }
  if (!felt.scene.device_model) felt.scene.device_model = DeviceModel{};
  if (options.naive) felt.scene.stabilisers = Stabilisers{};
  const Scene& scene = felt.scene;
  if (options.plane) {
    felt.snapshot = planeSnapshot(
        scene.haptics, planStabilisers(scene.haptics, scene.device_model, scene.stabilisers));
  } else {
    felt.compiled = compileFor(scene, console);
    felt.snapshot = felt.compiled->snapshot;
    felt.start = simulationStart(*felt.compiled);
  }
  return felt;
}

SimulationSpec specFor(const SimulateOptions& options, const Felt& felt) {
  SimulationSpec spec = options.spec;
  spec.device = *felt.scene.device_model;
  spec.surface = felt.start.surface;
  spec.inward = felt.start.inward;
  if (options.depth && options.gap) throw Error("--start-depth and --start-gap: give one of them");
  spec.depth = options.depth.value_or(0) - options.gap.value_or(0);
  spec.speed = options.speed.value_or(0);
  const bool moved = options.depth || options.gap || options.speed;
  spec.press = options.press.value_or(moved ? 0 : kDefaultPress);
  spec.jitter = options.jitter.range;
  if (const auto share = options.jitter.share)
    spec.jitter = PeriodRange{(1 - *share) / spec.device.rate, (1 + *share) / spec.device.rate};
  if (options.naive) spec.naive_limit = 2 * spec.device.damping * spec.device.rate;
  return spec;
}

class RunTable {
 public:
  void add(const SimulationRow& row) {
    const Vec3 &x = row.position, &v = row.velocity, &f = row.force;
    table_.rows.push_back(
        {row.t, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), f.x(), f.y(), f.z(), row.energy});
  }
  const CsvTable& table() const { return table_; }

 private:
  CsvTable table_{{"t [s]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "vz [m/s]", "fx [N]",
                   "fy [N]", "fz [N]", "energy [J]"},
                  {}};
};

std::string inScience(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

Json orNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json reportJson(const Felt& felt, const SimulationSpec& spec, const SimulationReport& run,
                double seconds_taken) {
  const SampledLoop loop = sceneLoop(felt.scene.haptics, spec.device, spec.hand);
  Json json = Json::object();
  json.set("stable", run.stable);
  json.set("verdict", name(run.verdict));
  json.set("rms_velocity", run.rms_velocity);
  json.set("max_depth", run.max_depth);
  json.set("max_force", run.max_force);
  json.set("energy_absorbed", run.energy.absorbed);
  json.set("energy_credited", run.energy.credited);
  json.set("energy_absorbed_min", run.energy.lowest_absorbed);
  json.set("energy_credited_min", run.energy.lowest_credited);
  json.set("predicted_limit", stiffnessLimit(loop));
  json.set("rule_of_thumb", ruleOfThumb(loop));
  json.set("stiffness", felt.scene.haptics.stiffness);
  json.set("stiffness_displayed", orNull(run.stiffness_displayed));
  const auto& coupling = felt.snapshot->stabilisers.coupling;
  const auto& lateral = felt.snapshot->stabilisers.lateral;
  json.set("coupling_stiffness", coupling ? Json(coupling->stiffness) : Json());
  json.set("coupling_damping", coupling ? Json(coupling->damping) : Json());
  json.set("lateral_stiffness", lateral ? Json(lateral->stiffness) : Json());
  json.set("lateral_damping", lateral ? Json(lateral->damping) : Json());
  json.set("restitution", orNull(run.restitution));
  Json stages = Json::array();
  for (const StageInfo& stage : felt.snapshot->why) stages.push(stage.name);
  json.set("stages", stages);
  json.set("ticks", static_cast<std::size_t>(run.ticks));
  json.set("contact_ticks", static_cast<std::size_t>(run.contact_ticks));
  json.set("fault_ticks", static_cast<std::size_t>(run.fault_ticks));
  json.set("press", spec.press);
  json.set("wall_seconds", seconds_taken);
  return json;
}

TextRows reportRows(const Felt& felt, const SimulationSpec& spec, const SimulationReport& run,
                    double seconds_taken) {
  const SampledLoop loop = sceneLoop(felt.scene.haptics, spec.device, spec.hand);
  const double stiffness = felt.scene.haptics.stiffness;
  const std::string verdict = std::string(name(run.verdict)) + ": rms velocity " +
                              inScience(run.rms_velocity) + " m/s in the last second, " +
                              inScience(run.rms_early) + " in the second one";
  std::string stages;
  for (const StageInfo& stage : felt.snapshot->why)
    stages += (stages.empty() ? "" : ", ") + stage.name;
  TextRows rows = {
      {"verdict", verdict},
      {"predicted limit", rounded(stiffnessLimit(loop)) +
                              " N/m of this loop without stabilisers (" +
                              rounded(ruleOfThumb(loop)) + " by the rule of thumb)"},
      {"stiffness",
       rounded(stiffness) + " N/m asked" +
           (run.stiffness_displayed ? ", " + rounded(*run.stiffness_displayed) + " N/m displayed"
                                    : "")},
      {"stages", stages}};
  const StabiliserPlan& plan = felt.snapshot->stabilisers;
  const auto told = [](const auto& coupling, const std::string& why) {
    return rounded(coupling.stiffness) + " N/m, " + rounded(coupling.damping) + " N s/m (" + why +
           ")";
  };
  if (plan.coupling) rows.emplace_back("coupling", told(*plan.coupling, plan.why));
  if (plan.lateral) rows.emplace_back("lateral coupling", told(*plan.lateral, plan.lateral_why));
  if (run.restitution) rows.emplace_back("restitution", rounded(*run.restitution));
  rows.emplace_back("largest depth", formatLength(run.max_depth));
  rows.emplace_back("largest force", rounded(run.max_force) + " N");
  rows.emplace_back("energy absorbed", inScience(run.energy.absorbed) + " J by the surface, " +
                                           inScience(run.energy.credited) +
                                           " J with the device's damping");
  if (run.fault_ticks)
    rows.emplace_back("faults", formatCount(run.fault_ticks) + " ticks faded by a force jump");
  rows.emplace_back("time",
                    rounded(spec.seconds) + " s simulated in " + rounded(seconds_taken) + " s");
  return rows;
}

int runSimulate(const SimulateOptions& options, Console& console) {
  if (options.plane && !options.input.empty())
    throw Error("simulate: give " + options.input.string() + " or --plane, not both");
  if (!options.plane && options.input.empty())
    throw Error("simulate: give a workspace, a mesh or --plane");
  if (!options.output.empty()) requireWritable(options.output, {options.input});
  const Felt felt = feltBy(options, console);
  const SimulationSpec spec = specFor(options, felt);

  RunTable table;
  RowSink sink;
  if (!options.output.empty()) sink = [&](const SimulationRow& row) { table.add(row); };
  const auto start = std::chrono::steady_clock::now();
  const SimulationReport run = simulate(*felt.snapshot, spec, console.progress(), sink);
  const double taken =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.output.empty()) writeCsv(options.output, table.table());
  if (run.contact_ticks == 0)
    console.warn("simulate: the tip never touches the surface");
  else if (!run.touches_late && !options.plane && spec.press > 0)
    console.warn(
        std::string("simulate: the tip slid or was thrown off the model") +
        (spec.hand.stiffness > 0 ? "" : "; --hand-stiffness 200 holds it about its start"));
  console.report(reportJson(felt, spec, run, taken), aligned(reportRows(felt, spec, run, taken)));
  return kDone;
}

void addDeviceOptions(Command& command, SimulateOptions& options) {
  SceneOptions& scene = options.scene;
  const DeviceModel usual;
  const std::string unless = " A workspace's own value holds unless this is given.";
  addSetting(command, scene, "--mass", "device.mass", "KG", "Mass of the device [kg]." + unless,
             formatNumber(usual.mass));
  addSetting(command, scene, "--device-damping", "device.damping", "B",
             "Viscous damping of the device [N s/m].", formatNumber(usual.damping));
  addSetting(command, scene, "--coulomb", "device.coulomb", "N", "Dry friction of the device [N].",
             formatNumber(usual.coulomb));
  addSetting(command, scene, "--encoder-step", "device.encoder", "LENGTH",
             "Resolution of its position [m]; 0 = exact.", formatNumber(usual.encoder_step));
  addSetting(command, scene, "--rate", "device.rate", "HZ", "Rate of the loop [Hz].",
             formatNumber(usual.rate));
  addSetting(command, scene, "--delay", "device.delay", "N",
             "Samples between reading the tip and applying the force.",
             std::to_string(usual.delay));
  SimulationSpec& spec = options.spec;
  addValue(command, "--saturation", "N", "Largest force of the device [N].", "", 1e-6, 1e6,
           [&](double value) { spec.saturation = value; });
  command.arguments.push_back(
      {"--jitter", "SHARE",
       "Period of each tick: uniform within this share about T, or in a range "
       "such as 0.5-2ms.",
       "", false, false,
       [&options](const std::string& text) { options.jitter = parseJitter(text); }});
  command.arguments.push_back(
      {"--seed", "N", "Of the jitter.", "1", false, false, [&spec](const std::string& text) {
         const auto value = parseNumber(text);
         if (!value || !(*value >= 0 && *value < 4294967296.0) || *value != std::floor(*value))
           throw Error("'" + text + "' is not a whole number of 0 or more");
         spec.seed = static_cast<unsigned>(*value);
       }});
}

void addHandOptions(Command& command, SimulateOptions& options) {
  HandModel& hand = options.spec.hand;
  addValue(command, "--hand-mass", "KG", "Mass that the hand adds [kg].", "0", 0, 100,
           [&](double value) { hand.mass = value; });
  addValue(command, "--hand-damping", "B", "Damping that the hand adds [N s/m].", "0", 0, 1e4,
           [&](double value) { hand.damping = value; });
  addValue(command, "--hand-stiffness", "K", "Spring of the hand to where the tip starts [N/m].",
           "0", 0, 1e6, [&](double value) { hand.stiffness = value; });
  addValue(command, "--press", "N",
           "Constant force into the surface [N]; 1 where neither depth, gap nor speed is given.",
           "0", 0, 1000, [&](double value) { options.press = value; });
  addValue(
      command, "--start-depth", "LENGTH", "The tip starts so deep [m].", "0", 0, 1,
      [&](double value) { options.depth = value; }, true);
  addValue(
      command, "--start-gap", "LENGTH", "The tip starts so far out [m].", "0", 0, 1,
      [&](double value) { options.gap = value; }, true);
  addValue(command, "--start-speed", "V", "Speed into the surface at the start [m/s].", "0", 0, 100,
           [&](double value) { options.speed = value; });
  addValue(command, "--seconds", "S", "Simulated time [s].", "8", 3, 1e5,
           [&](double value) { options.spec.seconds = value; });
}

} // namespace

Command simulateCommand() {
  auto options = std::make_shared<SimulateOptions>();
  SceneOptions& scene = options->scene;
  const HapticProperties usual;
  Command command;
  command.name = "simulate";
  command.summary = "closed loop with a simulated device: does it settle?";
  command.description =
      "Servo, device and hand in simulated time, the device moved exactly between two samples. On "
      "the plane z = 0 (--plane) or on a model; there the tip starts where a vertical line through "
      "the middle of the top (+z) of its box meets the surface, and is pressed along the inward "
      "normal. The device's axes, each with its own dry friction and encoder, are that normal and "
      "two across.\n"
      "Settled means: the rms velocity of the last second is below 0.9 times that of the second "
      "second, or below 1e-8 m/s. A loop that does not settle is a result, not an error.\n"
      "--stabiliser auto leaves everything out where the limit K* is twice the stiffness or more; "
      "else it ties the tip to the contact point by a coupling as stiff as the device bears. "
      "Relief and "
      "roughness that are stiffer along the surface than half of it are tied likewise. naive "
      "limits the change of the force a tick to (2b/T)|dx| and is there to show that this makes "
      "matters worse. On the plane the force has no limit unless --force-limit or --saturation "
      "sets "
      "one.\n"
      "JSON: stable (the last second's rms velocity is below 0.9 times the second second's, or "
      "below 1e-8 m/s), "
      "verdict (at rest, calming down, does not settle, left the surface), rms_velocity [m/s], "
      "max_depth [m], max_force [N], energy_absorbed [J] (by the "
      "surface; exact), energy_credited (with what the device's damping takes), "
      "energy_absorbed_min "
      "and energy_credited_min (the least of each), predicted_limit [N/m] (K* of the loop without "
      "stabilisers), rule_of_thumb [N/m], stiffness, stiffness_displayed, coupling_stiffness, "
      "coupling_damping, lateral_stiffness, lateral_damping, restitution (null where there is "
      "none), stages, ticks, contact_ticks, fault_ticks, press [N], wall_seconds.";
  command.examples = {
      "patina simulate --plane --stiffness 1e5 --delay 1 --press 1",
      "patina simulate --plane --stiffness 3000 --stabiliser none --start-speed 0.2 -o run.csv",
      "patina simulate workspace --mass 0.2 --device-damping 1 --json"};
  command.input("INPUT", "Mesh (.obj .ply .stl), workspace or volume (.vti).", options->input)
      .required = false;
  command.flag("--plane", "The exact plane z = 0 in place of a model.", options->plane);
  command.file("-o,--output", "RUN.csv", "One row a tick: position, velocity, force, energy.",
               options->output);
  addSetting(command, scene, "--stiffness", "stiffness", "K", "Spring of the surface [N/m].",
             formatNumber(usual.stiffness));
  addSetting(command, scene, "--virtual-damping", "damping", "B",
             "Damper of the surface [N s/m], on the backward difference of position.", "");
  addSetting(command, scene, "--damping-cutoff", "damping.cutoff", "HZ",
             "Low-pass of the velocity that the damper sees [Hz].", "");
  addSetting(command, scene, "--force-limit", "force.limit", "N", "Largest force of the servo [N].",
             "");
  command.arguments.back().set = [set = command.arguments.back().set,
                                  options](const std::string& text) {
    set(text);
    options->limited = true;
  };
  command.arguments.push_back({"--stabiliser", "auto|none|coupling|passivity|naive",
                               "Safety net; coupling,passivity is both.", "auto", false, false,
                               [options](const std::string& text) {
                                 options->naive = text == "naive";
                                 if (options->naive) return;
                                 Scene trial;
                                 try {
                                   setValue(trial, "stabiliser", text);
                                 } catch (const Error&) {
                                   throw Error("'" + text +
                                               "': it must be auto, none, coupling, passivity, "
                                               "coupling,passivity or naive");
                                 }
                                 options->scene.settings.emplace_back("stabiliser", text);
                               }});
  addDeviceOptions(command, *options);
  addHandOptions(command, *options);
  addFieldOptions(command, scene);
  addSamplerOption(command, scene);
  addOpenOptions(command, scene.open);
  command.run = [options](Console& console) { return runSimulate(*options, console); };
  return command;
}

} // namespace patina::cli
