#include "acquisition/registration/first_guess.h"

#include <algorithm>

#include "acquisition/filtering/contact.h"
#include "acquisition/registration/path_fit.h"
#include "core/percentiles.h"

namespace patina {

std::vector<PathSample> inContact(std::vector<PathSample> path) {
  const bool contact_known = std::any_of(
      path.begin(), path.end(), [](const PathSample& sample) { return sample.force != 0; });
  if (!contact_known) return path;
  markContact(path);
  std::erase_if(path, [](const PathSample& sample) { return !sample.touching; });
  return path;
}

std::vector<PathSample> removeOutliers(std::vector<PathSample>& path, double reach) {
  if (path.empty()) return {};
  Vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> along;
    for (const PathSample& sample : path) along.push_back(sample.position[axis]);
    middle[axis] = percentiles(std::move(along)).p50;
  }
  std::vector<PathSample> far;
  std::erase_if(path, [&](const PathSample& sample) {
    const bool leaves = !((sample.position - middle).norm() <= reach);
    if (leaves) far.push_back(sample);
    return leaves;
  });
  return far;
}

Pose alignCenters(const TriangleMesh& mesh, const std::vector<Vec3>& points) {
  Pose pose = Pose::Identity();
  pose.translation() = bounds(mesh).center() - scaleOf(points, Pose::Identity()).centre;
  return pose;
}

} // namespace patina
