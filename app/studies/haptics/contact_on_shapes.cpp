#include "app/studies/haptics/contact_on_shapes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "app/studies/contact/course.h"
#include "app/studies/contact/scenes.h"
#include "core/percentiles.h"

namespace patina {
namespace {

struct Shape {
  const char* about;
  const char* scene;
  bool plane = true; // all faces: only creases are rounded by the field
};
constexpr Shape kShapes[] = {{"inner corner, 2 planes", "L"},
                             {"inner corner, 3 planes", "room"},
                             {"outer edges", "box"},
                             {"bar of 4 mm radius", "bar", false},
                             {"V-groove", "groove"},
                             {"plate of 1 mm", "plate1"},
                             {"two spheres united", "spheres", false},
                             {"scan with holes", "scan", false}};

// A tip that a course gave, so that it can be felt again without the judge beside.
struct Step {
  Vec3 tip = Vec3::Zero();
  bool fresh = false; // the first of a touch
};
using Way = std::vector<Step>;

// Keeps a reference to the way.
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

// Of each tick the least of all passes [ns]; infinite out of contact.
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

struct Judged {
  CourseReport course;
  double created = 0; // [J], by the worst loop
  Percentiles ns;
};

// All but p99, p99.9 and median time, which have a place of their own for the proxy.
void addColumns(WorkPrecisionRow& row, const std::string& method, const Judged& judged) {
  const CourseReport& course = judged.course;
  const auto contacts = static_cast<double>(std::max(1L, course.contacts));
  const double samples = std::accumulate(course.samples.begin(), course.samples.end(), 0.0);
  const std::pair<const char*, double> columns[] = {
      {"p50 [N]", percentiles(course.error).p50},
      {"snaps [%]", 100 * static_cast<double>(course.snaps) / contacts},
      {"p99 of snaps [N]", percentiles(course.snap_error).p99},
      {"lost ticks", static_cast<double>(course.lost)},
      {"pulling ticks", static_cast<double>(course.pulls)},
      {"fault ticks", static_cast<double>(course.faults)},
      {"step excess [N]", course.worst_excess},
      {"worst loop [J]", judged.created},
      {"samples", samples / contacts},
      {"most samples", percentiles(course.samples).max},
      {"p99 [ns]", judged.ns.p99},
      {"p99.9 [ns]", judged.ns.p999}};
  for (const auto& [name, value] : columns) row.more.emplace_back(method + name, value);
}

} // namespace

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
        const unsigned seed = courseSeed(scene, iso, 1);
        const std::array snapshots = {contactSnapshot(field, iso, "proxy"),
                                      contactSnapshot(field, iso, "ray")};
        std::array<Judged, 2> judged;
        std::array<TickTimes, 2> times;
        Way way; // the proxy's, for both
        for (std::size_t m = 0; m < 2; ++m) {
          const ContactMethod method = methodOf(*snapshots[m]);
          judged[m].course =
              runCourse(m == 0 ? recorded(method, way) : method, surface, iso, ticks, seed);
          judged[m].created = runLoops(method, surface, iso, loops, seed + 1000).created;
        }
        for (int pass = 0; pass < passes; ++pass)
          for (std::size_t m = 0; m < 2; ++m) timePass(*snapshots[m], way, times[m]);
        for (std::size_t m = 0; m < 2; ++m) judged[m].ns = inContact(times[m]);

        const auto& [proxy, ray] = judged;
        const Percentiles error = percentiles(proxy.course.error);
        const Percentiles ray_error = percentiles(ray.course.error);
        if (shape.plane)
          errors.insert(errors.end(), proxy.course.error.begin(), proxy.course.error.end());
        WorkPrecisionRow row;
        row.knobs = {{"shape", shape.about}, {"resolution", resolution}, {"tip [mm]", 1e3 * iso}};
        row.error = error.p99;
        row.error_max = error.p999;
        row.ns = proxy.ns.p50;
        row.bytes = static_cast<double>(field->bytes());
        addColumns(row, "", proxy);
        row.more.emplace_back("ray p99 [N]", ray_error.p99);
        row.more.emplace_back("ray p99.9 [N]", ray_error.p999);
        row.more.emplace_back("ray ns", ray.ns.p50);
        addColumns(row, "ray ", ray);
        row.more.emplace_back("ticks in contact", static_cast<double>(proxy.course.contacts));
        table.rows.push_back(std::move(row));
      }
    }
    order.add(1.0 / resolution, percentiles(errors).p99);
  }
  if (order.voxels.size() > 1) order.into(table, 1);
  return table;
}

} // namespace patina
