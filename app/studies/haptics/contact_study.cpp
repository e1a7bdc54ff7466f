#include "app/studies/framework/studies.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <utility>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"
#include "app/studies/framework/query_timing.h"
#include "app/studies/framework/study.h"
#include "app/studies/haptics/contact_test_path.h"
#include "core/percentiles.h"

namespace patina {
namespace {

// Contact on shapes with several normals, proxy and ray in one row: force against the proxy on the
// exact distance (P01), violations, and time.

struct Shape {
  const char* about;
  const char* scene;
  bool plane = true; // plane faces: the field rounds only creases
};
constexpr Shape kShapes[] = {{"inner corner, 2 planes", "L"},
                             {"inner corner, 3 planes", "room"},
                             {"outer edges", "box"},
                             {"bar of 4 mm radius", "bar", false},
                             {"V-groove", "groove"},
                             {"plate of 1 mm", "plate1"},
                             {"two spheres united", "spheres", false},
                             {"scan with holes", "scan", false}};

// A recorded tip of a trial, to be replayed without the oracle.
struct Step {
  Vec3 tip = Vec3::Zero();
  bool fresh = false; // first of a touch
};
using Way = std::vector<Step>;

// Keeps a reference to `way`.
ContactMethod recorded(ContactMethod method, Way& way) {
  const auto fresh = std::make_shared<bool>(true);
  method.tick = [&way, fresh, feel = method.tick](const Vec3& tip, double dt) {
    way.push_back({tip, *fresh});
    *fresh = false;
    return feel(tip, dt);
  };
  method.forget = [fresh, forget = method.forget] {
    *fresh = true;
    forget();
  };
  return method;
}

// Minimum time of each tick over all passes [ns]; infinite out of contact.
using TickTimes = std::vector<double>;

void timePass(const HapticSnapshot& snapshot, const Way& way, TickTimes& times) {
  using Clock = std::chrono::steady_clock;
  times.resize(way.size(), std::numeric_limits<double>::infinity());
  ContactMemory memory;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (way[i].fresh) memory.reset();
    const auto start = Clock::now();
    const Contact contact = tick(snapshot, memory, way[i].tip, kTick);
    const std::chrono::duration<double, std::nano> taken = Clock::now() - start;
    if (contact.touching) times[i] = std::min(times[i], taken.count());
  }
}

Percentiles inContact(TickTimes times) {
  std::erase(times, std::numeric_limits<double>::infinity());
  return percentiles(std::move(times));
}

struct CheckedMethod {
  TrialReport trials;
  double generated_energy = 0; // [J], worst loop
  Percentiles ns;
};

// All columns but p99, p99.9 and median time, which the proxy has already.
void addColumns(WorkPrecisionRow& row, const std::string& method, const CheckedMethod& checked) {
  const TrialReport& trials = checked.trials;
  const auto contacts = static_cast<double>(std::max(1L, trials.contacts));
  const double samples = std::accumulate(trials.samples.begin(), trials.samples.end(), 0.0);
  const std::pair<const char*, double> columns[] = {
      {"p50 [N]", percentiles(trials.error).p50},
      {"snaps [%]", 100 * static_cast<double>(trials.relocations) / contacts},
      {"p99 of snaps [N]", percentiles(trials.relocation_error).p99},
      {"lost ticks", static_cast<double>(trials.lost)},
      {"pulling ticks", static_cast<double>(trials.pulls)},
      {"fault ticks", static_cast<double>(trials.faults)},
      {"step excess [N]", trials.worst_excess},
      {"worst loop [J]", checked.generated_energy},
      {"samples", samples / contacts},
      {"most samples", percentiles(trials.samples).max},
      {"p99 [ns]", checked.ns.p99},
      {"p99.9 [ns]", checked.ns.p999}};
  for (const auto& [name, value] : columns) row.more.emplace_back(method + name, value);
}

// Rows by shape, grid and tip at 500 N/m. `error` is the proxy's 99th percentile over contact
// ticks, `error_max` the 99.9th, without relocations; ns is the median of its tick. Columns of the
// ray begin with "ray". The order is that of the 99th percentile over the shapes with plane faces.
WorkPrecisionTable contactOnShapes(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table{"contact",
                           "Any shape: error against the exact proxy (P01), p99 and p99.9; ray "
                           "beside proxy; order 1 where all faces are plane",
                           "N",
                           {},
                           std::nullopt,
                           std::nullopt};
  const int length = options.thorough ? 10 : 1;
  const long ticks = options.quick ? 300 : 3000L * length;
  const int loops = options.quick ? 5 : 50 * length, passes = options.quick ? 2 : 5;
  const std::vector<int> resolutions = options.quick ? std::vector{75} : std::vector{75, 150, 300};
  OrderFit order;
  for (const int resolution : resolutions) {
    std::vector<double> errors;
    for (const Shape& shape : kShapes) {
      const ContactScene scene = contactScene(shape.scene);
      const ExactSurface surface(scene.meshes);
      for (const double iso : {0.0, 1e-3}) {
        if (std::find(scene.isos.begin(), scene.isos.end(), iso) == scene.isos.end()) continue;
        progress.throwIfCancelled();
        const auto field = contactField(scene, iso, resolution);
        const unsigned seed = trialSeed(scene, iso, 1);
        const std::array snapshots = {contactSnapshot(field, iso, "proxy"),
                                      contactSnapshot(field, iso, "ray")};
        std::array<CheckedMethod, 2> checked;
        std::array<TickTimes, 2> times;
        Way way; // the proxy trial's tips, on which both methods are timed
        for (std::size_t m = 0; m < 2; ++m) {
          const ContactMethod method = methodOf(*snapshots[m]);
          checked[m].trials =
              runTrials(m == 0 ? recorded(method, way) : method, surface, iso, ticks, seed);
          checked[m].generated_energy =
              runLoops(method, surface, iso, loops, seed + 1000).generated_energy;
        }
        for (int pass = 0; pass < passes; ++pass)
          for (std::size_t m = 0; m < 2; ++m) timePass(*snapshots[m], way, times[m]);
        for (std::size_t m = 0; m < 2; ++m) checked[m].ns = inContact(times[m]);

        const auto& [proxy, ray] = checked;
        const Percentiles error = percentiles(proxy.trials.error);
        const Percentiles ray_error = percentiles(ray.trials.error);
        if (shape.plane)
          errors.insert(errors.end(), proxy.trials.error.begin(), proxy.trials.error.end());
        WorkPrecisionRow row;
        row.settings = {
            {"shape", shape.about}, {"resolution", resolution}, {"tip [mm]", 1e3 * iso}};
        row.error = error.p99;
        row.error_max = error.p999;
        row.ns = proxy.ns.p50;
        row.bytes = static_cast<double>(field->bytes());
        addColumns(row, "", proxy);
        row.more.emplace_back("ray p99 [N]", ray_error.p99);
        row.more.emplace_back("ray p99.9 [N]", ray_error.p999);
        row.more.emplace_back("ray ns", ray.ns.p50);
        addColumns(row, "ray ", ray);
        row.more.emplace_back("ticks in contact", static_cast<double>(proxy.trials.contacts));
        table.rows.push_back(std::move(row));
      }
    }
    order.add(1.0 / resolution, percentiles(errors).p99);
  }
  if (order.voxels.size() > 1) order.into(table, 1);
  return table;
}

constexpr double kRadius = 0.05;    // [m]
constexpr double kTipRadius = 0.02; // in sphere radii

using Method = HapticProperties::Contact;
constexpr Method kMethods[] = {Method::proxy, Method::ray};

std::string nameOf(Method method) {
  return method == Method::proxy ? "proxy" : "ray";
}

struct Surface {
  std::string name; // "analytic" or the number of triangles
  std::shared_ptr<const SurfaceField> field;
};

WorkPrecisionRow rowOf(const Surface& surface, const ContactTestSpec& spec, int repeats) {
  const ContactTest test = makeContactTest(spec);
  const auto snapshot = compileStages(contactTestScene(spec), surface.field);
  const ContactTestErrors errors = contactTestErrors(*snapshot, test);
  const ContactTestTiming timing = contactTestTiming(*snapshot, test, repeats);
  WorkPrecisionRow row;
  row.settings = {{"contact", nameOf(spec.contact)},
                  {"surface", surface.name},
                  {"sampler", std::string(name(spec.sampler))},
                  {"tip radius [R]", spec.tip_radius}};
  row.error = errors.direction_mean;
  row.error_max = errors.direction_max;
  row.ns = timing.p50;
  row.bytes = static_cast<double>(surface.field->bytes());
  row.more = {{"p99 [ns]", timing.p99},
              {"clock [ns]", timing.clock},
              {"magnitude mean [%]", errors.magnitude_mean},
              {"magnitude max [%]", errors.magnitude_max},
              {"jump rms [N]", errors.jump_rms},
              {"lost ticks", errors.lost}};
  if (spec.friction) row.more.emplace_back("Coulomb ratio", errors.coulomb_ratio);
  return row;
}

WorkPrecisionTable frictionless(const std::vector<Surface>& surfaces, int repeats) {
  WorkPrecisionTable table = tableOf("Contact without friction: direction, mean and max", "deg");
  for (const Method method : kMethods)
    for (const Surface& surface : surfaces)
      for (const Sampler sampler : {Sampler::kim, Sampler::high})
        for (const double tip : {0.0, kTipRadius})
          table.rows.push_back(
              rowOf(surface, {.tip_radius = tip, .sampler = sampler, .contact = method}, repeats));
  return table;
}

WorkPrecisionTable withFriction(const std::vector<Surface>& surfaces, int repeats) {
  WorkPrecisionTable table =
      tableOf("Contact with friction 0.5 / 0.3: direction, mean and max", "deg");
  using Slip = Friction::SlipDirection;
  for (const Method method : kMethods)
    for (const Surface& surface : surfaces)
      for (const Slip slip : {Slip::paper, Slip::displacement})
        for (const double tip : {0.0, kTipRadius}) {
          WorkPrecisionRow row =
              rowOf(surface, {.tip_radius = tip, .friction = true, .slip = slip, .contact = method},
                    repeats);
          row.settings.emplace_back("slip", slip == Slip::paper ? "paper" : "displacement");
          table.rows.push_back(std::move(row));
        }
  return table;
}

WorkPrecisionTable cracks(int frequency, int repeats, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Every triangle shrunk (cracks): direction, mean and max", "deg");
  for (const double crack : {0.0, 1e-4, 1e-3, 1e-2}) {
    Progress build;
    progress.throwIfCancelled();
    const Surface surface{std::to_string(20 * frequency * frequency),
                          meshSphere(kRadius, frequency, crack, build)};
    for (const Method method : kMethods) {
      WorkPrecisionRow row = rowOf(surface, {.contact = method}, repeats);
      row.settings.emplace_back("shrunk by", crack);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// K = 50 / R and depths proportional to R: the force must be equal at every size.
WorkPrecisionTable scales(int repeats) {
  WorkPrecisionTable table =
      tableOf("The same test from 0.05 to 10 m: force against R = 0.05 m, mean and max", "1");
  std::vector<Vec3> reference;
  const auto add = [&](double radius, Method method) {
    const ContactTestSpec spec{.radius = radius, .tip_radius = kTipRadius, .contact = method};
    const auto field = analyticSphere(radius);
    const auto snapshot = compileStages(contactTestScene(spec), field);
    const ContactTest test = makeContactTest(spec);
    const std::vector<Vec3> force = contactTestErrors(*snapshot, test).force;
    if (reference.empty()) reference = force;
    WorkPrecisionRow row;
    row.settings = {{"contact", nameOf(method)}, {"R [m]", radius}};
    for (std::size_t i = 0; i < force.size(); ++i) {
      const double relative = (force[i] - reference[i]).norm() / reference[i].norm();
      row.error += relative / static_cast<double>(force.size());
      row.error_max = std::max(row.error_max, relative);
    }
    row.ns = contactTestTiming(*snapshot, test, repeats).p50;
    row.bytes = static_cast<double>(field->bytes());
    table.rows.push_back(std::move(row));
  };
  for (const Method method : kMethods) {
    reference.clear();
    for (const double radius : {0.05, 0.2, 1.0, 10.0}) add(radius, method);
  }
  return table;
}

// T-K06b: tips 1 to 4 mm deep in a sphere of radius 30 mm; contact point and nearest surface point.
constexpr double kBall = 0.03;    // radius [m]
constexpr double kDeepest = 4e-3; // [m]

WorkPrecisionRow vcpRow(const std::shared_ptr<const SurfaceField>& field, Sampler sampler,
                        Method method) {
  Scene scene;
  scene.sampler = sampler;
  scene.haptics.contact = method;
  const auto snapshot = compileStages(scene, field);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> depth(1e-3, kDeepest);
  const int count = 4000;
  std::vector<Vec3> tips;
  for (int i = 0; i < count; ++i) {
    const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
    tips.push_back((kBall - depth(random)) * n);
  }
  const auto touch = [&](const Vec3& tip) {
    ContactMemory memory;
    return tick(*snapshot, memory, tip, kContactTestPeriod);
  };
  WorkPrecisionRow row;
  double samples = 0;
  for (const Vec3& tip : tips) {
    const Contact contact = touch(tip);
    const double error = (contact.vcp - kBall * tip.normalized()).norm();
    row.error += error * error / count;
    row.error_max = std::max(row.error_max, error);
    samples += contact.samples;
  }
  row.error = std::sqrt(row.error);
  row.ns = nsPerQuery(tips, [&](const Vec3& tip) { return touch(tip).depth; });
  row.bytes = static_cast<double>(field->bytes());
  row.more = {{"field samples a tick", samples / count}};
  return row;
}

WorkPrecisionTable vcpOrder(const std::vector<int>& resolutions, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("contact point on a sphere (T-K06b), rms and max; order 2 with kim and ray", "m");
  OrderFit order;
  for (const int resolution : resolutions) {
    progress.throwIfCancelled();
    // No tip is below the band, where directions come from nodes 8 voxels apart.
    const double deepest = resolution * kDeepest / (2 * kBall); // [voxels]
    const auto field = analyticSphere(kBall, resolution, std::max(8.0, deepest + 3));
    for (const Method method : kMethods)
      for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
        WorkPrecisionRow row = vcpRow(field, sampler, method);
        row.settings = {{"resolution", resolution},
                        {"contact", nameOf(method)},
                        {"sampler", std::string(name(sampler))}};
        if (method == Method::ray && sampler == Sampler::kim)
          order.add(field->grid.voxel, row.error);
        table.rows.push_back(std::move(row));
      }
  }
  order.into(table, 2);
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> contactStudy(const StudyOptions& options, Progress& progress) {
  const int repeats = options.quick ? 2 : 7;
  std::vector<Surface> surfaces = {{"analytic", analyticSphere(kRadius)}};
  for (const int frequency : options.quick ? std::vector{22} : std::vector{7, 22, 71, 224}) {
    progress.throwIfCancelled();
    const std::string triangles = std::to_string(20 * frequency * frequency);
    progress.report(0.01 * static_cast<double>(surfaces.size()),
                    "sphere of " + triangles + " triangles");
    Progress build;
    surfaces.push_back({triangles, meshSphere(kRadius, frequency, 0, build)});
  }
  const std::vector<int> grids =
      options.quick ? std::vector{48, 96} : std::vector{48, 72, 104, 150, 200};
  return tablesOf(
      {{0.05, "contact without friction", [&] { return frictionless(surfaces, repeats); }},
       {0.1, "contact with friction", [&] { return withFriction(surfaces, repeats); }},
       {0.2, "cracks", [&] { return cracks(options.quick ? 22 : 71, repeats, progress); }},
       {0.3, "scale", [&] { return scales(repeats); }},
       {0.35, "order of the contact point", [&] { return vcpOrder(grids, progress); }},
       {0.4, "contact on any shape", [&] { return contactOnShapes(options, progress); }}},
      progress);
}

} // namespace patina
