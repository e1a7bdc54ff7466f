#include "app/studies/framework/studies.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "app/studies/field/study_shapes.h"
#include "app/studies/framework/query_timing.h"
#include "geometry/mesh/shapes.h"
#include "session/compile/compile_scene.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03; // [m]
constexpr double kStiffness = 1000;
constexpr double kPeriod = 1e-3;
constexpr double kReach = 4.2e-3; // deepest point of the loops [m]

using Method = HapticProperties::Contact;
Vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// The band covers all requested values on both sides.
std::shared_ptr<const SurfaceField> sphereField(int resolution) {
  const Box3 box(Vec3::Constant(-kRadius), Vec3::Constant(kRadius));
  FieldSpec spec;
  spec.resolution = resolution;
  spec = widened(spec, box, kReach, kBandBeyondReach);
  return withSamples(std::make_shared<const SurfaceField>(sampleFunction(
      [](const Vec3& p) { return p.norm() - kRadius; }, gridAround(box, spec), spec.band)));
}

// Point i of `count` of a spiral from pole to pole, like a hand's path.
Vec3 spiral(int i, int count, int turns) {
  const double z = 1 - 2 * (i + 0.5) / count, around = 2 * std::numbers::pi * turns * z;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(around), r * std::sin(around), z};
}

Contact touch(const HapticSnapshot& snapshot, const Vec3& tip) {
  ContactMemory memory;
  return tick(snapshot, memory, tip, kPeriod);
}

struct Mode {
  std::string name;
  void (*set)(HapticProperties&);
  double low, high;        // range of tip heights above the sphere [m]
  double (*force)(double); // outward force [N] at that height
};

const std::vector<Mode>& modes() {
  static const std::vector<Mode> all = {
      {"contact", [](HapticProperties&) {}, -2.4e-3, -0.1e-3,
       [](double above) { return -kStiffness * above; }},
      {"offset 1.5 mm", [](HapticProperties& h) { h.offset = 1.5e-3; }, -0.9e-3, 1.4e-3,
       [](double above) { return kStiffness * (1.5e-3 - above); }},
      {"magnet 2.5 mm",
       [](HapticProperties& h) {
         h.magnet = Magnet{2.5e-3, kStiffness, false};
       },
       0.1e-3, 2.4e-3, [](double above) { return -kStiffness * above; }}};
  return all;
}

// T-K12a, T-K13a: the whole force vector on a sphere, for independent tips.
WorkPrecisionRow forceRow(const Mode& mode, const HapticSnapshot& snapshot, int tips) {
  WorkPrecisionRow row;
  std::vector<Vec3> points;
  double magnitude = 0;
  for (int i = 0; i < tips; ++i) {
    const Vec3 n = spiral(i, tips, 2);
    const double up = 0.5 + 0.5 * std::sin(0.013 * i);
    const double above = mode.low + up * (mode.high - mode.low);
    points.push_back((kRadius + above) * n);
    const Vec3 felt = touch(snapshot, points.back()).force;
    const double error = (felt - mode.force(above) * n).norm();
    row.error += error * error / tips;
    row.error_max = std::max(row.error_max, error);
    magnitude = std::max(magnitude, std::abs(felt.norm() - std::abs(mode.force(above))));
  }
  row.error = std::sqrt(row.error);
  row.ns = nsPerQuery(points, [&](const Vec3& tip) { return touch(snapshot, tip).depth; });
  row.more = {{"magnitude max [N]", magnitude}};
  return row;
}

// One row per resolution, contact and sampler; the order is that of ray and kim, as in the paper.
template <class Row>
void addRows(WorkPrecisionTable& table, const std::vector<int>& resolutions, Progress& progress,
             const Row& rowOf) {
  OrderFit order;
  for (const int resolution : resolutions) {
    progress.throwIfCancelled();
    const auto field = sphereField(resolution);
    for (const Method method : {Method::proxy, Method::ray}) {
      for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
        Scene scene;
        scene.sampler = sampler;
        scene.haptics.contact = method;
        scene.haptics.stiffness = kStiffness;
        scene.haptics.force_limit = 100;
        WorkPrecisionRow row = rowOf(std::move(scene), field);
        row.settings = {{"contact", method == Method::proxy ? "proxy" : "ray"},
                        {"resolution", resolution},
                        {"sampler", std::string(name(sampler))}};
        row.bytes = static_cast<double>(field->bytes());
        if (method == Method::ray && sampler == Sampler::kim)
          order.add(field->grid.voxel, row.error);
        table.rows.push_back(std::move(row));
      }
    }
  }
  order.into(table, 2);
}

