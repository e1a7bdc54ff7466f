#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/tree/triangle_tree.h"
#include "haptics/law/plane.h"
#include "haptics/simulation/simulation.h"
#include "session/open/session.h"

namespace patina::cli {
namespace {

// Start of a simulated tip on a model.
struct SimulationStart {
  Vec3 surface = Vec3::Zero(); // [m], world: first contact of the tip's centre
  Vec3 inward = Vec3::Zero();  // unit
};

constexpr int kNewtonSteps = 20;
constexpr double kLeastGradient = 0.1;

// Point below the middle of the top (+z) of the model's box or, over a hole such as a ring's, the
// model's nearest point to that middle. Includes offset and tip radius. Throws Error if the field
// has no gradient there.
SimulationStart simulationStart(const CompiledScene& compiled) {
  const TriangleMesh& mesh = *compiled.mesh;
  const Box3 box = bounds(mesh);
  const double height = box.sizes().norm();
  const Vec3 above(box.center().x(), box.center().y(), box.max().z() + 0.01 * height);
  const TriangleTree tree(mesh);
  const std::optional<RayHit> hit = tree.firstHit(above, -Vec3::UnitZ(), 2 * height);
  const Vec3 foot = hit ? Vec3(above - hit->t * Vec3::UnitZ()) : tree.closestPoint(above).point;

  const HapticProperties& haptics = compiled.scene.haptics;
  const double iso = haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
  // The field of a two-sided sheet has no gradient on the sheet itself.
  Vec3 p = foot + iso * (above - foot).normalized();
  const FieldSampler sampler(*compiled.built.field, compiled.scene.sampler);
  Vec3 direction = Vec3::Zero();
  for (int i = 0; i < kNewtonSteps; ++i) {
    const GridSample sample = sampler.at(p);
    const double length = sample.gradient.norm();
    if (!(length > kLeastGradient))
      throw Error("there is no direction at the start of the run, below the middle of the top; "
                  "raise --resolution or --band");
    direction = sample.gradient / length;
    p -= (sample.phi - iso) / length * direction;
  }
  return {p, -direction};
}

constexpr double kDefaultPress = 1; // [N], if nothing else moves the tip

// Parses "0.3", a fraction of the period to both sides, or "0.5-2ms" or "0.0005-0.002", a range.
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
  std::optional<double> depth, gap, speed, press;
  Jitter jitter;
  SimulationSpec spec;
};

struct LawOutput {
  Scene scene;
  std::shared_ptr<const HapticSnapshot> snapshot;
  std::shared_ptr<const CompiledScene> compiled; // keeps a model's field alive; null for the plane
  SimulationStart start{Vec3::Zero(), -Vec3::UnitZ()};
};

LawOutput hapticBy(const SimulateOptions& options, Console& console) {
  LawOutput felt;
  if (options.plane) {
    console.warnOfNoEffect(
        {"--resolution", "--voxel", "--band", "--sampler", "--unit", "--up", "--iso", "--texture"},
        "with --plane");
    applySettings(felt.scene, options.scene.settings);
    // A force limit would hide the limit of the loop.
    const bool limited = std::ranges::any_of(
        options.scene.settings, [](const auto& setting) { return setting.first == "force.limit"; });
    if (!limited) felt.scene.haptics.force_limit = std::numeric_limits<double>::infinity();
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

SimulationSpec specFor(const SimulateOptions& options, const LawOutput& felt) {
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
  if (options.naive) spec.rate_limit = 2 * spec.device.damping * spec.device.rate;
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

const Keys kSimulateKeys = {
    {"verdict", "", "verdict", "at rest, calming down, does not settle, left the surface"},
    {"stable", "", "stable",
     "the rms velocity of the last second is below 0.9 times that of the second second, or below "
     "1e-8 m/s",
     Shown::never},
    {"rms_velocity", "m/s", "rms velocity", "of the last second", Shown::never},
    {"predicted_limit", "N/m", "predicted limit", "K* of the loop without stabilisers"},
    {"rule_of_thumb", "N/m", "rule of thumb", "", Shown::never},
    {"stiffness", "N/m", "stiffness"},
    {"stiffness_displayed", "N/m", "displayed stiffness",
     "null where there is none, as of the couplings and restitution", Shown::never},
    {"stages", "", "stages"},
    {"coupling_stiffness", "N/m", "coupling", "", Shown::if_any},
    {"coupling_damping", "N s/m", "coupling damping", "", Shown::never},
    {"lateral_stiffness", "N/m", "lateral coupling", "", Shown::if_any},
    {"lateral_damping", "N s/m", "lateral damping", "", Shown::never},
    {"restitution", "", "restitution", "", Shown::if_any},
    {"max_depth", "m", "largest depth"},
    {"max_force", "N", "largest force"},
    {"energy_absorbed", "J", "energy absorbed", "by the surface; exact"},
    {"energy_credited", "J", "energy credited", "with what the device's damping takes",
     Shown::never},
    {"energy_absorbed_min", "J", "least energy absorbed", "", Shown::never},
    {"energy_credited_min", "J", "least energy credited", "", Shown::never},
    {"ticks", "", "ticks", "", Shown::never},
    {"contact_ticks", "", "ticks in contact", "", Shown::never},
    {"fault_ticks", "", "faults", "ticks faded by a force jump", Shown::if_any},
    {"press", "N", "press", "", Shown::never},
    {"wall_seconds", "s", "time", "that the run took"}};

void setCoupling(const std::string& which, const auto& coupling, const std::string& why,
                 Report& report) {
  const Json stiffness = coupling ? Json(coupling->stiffness) : Json();
  const Json damping = coupling ? Json(coupling->damping) : Json();
  report.set(which + "_stiffness", stiffness,
             shown(stiffness, "N/m") + ", " + shown(damping, "N s/m") + " (" + why + ")");
  report.set(which + "_damping", damping);
}

Report reportOf(const LawOutput& felt, const SimulationSpec& spec, const SimulationReport& run,
                double seconds_taken) {
  const SampledLoop loop = sceneLoop(felt.scene.haptics, spec.device, spec.hand);
  const StabiliserPlan& plan = felt.snapshot->stabilisers;
  const double stiffness = felt.scene.haptics.stiffness;
  const auto& displayed = run.stiffness_displayed;
  Report report(kSimulateKeys);
  report.set("verdict", name(run.verdict),
             std::string(name(run.verdict)) + ": rms velocity " + inScience(run.rms_velocity) +
                 " m/s in the last second, " + inScience(run.rms_early) + " in the second one");
  report.set("stable", run.stable).set("rms_velocity", run.rms_velocity);
  report.set("predicted_limit", stiffnessLimit(loop),
             rounded(stiffnessLimit(loop)) + " N/m of this loop without stabilisers (" +
                 rounded(linearStabilityLimit(loop)) + " by the rule of thumb)");
  report.set("rule_of_thumb", linearStabilityLimit(loop));
  report.set("stiffness", stiffness,
             rounded(stiffness) + " N/m asked" +
                 (displayed ? ", " + rounded(*displayed) + " N/m displayed" : ""));
  report.set("stiffness_displayed", orNull(displayed));
  report.set("stages", jsonOf(namesIn(felt.snapshot->why, &StageInfo::name)));
  setCoupling("coupling", plan.coupling, plan.why, report);
  setCoupling("lateral", plan.lateral, plan.lateral_why, report);
  report.set("restitution", orNull(run.restitution));
  report.set("max_depth", run.max_depth).set("max_force", run.max_force);
  report.set("energy_absorbed", run.energy.absorbed,
             inScience(run.energy.absorbed) + " J by the surface, " +
                 inScience(run.energy.absorbed_with_damping) + " J with the device's damping");
  report.set("energy_credited", run.energy.absorbed_with_damping);
  report.set("energy_absorbed_min", run.energy.lowest_absorbed);
  report.set("energy_credited_min", run.energy.lowest_absorbed_with_damping);
  report.set("ticks", static_cast<std::size_t>(run.ticks));
  report.set("contact_ticks", static_cast<std::size_t>(run.contact_ticks));
  report.set("fault_ticks", static_cast<std::size_t>(run.fault_ticks),
             formatCount(run.fault_ticks) + " ticks faded by a force jump");
  report.set("press", spec.press);
  report.set("wall_seconds", seconds_taken,
             rounded(spec.seconds) + " s simulated in " + rounded(seconds_taken) + " s");
  return report;
}

// Advises options that would keep the tip on the surface and are not set.
void warnOfLeaving(const SimulateOptions& options, const SimulationSpec& spec,
                   const SimulationReport& run, Console& console) {
  if (run.contact_ticks == 0) {
    console.warn("simulate: the tip never touches the surface");
    return;
  }
  if (run.verdict != Verdict::kLeftSurface) return;
  std::string advice;
  if (spec.hand.stiffness == 0) advice = "; --hand-stiffness 200 holds it about its start";
  if (spec.press == 0) advice += "; --press 1 keeps it on the surface";
  console.warn(std::string("simulate: the tip ") +
               (options.plane ? "bounced off the plane" : "slid or was thrown off the model") +
               advice);
}

int runSimulate(const SimulateOptions& options, Console& console) {
  if (options.plane && !options.input.empty())
    throw Error("simulate: give " + options.input.string() + " or --plane, not both");
  if (!options.plane && options.input.empty())
    throw Error("simulate: give a workspace, a mesh or --plane");
  if (!options.output.empty()) requireWritable(options.output, {options.input}, FileKind::table);
  const LawOutput felt = hapticBy(options, console);
  const SimulationSpec spec = specFor(options, felt);

  RunTable table;
  RowSink sink;
  if (!options.output.empty()) sink = [&](const SimulationRow& row) { table.add(row); };
  const auto start = std::chrono::steady_clock::now();
  const SimulationReport run = simulate(*felt.snapshot, spec, console.progress(), sink);
  const double taken =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.output.empty()) writeCsv(options.output, table.table());
  warnOfLeaving(options, spec, run, console);
  return console.report(reportOf(felt, spec, run, taken));
}

void addDeviceOptions(Command& command, SimulateOptions& options) {
  const DeviceModel usual;
  addSettings(
      command, options.scene,
      {{"device.mass", "KG",
        "Mass of the device. A workspace's own value holds unless this is given.",
        formatNumber(usual.mass), "--mass"},
       {"device.damping", "B", "Viscous damping of the device.", formatNumber(usual.damping)},
       {"device.coulomb", "N", "Dry friction of the device.", formatNumber(usual.coulomb),
        "--coulomb"},
       {"device.encoder", "LENGTH", "Resolution of its position; 0 = exact.",
        formatNumber(usual.encoder_step), "--encoder-step"},
       {"device.rate", "HZ", "Rate of the loop.", formatNumber(usual.rate), "--rate"},
       {"device.delay", "N", "Samples between reading the tip and applying the force.",
        std::to_string(usual.delay), "--delay"}});
  SimulationSpec& spec = options.spec;
  const Argument more[] = {
      {"--saturation", "N", "N", "", "Largest force of the device.",
       numberInto(1e-6, 1e6, spec.saturation)},
      {"--jitter", "SHARE", "", "",
       "Period of each tick: uniform within this share about T, or in a range such as 0.5-2ms.",
       parsedInto(options.jitter, parseJitter)},
      {"--seed", "N", "", "1", "Of the jitter.",
       numberInto(0, 4294967295.0, spec.seed, NumberKind::whole)}};
  command.arguments.insert(command.arguments.end(), std::begin(more), std::end(more));
}

void addHandOptions(Command& command, SimulateOptions& options) {
  HandModel& hand = options.spec.hand;
  const Argument list[] = {
      {"--hand-mass", "KG", "kg", "0", "Mass that the hand adds.", numberInto(0, 100, hand.mass)},
      {"--hand-damping", "B", "N s/m", "0", "Damping that the hand adds.",
       numberInto(0, 1e4, hand.damping)},
      {"--hand-stiffness", "K", "N/m", "0", "Spring of the hand to where the tip starts.",
       numberInto(0, 1e6, hand.stiffness)},
      {"--press", "N", "N", "0",
       "Constant force into the surface; 1 where neither depth, gap nor speed is given.",
       numberInto(0, 1000, options.press)},
      {"--start-depth", "LENGTH", "m", "0", "The tip starts so deep.",
       numberInto(0, 1, options.depth, NumberKind::length)},
      {"--start-gap", "LENGTH", "m", "0", "The tip starts so far out.",
       numberInto(0, 1, options.gap, NumberKind::length)},
      {"--start-speed", "V", "m/s", "0", "Speed into the surface at the start.",
       numberInto(0, 100, options.speed)},
      {"--seconds", "S", "s", "8", "Simulated time.", numberInto(3, 1e5, options.spec.seconds)}};
  command.arguments.insert(command.arguments.end(), std::begin(list), std::end(list));
}

void setStabiliser(SimulateOptions& options, const std::string& text) {
  options.naive = text == "naive";
  if (options.naive) return;
  Scene trial;
  try {
    setValue(trial, "stabiliser", text);
  } catch (const Error&) {
    throw Error("'" + text +
                "': it must be auto, none, coupling, passivity, coupling,passivity or naive");
  }
  options.scene.settings.emplace_back("stabiliser", text);
}

} // namespace

Command simulateCommand() {
  auto options = std::make_shared<SimulateOptions>();
  SceneOptions& scene = options->scene;
  Command command{
      .name = "simulate",
      .summary = "closed loop with a simulated device: does it settle?",
      .description =
          "Servo, device and hand in simulated time, the device moved exactly between two samples. "
          "On the plane z = 0 (--plane) or on a model; there the tip starts where a vertical line "
          "through the middle of the top (+z) of its box meets the surface, and is pressed along "
          "the inward normal. The device's axes, each with its own dry friction and encoder, are "
          "that normal and two across.\n"
          "Settled means: the rms velocity of the last second is below 0.9 times that of the "
          "second second, or below 1e-8 m/s. A loop that does not settle is a result, not an "
          "error.\n"
          "--stabiliser auto leaves everything out where the limit K* is twice the stiffness or "
          "more; otherwise it adds a virtual coupling between tip and contact point, as stiff as "
          "is stable on the device, also along the surface if relief and roughness are stiffer "
          "than half of it. naive limits the change of the force per tick to (2b/T)|dx|, to show "
          "that this makes the loop less stable. On the plane the force has no limit unless "
          "--force-limit or --saturation sets one.",
      .examples =
          {"patina simulate --plane --stiffness 1e5 --delay 1 --press 1",
           "patina simulate --plane --stiffness 3000 --stabiliser none --start-speed 0.2 -o "
           "run.csv",
           "patina simulate workspace --mass 0.2 --device-damping 1 --json"},
      .keys = kSimulateKeys,
      .arguments = {sceneInput(options->input),
                    {"--plane", "", "", "", "The exact plane z = 0 in place of a model.",
                     into(options->plane)},
                    writtenTo(options->output, "-o,--output", "RUN.csv",
                              "One row a tick: position, velocity, force, energy.")},
      .run = [options](Console& console) { return runSimulate(*options, console); }};
  command.arguments.front().times = Times::at_most_once;
  addSettings(command, scene,
              {{"stiffness", "K", "Spring of the surface."},
               {"damping", "B", "Damper of the surface, on the backward difference of position.",
                "", "--virtual-damping"},
               {"damping.cutoff", "HZ", "Low-pass of the velocity that the damper sees."},
               {"force.limit", "N", "Largest force of the servo.", ""}});
  command.arguments.push_back(
      {"--stabiliser", "auto|none|coupling|passivity|naive", "", "auto",
       "Safety net; coupling,passivity is both.",
       [options](const std::string& text) { setStabiliser(*options, text); }});
  addDeviceOptions(command, *options);
  addHandOptions(command, *options);
  addSampledFieldOptions(command, scene);
  return command;
}

} // namespace patina::cli
