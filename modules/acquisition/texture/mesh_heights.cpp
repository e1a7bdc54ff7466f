#include "acquisition/texture/mesh_heights.h"

#include <cmath>
#include <limits>

#include "acquisition/registration/path_course.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kSteepest = 0.5; // cosine between the mesh's normal and that of the heights
constexpr double kApart = 0.5e-3; // places that count for the mean normal [m]
constexpr double kLook = 0.1;     // before and after a sample: a tremor is no way [s]

struct Placed {
  ScanHeight height;
  Vec3 at = Vec3::Zero();     // on the mesh, its frame [m]
  Vec3 normal = Vec3::Zero(); // of the mesh there
};

// The way over the mesh, from 0 in each stretch. Where the probe stands it is not the tremor's.
void measureWay(std::vector<Placed>& places) {
  std::size_t before = 0, after = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    ScanHeight& here = places[i].height;
    const auto alike = [&](const Placed& place) { return place.height.stretch == here.stretch; };
    while (!alike(places[before]) || here.t - places[before].height.t > kLook) ++before;
    while (after + 1 < places.size() && alike(places[after + 1]) &&
           places[after + 1].height.t - here.t <= kLook)
      ++after;
    const Vec3 way = places[after].at - places[before].at;
    const double seconds = places[after].height.t - places[before].height.t;
    here.point.speed = seconds > 0 ? way.norm() / seconds : 0;
    if (i == 0 || !alike(places[i - 1])) {
      here.point.along = 0;
      continue;
    }
    const double step = *here.point.speed < kStandingSpeed
                            ? 0
                            : (places[i].at - places[i - 1].at).dot(way.normalized());
    here.point.along = places[i - 1].height.point.along + std::max(step, 0.);
  }
}

} // namespace

std::vector<ScanHeight> heightsOverMesh(const SurfaceTarget& target, const Pose& mesh_from_path,
                                        const std::vector<PathSample>& path,
                                        const ScanHeights& heights) {
  const Vec3& up = heights.plane.normal;
  const Vec3 up_on_mesh = mesh_from_path.linear() * up;
  std::vector<Placed> places;
  std::size_t stretch = 0, last_stretch = 0;
  bool left_out = false;
  std::int32_t warm = kNone;
  auto sample = path.begin();
  for (const ScanHeight& height : heights.heights) {
    while (sample != path.end() && sample->t < height.t) ++sample;
    if (sample == path.end()) break;
    if (sample->t != height.t) continue;
    const double depth = up.dot(sample->position - heights.plane.point);
    const Vec3 place =
        mesh_from_path * (sample->position + (height.point.height - depth) * up).eval();
    const Miss miss = target.miss(place, warm);
    warm = miss.foot.face;
    Placed found{height, miss.at, faceNormal(target.mesh(), index(miss.foot.face))};
    const double lean = found.normal.dot(up_on_mesh);
    if (!(lean > kSteepest)) {
      left_out = true;
      continue;
    }
    // What lies beyond a place without a height is another stretch.
    if (!places.empty() && (left_out || height.stretch != last_stretch)) ++stretch;
    left_out = false;
    last_stretch = height.stretch;
    found.height.stretch = stretch;
    found.height.point.height = miss.distance;
    found.height.point.sigma = lean * height.point.sigma;
    places.push_back(found);
  }
  measureWay(places);
  std::vector<ScanHeight> over;
  over.reserve(places.size());
  for (const Placed& place : places) over.push_back(place.height);
  return over;
}

Vec3 meanNormal(const SurfaceTarget& target, const Pose& mesh_from_path,
                const std::vector<PathSample>& path) {
  Vec3 sum = Vec3::Zero(), last = Vec3::Constant(std::numeric_limits<double>::infinity());
  double count = 0;
  std::int32_t warm = kNone;
  for (const PathSample& sample : path) {
    if ((sample.position - last).norm() < kApart) continue; // it stands
    last = sample.position;
    warm = target.miss(mesh_from_path * sample.position, warm).foot.face;
    sum += faceNormal(target.mesh(), index(warm));
    count += 1;
  }
  if (!(sum.norm() > kSteepest * count))
    throw Error(count == 0 ? "the path is empty"
                           : "the path runs around the mesh: no one side of it is outwards");
  return mesh_from_path.linear().transpose() * sum.normalized();
}

std::optional<ComplianceEstimate> complianceOverMesh(const SurfaceTarget& target,
                                                     const Pose& mesh_from_path,
                                                     const std::vector<PathSample>& path) {
  const std::vector<Course> courses = coursesOf(path);
  std::int32_t warm = kNone;
  const auto over = [&](const PathSample& sample) {
    const Miss miss = target.miss(mesh_from_path * sample.position, warm);
    warm = miss.foot.face;
    const Vec3 normal = faceNormal(target.mesh(), index(warm));
    return TipOver{mesh_from_path.linear().transpose() * normal, miss.distance};
  };
  // A path does not say how its force was measured; a press is many times the noise of any sensor.
  return estimateCompliance(pressesOf(
                                path, [&](std::size_t i) { return courses[i].speed; }, over),
                            std::sqrt(ProbeModel().forceVariance()), true);
}

} // namespace patina