WorkPrecisionTable force(const Mode& mode, const std::vector<int>& resolutions, int tips,
                         Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Force of " + mode.name + " on a sphere, rms and max; order 2 with ray and kim", "N");
  addRows(table, resolutions, progress, [&](Scene scene, const auto& field) {
    mode.set(scene.haptics);
    return forceRow(mode, *compileStages(scene, field), tips);
  });
  return table;
}

// Energy from the surface.
double loopWork(const HapticSnapshot& snapshot, const Vec3& centre, const Vec3& u, const Vec3& v) {
  constexpr int kCount = 2000;
  constexpr double kLoop = 1.5e-3; // [m]
  ContactMemory memory;
  double work = 0;
  Vec3 last_force = Vec3::Zero(), last_tip = Vec3::Zero();
  for (int i = -kCount; i <= kCount; ++i) { // the first lap settles the contact
    const double angle = 2 * std::numbers::pi * i / kCount;
    const Vec3 tip = centre + kLoop * (std::cos(angle) * u + std::sin(angle) * v);
    const Vec3 force = tick(snapshot, memory, tip, kPeriod).force;
    if (i > 0) work += 0.5 * (force + last_force).dot(tip - last_tip);
    last_force = force;
    last_tip = tip;
  }
  return work;
}

// T-ENER on a sphere: loops of 1.5 mm about a depth of 2.5 mm.
WorkPrecisionTable energy(const std::vector<int>& resolutions, int loops, Progress& progress) {
  WorkPrecisionTable table = tableOf("Work round closed loops (T-ENER), K = 1000 N/m, 2.5 mm deep, "
                                     "rms and max; order 2 with ray and kim",
                                     "J");
  addRows(table, resolutions, progress, [&](const Scene& scene, const auto& field) {
    const auto snapshot = compileStages(scene, field);
    std::mt19937 random(7);
    WorkPrecisionRow row;
    std::vector<Vec3> points;
    double given = 0;
    for (int i = 0; i < loops; ++i) {
      const Vec3 centre = (kRadius - 2.5e-3) * randomDirection(random);
      const Vec3 u = randomDirection(random);
      const double work = loopWork(*snapshot, centre, u, u.unitOrthogonal());
      row.error += work * work / loops;
      row.error_max = std::max(row.error_max, std::abs(work));
      given = std::max(given, work);
      points.push_back(centre);
    }
    row.error = std::sqrt(row.error);
    row.ns = nsPerQuery(points, [&](const Vec3& tip) { return touch(*snapshot, tip).depth; });
    row.more = {{"given at most [J]", given}};
    return row;
  });
  return table;
}

SceneObject ball(const std::string& name, double radius, int frequency, const Vec3& at) {
  SceneObject object{name, std::make_shared<const TriangleMesh>(icosphere(radius, frequency)),
                     Pose::Identity()};
  object.world_from_object.translation() = at;
  return object;
}

