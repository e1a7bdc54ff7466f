#include "app/studies/haptics/contact_study.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "app/studies/haptics/contact_on_shapes.h"
#include "app/studies/haptics/contact_test_path.h"
#include "app/studies/query_timing.h"

namespace patina {
namespace {

constexpr double kRadius = 0.05;    // [m]
constexpr double kTipRadius = 0.02; // of it

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
  row.knobs = {{"contact", nameOf(spec.contact)},
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
          row.knobs.emplace_back("slip", slip == Slip::paper ? "paper" : "displacement");
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
      row.knobs.emplace_back("shrunk by", crack);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// K = 50 / R and depths in proportion to R: the force must be the same at every size.
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
    row.knobs = {{"contact", nameOf(method)}, {"R [m]", radius}};
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

// T-K06b: tips 1 to 4 mm deep in a sphere of 30 mm; the VCP against the nearest point.
constexpr double kBall = 0.03;    // [m]
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
      tableOf("VCP on a sphere (T-K06b), rms and max; order 2 with kim and ray", "m");
  OrderFit order;
  for (const int resolution : resolutions) {
    progress.throwIfCancelled();
    // No tip is deeper than the band, where directions come from nodes 8 voxels apart.
    const double deepest = resolution * kDeepest / (2 * kBall); // [voxels]
    const auto field = analyticSphere(kBall, resolution, std::max(8.0, deepest + 3));
    for (const Method method : kMethods)
      for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
        WorkPrecisionRow row = vcpRow(field, sampler, method);
        row.knobs = {{"resolution", resolution},
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
