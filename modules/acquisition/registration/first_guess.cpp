#include "acquisition/registration/first_guess.h"

#include <algorithm>

#include "acquisition/filtering/contact.h"
#include "acquisition/registration/path_fit.h"

namespace patina {

std::vector<PathSample> inContact(std::vector<PathSample> path) {
  const bool told = std::any_of(path.begin(), path.end(),
                                [](const PathSample& sample) { return sample.force != 0; });
  if (!told) return path;
  markContact(path);
  std::erase_if(path, [](const PathSample& sample) { return !sample.touching; });
  return path;
}

Pose middleOnMiddle(const TriangleMesh& mesh, const std::vector<Vec3>& points) {
  Pose pose = Pose::Identity();
  pose.translation() = bounds(mesh).center() - scaleOf(points, Pose::Identity()).centre;
  return pose;
}

} // namespace patina