double seconds(const std::chrono::steady_clock::time_point& since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

// K14, F9: two balls of 20 mm at +-10 mm. The contact point's distance against the depth in the
// union.
WorkPrecisionTable overlap(const std::vector<int>& resolutions, int tips, Progress& progress) {
  constexpr double kBall = 0.02, kApart = 0.01;
  WorkPrecisionTable table =
      tableOf("Depth in two merged balls that overlap (F9), rms and max", "m");
  for (const int resolution : resolutions) {
    for (const bool redistance : {false, true}) {
      progress.throwIfCancelled();
      Scene scene;
      scene.field.resolution = resolution;
      scene.redistance = redistance;
      scene.haptics.stiffness = 50;
      for (const double side : {-1.0, 1.0})
        scene.objects.push_back(
            ball(side < 0 ? "left" : "right", kBall, 50, Vec3(side * kApart, 0, 0)));
      const auto start = std::chrono::steady_clock::now();
      Progress build;
      const auto compiled = compile(scene, build);
      const double took = seconds(start);
      std::mt19937 random(9);
      std::uniform_real_distribution<double> share(0.2, 1);
      WorkPrecisionRow row;
      row.settings = {{"resolution", resolution}, {"re-distanced", redistance}};
      std::vector<Vec3> points;
      double outside = 0;
      for (int i = 0; i < tips; ++i) {
        // Points with |p| < 10 mm lie in both balls.
        const Vec3 p = share(random) * 0.0099 * randomDirection(random);
        points.push_back(p);
        const Contact contact = touch(*compiled->snapshot, p);
        const double error = std::abs((contact.vcp - p).norm() - lensDepth(p, kBall, kApart));
        row.error += error * error / tips;
        row.error_max = std::max(row.error_max, error);
        // Also in the free part of the right ball's surface layer.
        const Vec3 n = (randomDirection(random) + 1.2 * Vec3::UnitX()).normalized();
        const Vec3 skin = Vec3(kApart, 0, 0) + (kBall - 1e-3) * n;
        outside = std::max(outside, std::abs((touch(*compiled->snapshot, skin).vcp - skin).norm() -
                                             lensDepth(skin, kBall, kApart)));
      }
      row.error = std::sqrt(row.error);
      row.ns = nsPerQuery(points,
                          [&](const Vec3& tip) { return touch(*compiled->snapshot, tip).depth; });
      row.bytes = static_cast<double>(compiled->built.field->bytes());
      row.more = {{"1 mm below free skin, max [m]", outside}, {"build [s]", took}};
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// K14: time of a tick by the number of merged objects; the error is that of the force on one
// of them against the closed form.
WorkPrecisionTable crowd(const std::vector<int>& sides, Progress& progress) {
  constexpr double kBall = 4e-3, kApart = 0.012;
  WorkPrecisionTable table = tableOf("Ticks by number of merged balls: force, mean and max", "N");
  for (const int side : sides) {
    progress.throwIfCancelled();
    Scene scene;
    scene.field.voxel = 0.25e-3;
    scene.haptics.stiffness = kStiffness;
    for (int i = 0; i < side * side; ++i)
      scene.objects.push_back(ball("ball" + std::to_string(i), kBall, 30,
                                   Vec3(kApart * (i % side), kApart * (i / side), 0)));
    const auto start = std::chrono::steady_clock::now();
    Progress build;
    const auto compiled = compile(scene, build);
    const double took = seconds(start);
    WorkPrecisionRow row;
    row.settings = {{"objects", side * side}};
    // Spirals around one ball after another, like a hand's path.
    const int balls = side * side, tips = 3000;
    std::vector<Vec3> points;
    for (int of = 0; of < balls; ++of) {
      for (int i = 0; i < tips; ++i) {
        const Vec3 n = spiral(i, tips, 6);
        points.push_back(Vec3(kApart * (of % side), kApart * (of / side), 0) +
                         (kBall - 0.5e-3) * n);
        const double error =
            (touch(*compiled->snapshot, points.back()).force - kStiffness * 0.5e-3 * n).norm();
        row.error += error / (tips * balls);
        row.error_max = std::max(row.error_max, error);
      }
    }
    row.ns =
        nsPerQuery(points, [&](const Vec3& tip) { return touch(*compiled->snapshot, tip).depth; });
    row.bytes = static_cast<double>(compiled->built.field->bytes());
    row.more = {{"build [s]", took}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> surfacesStudy(const StudyOptions& options, Progress& progress) {
  const std::vector<int> resolutions =
      options.quick ? std::vector{48, 96} : std::vector{48, 72, 104, 150, 200};
  const int tips = options.quick ? 1500 : 6000;
  const std::vector<int> overlaps = options.quick ? std::vector{80} : std::vector{80, 150, 250};
  const std::vector<int> balls = options.quick ? std::vector{1, 3} : std::vector{1, 3, 10};
  std::vector<StudyPart> parts;
  for (const Mode& mode : modes())
    parts.push_back({0.2 * static_cast<double>(parts.size()), mode.name,
                     [&, mode] { return force(mode, resolutions, tips, progress); }});
  parts.push_back({0.6, "closed loops",
                   [&] { return energy(resolutions, options.quick ? 12 : 40, progress); }});
  parts.push_back(
      {0.7, "objects that overlap", [&] { return overlap(overlaps, tips / 4, progress); }});
  parts.push_back({0.9, "many objects", [&] { return crowd(balls, progress); }});
  return tablesOf(parts, progress);
}

} // namespace patina
