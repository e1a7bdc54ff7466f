#include "acquisition/profile/scan_heights.h"

#include <cmath>

#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr double kFlat = 0.5;        // largest ratio of thickness to width of a plane
constexpr std::size_t kFewest = 100; // smallest number of samples of a usable interval: 0.2 s

} // namespace

std::vector<PressSample>
pressSamples(const std::vector<PathSample>& path,
             const std::function<Vec3(std::size_t)>& velocityAt,
             const std::function<SurfaceUnderTip(const PathSample&)>& over) {
  std::vector<PressSample> samples;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathSample& sample = path[i];
    if (!sample.touching) continue;
    const SurfaceUnderTip here = over(sample);
    const Vec3 velocity = velocityAt(i);
    if ((velocity - here.normal * here.normal.dot(velocity)).norm() > kStationarySpeed) continue;
    samples.push_back({sample.t, -here.height, sample.force, sample.sigma});
  }
  return samples;
}

Plane touchedPlane(const std::vector<PathSample>& path, const Vec3& tip) {
  Vec3 mean = Vec3::Zero(), shaft = Vec3::Zero();
  double count = 0;
  for (const PathSample& sample : path)
    if (sample.touching) {
      mean += sample.position;
      shaft -= sample.orientation * tip;
      count += 1;
    }
  if (count == 0) throw Error("the probe never touches: there is no height");
  mean /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const PathSample& sample : path)
    if (sample.touching)
      spread += (sample.position - mean) * (sample.position - mean).transpose() / count;
  const SymmetricEigen axes(spread);
  if (!(axes.values[0] < kFlat * kFlat * axes.values[1]))
    throw Error("the contact points form no plane: give the outward direction (--normal), or find "
                "heights over the mesh (--reference-mesh)");
  const Vec3 normal = axes.vectors.col(0);
  return {normal.dot(shaft) < 0 ? Vec3(-normal) : normal, mean};
}

ScanHeights scanHeights(const FilteredScan& scan, const std::vector<CameraPose>& poses,
                        const ProbeModel& probe, const Vec3& gravity,
                        const std::optional<Vec3>& normal, const std::optional<double>& given) {
  ScanHeights found;
  if (normal) {
    found.plane.normal = normal->normalized();
    double count = 0;
    for (const PathSample& sample : scan.whole)
      if (sample.touching) found.plane.point += (sample.position - found.plane.point) / ++count;
  } else {
    found.plane = touchedPlane(scan.whole, probe.tip);
  }
  found.compliance = estimateCompliance(
      pressSamples(
          scan.whole, [&](std::size_t i) { return motionAt(scan.track, scan.whole[i].t).velocity; },
          [&normal = found.plane.normal](const PathSample& sample) {
            return SurfaceUnderTip{normal, normal.dot(sample.position)};
          }),
      std::sqrt(probe.forceVariance()), true);
  const bool significant = found.compliance && found.compliance->isSignificant();
  const double compliance = given.value_or(significant ? found.compliance->compliance : 0);
  std::vector<std::vector<TracedSample>> traces;
  for (const ContactInterval& stretch : contactIntervals(scan.whole))
    if (stretch.end - stretch.begin >= kFewest)
      traces.push_back(
          profileSamples(scan, stretch, poses, probe, gravity, found.plane, compliance));
  if (traces.empty()) throw Error("the probe touches too shortly for a height");
  HeightOptions options;
  options.acceleration_variance = probe.accelerationVariance();
  const Roughness roughness = fitRoughness(traces, options);
  options.rms = roughness.rms;
  options.length = roughness.length;
  for (std::size_t s = 0; s < traces.size(); ++s) {
    const HeightProfile profile = estimateProfile(traces[s], options);
    for (std::size_t i = 0; i < profile.points.size(); ++i)
      found.heights.push_back({traces[s][i].t, profile.points[i], s});
  }
  return found;
}

} // namespace patina
