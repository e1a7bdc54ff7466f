#include "acquisition/texture/mesh_heights.h"

#include <cmath>
#include <limits>

#include "acquisition/registration/local_motion.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kSteepest = 0.5; // smallest cosine between the normals of mesh and heights
constexpr double kApart = 0.5e-3; // smallest distance of places that count for the mean normal [m]
// half width of the window in which speed is measured, longer than a tremor [s]
constexpr double kLook = 0.1;

struct Placed {
  ScanHeight height;
  Vec3 at = Vec3::Zero();     // position on the mesh, in its frame [m]
  Vec3 normal = Vec3::Zero(); // normal of the mesh there
};

// Computes the arc length over the mesh from 0 in each interval, without a resting hand's tremor.
void measureWay(std::vector<Placed>& places) {
  std::size_t before = 0, after = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    ScanHeight& here = places[i].height;
    const auto isSameInterval = [&](const Placed& place) {
      return place.height.stretch == here.stretch;
    };
    while (!isSameInterval(places[before]) || here.t - places[before].height.t > kLook) ++before;
    while (after + 1 < places.size() && isSameInterval(places[after + 1]) &&
           places[after + 1].height.t - here.t <= kLook)
      ++after;
    const Vec3 way = places[after].at - places[before].at;
    const double seconds = places[after].height.t - places[before].height.t;
    here.point.speed = seconds > 0 ? way.norm() / seconds : 0;
    if (i == 0 || !isSameInterval(places[i - 1])) {
      here.point.arc_length = 0;
      continue;
    }
    const double step = *here.point.speed < kStationarySpeed
                            ? 0
                            : (places[i].at - places[i - 1].at).dot(way.normalized());
    here.point.arc_length = places[i - 1].height.point.arc_length + std::max(step, 0.);
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
    const SurfaceResidual residual = target.residual(place, warm);
    warm = residual.foot.face;
    Placed found{height, residual.at, faceNormal(target.mesh(), index(residual.foot.face))};
    const double lean = found.normal.dot(up_on_mesh);
    if (!(lean > kSteepest)) {
      left_out = true;
      continue;
    }
    // A missing height starts another interval.
    if (!places.empty() && (left_out || height.stretch != last_stretch)) ++stretch;
    left_out = false;
    last_stretch = height.stretch;
    found.height.stretch = stretch;
    found.height.point.height = residual.distance;
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
    if ((sample.position - last).norm() < kApart) continue; // stationary
    last = sample.position;
    warm = target.residual(mesh_from_path * sample.position, warm).foot.face;
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
  const std::vector<LocalMotion> motions = localMotions(path);
  std::int32_t warm = kNone;
  const auto over = [&](const PathSample& sample) {
    const SurfaceResidual residual = target.residual(mesh_from_path * sample.position, warm);
    warm = residual.foot.face;
    const Vec3 normal = faceNormal(target.mesh(), index(warm));
    return SurfaceUnderTip{mesh_from_path.linear().transpose() * normal, residual.distance};
  };
  // A path has no force noise; the rise of a press is many times that of any sensor.
  return estimateCompliance(pressSamples(
                                path, [&](std::size_t i) { return motions[i].velocity; }, over),
                            std::sqrt(ProbeModel().forceVariance()), true);
}

} // namespace patina
