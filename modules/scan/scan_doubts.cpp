#include "scan/scan_doubts.h"

#include <cmath>

#include "acquisition/registration/first_guess.h"
#include "acquisition/registration/scan_options.h"
#include "acquisition/registration/similarity_fit.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kDeviations = 4, kLeastScale = 5e-3;
constexpr double kClearlyBetter = 0.8;                // of the rms
constexpr double kLeastCover = 0.1, kMostCover = 1.1; // of the mesh's half diagonal
constexpr double kOneSize = 0.15;                     // a scale so near to one is no unit

struct OtherUnit {
  double metres; // of the unit that may be meant, over that which was read
  const char* words;
};
constexpr OtherUnit kOtherUnits[] = {{25.4, "inches where millimetres were read, or a unit alike"},
                                     {1000, "metres where millimetres were read"},
                                     {10, "centimetres where millimetres were read"},
                                     {1 / 25.4, "millimetres where inches were read"},
                                     {1e-3, "millimetres where metres were read"},
                                     {0.1, "millimetres where centimetres were read"}};

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * std::abs(share));
  return text;
}

// A registration of points that are not those of the scan: none of its forces hold.
Registration tried(const SurfaceTarget& target, const std::vector<Vec3>& points,
                   RegistrationOptions fitting, Progress& progress) {
  fitting.force.clear();
  fitting.scan.clear();
  fitting.expected.clear();
  fitting.pressed.clear();
  fitting.search = fitting.rivals = true;
  fitting.around = anywhereOn(target);
  return registerPath(target, points, middleOnMiddle(target.mesh(), points), fitting, progress);
}

// The path of a mesh that is `scale` times as large as it was read.
std::vector<Vec3> scaledBy(const std::vector<Vec3>& points, double scale) {
  const Vec3 centre = scaleOf(points, Pose::Identity()).centre;
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back(centre + (p - centre) / scale);
  return scaled;
}

} // namespace

std::vector<std::string> scanDoubts(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                    const RegistrationOptions& fitting, const Registration& found,
                                    Progress& progress) {
  std::vector<std::string> doubts;
  std::vector<double> pressed = fitting.pressed;
  if (!fitting.force.empty())
    pressed = ScanForces(fitting.force, fitting.scan).pressed(found.compliances);
  const SimilarityFit sized = fitSimilarity(target, points, found.mesh_from_path, found.counts,
                                            pressed, leastNoise(points, fitting.noise));
  const double off = sized.scale - 1;
  const bool says = found.free.empty() && sized.converged && std::abs(off) < kOneSize &&
                    std::abs(off) > kLeastScale && std::abs(off) > kDeviations * sized.deviation &&
                    (found.converged || sized.rms < kClearlyBetter * found.rms);
  if (says)
    doubts.push_back("the mesh looks " + percent(off / sized.scale) +
                     (off < 0 ? " too small" : " too large") + " (one deviation " +
                     percent(sized.deviation) +
                     "): a print, its file or the camera's calibration "
                     "may have another size");
  if (found.converged || says) return doubts;

  // Half the mesh's diagonal, and the farthest point from the path's middle.
  const double half = target.extent() / 2;
  const MotionScale scale = scaleOf(points, Pose::Identity());
  double reach = 0;
  for (const Vec3& p : points) reach = std::max(reach, (p - scale.centre).norm());
  for (const OtherUnit& unit : kOtherUnits) {
    const double cover = reach / unit.metres / half;
    if (cover < kLeastCover || cover > kMostCover) continue;
    RegistrationOptions smaller = fitting;
    smaller.noise /= unit.metres;
    smaller.roughness /= unit.metres;
    smaller.place /= unit.metres;
    const Registration there = tried(target, scaledBy(points, unit.metres), smaller, progress);
    if (!there.converged) continue;
    doubts.push_back(std::string("the scan lies on it if the mesh is in ") + unit.words +
                     " (--unit)");
    return doubts;
  }
  std::vector<Vec3> mirrored = points;
  for (Vec3& p : mirrored) p.x() = -p.x();
  const Registration there = tried(target, mirrored, fitting, progress);
  if (there.converged && there.rms < kClearlyBetter * found.rms)
    doubts.push_back("the scan lies on it if one of them is mirrored: look at the axes of whatever "
                     "wrote the mesh");
  if (doubts.empty() && reach > kMostCover * half)
    doubts.push_back("the scan is " + formatNumber(std::round(100 * reach / half) / 100) +
                     " times as large as it: is --unit right?");
  return doubts;
}

} // namespace patina
