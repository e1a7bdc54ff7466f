#include "scan/register_scans.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "acquisition/registration/first_guess.h"
#include "acquisition/registration/iterated_closest_points.h"
#include "acquisition/registration/joint_fit.h"
#include "acquisition/registration/register_path.h"
#include "acquisition/registration/scan_options.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

// Explains a poor registration of a valid scan and mesh: wrong unit, wrong size or a mirrored mesh.

constexpr double kDeviations = 3.5, kMinScale = 5e-3;
constexpr double kClearlyBetter = 0.8; // ratio of the rms
constexpr double kOutlier = 5;         // times the rms
constexpr double kMisfit = 1;          // roughness over noise from which a fit is suspected
constexpr std::size_t kMaxTried = 400; // points
constexpr double kMinCover = 0.1, kMaxCover = 1.1; // fractions of the mesh's half diagonal
constexpr double kOneSize = 0.15;                  // a scale so near to one is no unit

struct OtherUnit {
  double metres; // metres of the suspected unit per metre as read
  const char* words;
};
constexpr OtherUnit kOtherUnits[] = {
    {25.4, "inches where millimetres were read, or a similar unit"},
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

// Registers points other than the scan's, without its forces.
Registration tried(const SurfaceTarget& target, const std::vector<Vec3>& points,
                   RegistrationOptions fitting, Progress& progress) {
  fitting.force.clear();
  fitting.scan.clear();
  fitting.expected.clear();
  fitting.indentations.clear();
  fitting.search = true;
  fitting.alternatives = false;
  fitting.search_options = globalSearch(target);
  return registerPath(target, points, alignCenters(target.mesh(), points), fitting, progress);
}

// Keeps at most kMaxTried points, evenly chosen, which bounds the time of a fit in another unit or
// of a mirror image.
template <class Value> std::vector<Value> someOf(const std::vector<Value>& all) {
  if (all.size() <= kMaxTried) return all;
  std::vector<Value> some;
  for (std::size_t i = 0; i < kMaxTried; ++i) some.push_back(all[i * all.size() / kMaxTried]);
  return some;
}

// Root of the mean square of all residuals, none of which counts for more than `most` [m].
double cappedRms(const std::vector<SurfaceResidual>& residuals, double most) {
  double squares = 0;
  for (const SurfaceResidual& residual : residuals)
    squares += std::pow(std::min(std::abs(residual.distance), most), 2);
  return std::sqrt(squares / static_cast<double>(residuals.size()));
}

// A fit may count few samples, the best ones, so that all are compared.
template <class Fit>
bool isClearlyBetter(const Fit& there, const std::vector<SurfaceResidual>& here) {
  const double most = kOutlier * there.rms;
  return there.converged &&
         cappedRms(there.residuals, most) < kClearlyBetter * cappedRms(here, most);
}

// The path of a mesh that is `scale` times as large as it was read.
std::vector<Vec3> scaledBy(const std::vector<Vec3>& points, double scale) {
  const Vec3 centre = scaleOf(points, Pose::Identity()).centre;
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back(centre + (p - centre) / scale);
  return scaled;
}

// Fits pose and scale from the inliers of `found` and from all samples: another size may have left
// few inliers, and outliers may mislead all. Returns the better fit.
SimilarityFit sizedFit(const SurfaceTarget& target, const std::vector<Vec3>& points,
                       const Registration& found, const std::vector<double>& indentations,
                       double noise) {
  const auto from = [&](const std::vector<bool>& inliers) {
    return fitSimilarity(target, points, found.mesh_from_path, inliers, indentations,
                         minNoise(points, noise));
  };
  SimilarityFit some = from(found.inliers), all = from(std::vector<bool>(points.size(), true));
  if (!some.converged || !all.converged) return some.converged ? some : all;
  const double most = kOutlier * std::min(some.rms, all.rms);
  return cappedRms(all.residuals, most) < cappedRms(some.residuals, most) ? all : some;
}

// Returns lines for the user, none if all is well. The first of these is given: for a failed
// registration (`found`) another unit in which the path fits; for one that failed, is ambiguous,
// misfits or shows another size a mirror image, with at most 400 points; the size, if it differs
// from one by more than 3.5 deviations and half a percent. `fitting`: the options of `found`.
std::vector<std::string> scanDoubts(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                    const RegistrationOptions& fitting, const Registration& found,
                                    Progress& progress) {
  std::vector<std::string> doubts;
  std::vector<double> pressed = fitting.indentations;
  if (!fitting.force.empty())
    pressed = ScanForces(fitting.force, fitting.scan).indentations(found.compliances);
  const SimilarityFit sized = sizedFit(target, points, found, pressed, fitting.noise);
  const double off = sized.scale - 1;
  const bool says = sized.converged && std::abs(off) < kOneSize && std::abs(off) > kMinScale &&
                    std::abs(off) > kDeviations * sized.deviation &&
                    (found.converged || isClearlyBetter(sized, found.residuals));
  const auto sayScale = [&] {
    doubts.push_back("the mesh looks " + percent(off / sized.scale) +
                     (off < 0 ? " too small" : " too large") + " (one deviation " +
                     percent(sized.deviation) +
                     "): a print, its file or the camera's calibration "
                     "may have another size");
  };
  // A mirror image of a nearly symmetric mesh, too, fits but for what looks like roughness.
  const bool misfits = found.roughness > kMisfit * minNoise(points, fitting.noise);
  if (!isUnreliable(found) && !says && !misfits) return doubts;

  // Half the mesh's diagonal, and the largest distance from the path's middle.
  const double half = target.extent() / 2;
  const std::vector<Vec3> some = someOf(points);
  const PoseScaling scale = scaleOf(points, Pose::Identity());
  double reach = 0;
  for (const Vec3& p : points) reach = std::max(reach, (p - scale.centre).norm());
  for (const OtherUnit& unit : kOtherUnits) {
    const double cover = reach / unit.metres / half;
    if (found.converged || cover < kMinCover || cover > kMaxCover) continue;
    RegistrationOptions smaller = fitting;
    smaller.noise /= unit.metres;
    smaller.roughness /= unit.metres;
    smaller.sample_spacing /= unit.metres;
    const Registration there = tried(target, scaledBy(some, unit.metres), smaller, progress);
    if (!there.converged) continue;
    doubts.push_back(std::string("the scan lies on it if the mesh is in ") + unit.words +
                     " (--unit)");
    return doubts;
  }
  std::vector<Vec3> mirrored = some;
  for (Vec3& p : mirrored) p.x() = -p.x();
  const Registration there = tried(target, mirrored, fitting, progress);
  if (isClearlyBetter(there, someOf(found.residuals)))
    doubts.push_back("the scan lies on it if one of them is mirrored: look at the axes of whatever "
                     "wrote the mesh");
  else if (says)
    sayScale();
  else if (!found.converged && reach > kMaxCover * half)
    doubts.push_back("the scan is " + formatNumber(std::round(100 * reach / half) / 100) +
                     " times as large as the mesh: check --unit");
  return doubts;
}

constexpr std::size_t kFewest = 3; // min contact samples per scan

using Paths = std::vector<std::vector<PathSample>>;
using Method = ScanRegistrationOptions::Method;

// Order of the scans that is independent of their names and order, so that sums over all samples
// round equally.
std::vector<std::size_t> orderOf(const Paths& paths) {
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto isBefore = [](const PathSample& a, const PathSample& b) {
    return std::tie(a.t, a.position[0], a.position[1], a.position[2]) <
           std::tie(b.t, b.position[0], b.position[1], b.position[2]);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(paths[a].begin(), paths[a].end(), paths[b].begin(),
                                        paths[b].end(), isBefore);
  });
  return order;
}

Registration byLoop(const SurfaceTarget& target, const std::vector<Vec3>& points, const Pose& start,
                    bool literal, std::vector<std::string>& warnings) {
  IcpOptions options;
  options.affine = literal;
  const IcpResult fit = iteratedClosestPoints(target, points, start, options);
  if (fit.fell_back)
    warnings.push_back("a path lies in a plane, where the literal fit does not exist; each step "
                       "was fitted by singular values");
  Registration result;
  result.mesh_from_path = fit.mesh_from_path;
  result.mean_distance = fit.mean_distance;
  result.rms = std::sqrt(fit.mean_square);
  result.last_rotation = fit.last_rotation;
  result.last_translation = fit.last_translation;
  result.iterations = fit.iterations;
  result.converged = fit.converged;
  for (const Vec3& p : points) result.residuals.push_back(target.residual(fit.mesh_from_path * p));
  result.inliers.assign(points.size(), true);
  return result;
}

// The joint fit has one compliance; each scan's forces are converted to depths.
JointFit refineAll(const SurfaceTarget& target, const std::vector<double>& pressed,
                   const RegistrationOptions& fitting, std::vector<PathSample>& path,
                   Registration& found, Progress& progress) {
  std::vector<PathSample> deep = path;
  for (std::size_t i = 0; i < path.size(); ++i) deep[i].force = pressed.empty() ? 0 : pressed[i];
  JointOptions joining;
  joining.compliance = pressed.empty() ? 0 : 1;
  JointFit joint = refine(target, joining, fitting, deep, found, progress);
  for (std::size_t i = 0; i < path.size(); ++i) joint.path[i].force = path[i].force;
  path = joint.path;
  return joint;
}

// Registers again from all.registration, with the compliances that presses of a standing probe
// give. Changes nothing without a significant press.
void pressAgain(const SurfaceTarget& target, const std::vector<Vec3>& points, const Paths& paths,
                RegistrationOptions fitting, RegisteredScans& all, Progress& progress) {
  fitting.expected.resize(paths.size());
  bool found_presses = false;
  for (std::size_t s = 0; s < paths.size(); ++s) {
    const auto& press = all.presses[s] =
        complianceOverMesh(target, all.registration.mesh_from_path, paths[s]);
    if (!press || !press->isSignificant()) continue;
    fitting.expected[s] = {press->compliance, press->standard_deviation};
    found_presses = true;
  }
  if (!found_presses) return;
  fitting.search = fitting.alternatives = false;
  Registration again =
      registerPath(target, points, all.registration.mesh_from_path, fitting, progress);
  again.alternatives = std::move(all.registration.alternatives);
  again.starts += all.registration.starts;
  again.iterations += all.registration.iterations;
  again.evaluations += all.registration.evaluations;
  all.registration = std::move(again);
}

} // namespace

Registration RegisteredScans::of(std::size_t scan) const {
  const auto cut = [&](auto& all) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first[scan]);
    all =
        std::decay_t<decltype(all)>(begin, begin + static_cast<std::ptrdiff_t>(paths[scan].size()));
  };
  Registration part = registration;
  cut(part.residuals);
  cut(part.inliers);
  part.compliances = {registration.compliances[scan]};
  part.compliance_deviations = {registration.compliance_deviations[scan]};
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < part.residuals.size(); ++i)
    if (part.inliers[i]) {
      squares += part.residuals[i].distance * part.residuals[i].distance;
      ++n;
    }
  if (paths.size() > 1) part.rms = std::sqrt(squares / std::max(n, 1.));
  return part;
}

std::vector<PathSample> touchingOn(const TriangleMesh& mesh, std::vector<PathSample> path,
                                   std::vector<std::string>& warnings) {
  path = inContact(std::move(path));
  std::vector<PathSample> near = path;
  const std::vector<PathSample> far = removeOutliers(near, 2 * bounds(mesh).diagonal().norm());
  if (far.size() > near.size()) return path; // a wrong unit, which the registration reports
  path = std::move(near);
  if (!far.empty())
    warnings.push_back(
        "the sample at " + formatNumber(far.front().t) +
        " s lies farther from the path's middle than the mesh is long, and is left out" +
        (far.size() > 1 ? ", as are " + formatCount(far.size() - 1) + " more" : ""));
  return path;
}

namespace {

RegisteredScans registerSorted(const SurfaceTarget& target, Paths paths,
                               const ScanRegistrationOptions& options, Progress& progress) {
  RegisteredScans all;
  std::vector<PathSample> path;
  std::vector<Vec3> points;
  std::vector<std::size_t> scan;
  for (std::size_t s = 0; s < paths.size(); ++s) {
    all.first.push_back(path.size());
    for (const PathSample& sample : paths[s]) {
      path.push_back(sample);
      points.push_back(sample.position);
      scan.push_back(s);
    }
  }
  RegistrationOptions fitting = defaultOptions(path);
  fitting.noise = all.noise = options.noise.value_or(fitting.noise);
  fitting.roughness = options.roughness;
  fitting.outliers = options.outliers;
  fitting.search = fitting.alternatives = options.search;
  if (!options.guess) fitting.search_options = globalSearch(target);
  if (!fitting.force.empty()) fitting.scan = scan;
  if (options.compliance) {
    fitting.force.clear();
    fitting.scan.clear();
    for (const PathSample& sample : path)
      fitting.indentations.push_back(*options.compliance * sample.force);
  }
  const Pose start = options.guess.value_or(alignCenters(target.mesh(), points));
  all.registration =
      options.method == Method::distance
          ? registerPath(target, points, start, fitting, progress)
          : byLoop(target, points, start, options.method == Method::literal, all.warnings);
  all.presses.resize(paths.size());
  if (!fitting.force.empty() && options.method == Method::distance)
    pressAgain(target, points, paths, fitting, all, progress);
  all.registration.compliances.resize(paths.size(), options.compliance.value_or(0));
  all.registration.compliance_deviations.resize(paths.size(), 0); // given, or not estimated
  if (options.search && options.method == Method::distance)
    all.doubts = scanDoubts(target, points, fitting, all.registration, progress);
  if (options.refine && options.method == Method::distance) {
    std::vector<double> pressed = fitting.indentations;
    if (!fitting.force.empty())
      pressed = ScanForces(fitting.force, fitting.scan).indentations(all.registration.compliances);
    all.joint = refineAll(target, pressed, fitting, path, all.registration, progress);
  }
  // A sliding probe presses harder on ridges than in grooves, so the fit would take texture for
  // compliance. The estimate from presses is used instead.
  for (std::size_t s = 0; s < paths.size(); ++s)
    if (all.presses[s] && all.presses[s]->isSignificant() && !options.compliance) {
      all.registration.compliances[s] = all.presses[s]->compliance;
      all.registration.compliance_deviations[s] = all.presses[s]->compliance_deviation;
    }
  for (std::size_t s = 0; s < paths.size(); ++s) {
    const auto begin = path.begin() + static_cast<std::ptrdiff_t>(all.first[s]);
    paths[s].assign(begin, begin + static_cast<std::ptrdiff_t>(paths[s].size()));
  }
  all.paths = std::move(paths);
  return all;
}

template <class Value>
void unsort(std::vector<Value>& sorted, const std::vector<std::size_t>& order) {
  std::vector<Value> before(sorted.size());
  for (std::size_t i = 0; i < order.size(); ++i) before[order[i]] = std::move(sorted[i]);
  sorted = std::move(before);
}

} // namespace

RegisteredScans registerScans(const SurfaceTarget& target, Paths paths,
                              const ScanRegistrationOptions& options, Progress& progress) {
  std::vector<std::string> warnings;
  const std::string few = "has fewer than three samples in contact";
  for (std::size_t s = 0; s < paths.size(); ++s) {
    std::vector<std::string> lines;
    paths[s] = touchingOn(target.mesh(), std::move(paths[s]), lines);
    const bool named = s < options.names.size();
    for (const std::string& line : lines)
      warnings.push_back((named ? options.names[s] + ": " : "") + line);
    if (paths[s].size() >= kFewest) continue;
    if (named) throw FileError(options.names[s], 0, few);
    throw Error((paths.size() > 1 ? "one of the " + formatCount(paths.size()) + " scans " : "") +
                few);
  }
  const std::vector<std::size_t> order = orderOf(paths);
  Paths sorted;
  for (const std::size_t s : order) sorted.push_back(std::move(paths[s]));
  RegisteredScans all = registerSorted(target, std::move(sorted), options, progress);
  unsort(all.paths, order);
  unsort(all.first, order);
  unsort(all.presses, order);
  unsort(all.registration.compliances, order);
  unsort(all.registration.compliance_deviations, order);
  all.warnings.insert(all.warnings.begin(), warnings.begin(), warnings.end());
  return all;
}

std::vector<std::string> warningsOf(const RegisteredScans& found, const std::string& mesh) {
  const Registration& place = found.registration;
  const std::string scans = found.paths.size() > 1 ? "the scans" : "the scan";
  std::vector<std::string> lines = found.warnings;
  for (const std::string& doubt : found.doubts) lines.push_back(mesh + ": " + doubt);
  if (!place.converged)
    lines.push_back(mesh + ": no pose was found at which it fits " + scans + " within the noise");
  for (const UnobservableMotion& motion : place.free)
    lines.push_back(mesh + ": it leaves " + scans + " " + inWords(motion));
  if (place.alternatives && !place.alternatives->empty())
    lines.push_back(mesh + ": the pose of " + scans +
                    " is ambiguous: " + inWords(*place.alternatives) +
                    "; scan more of the body, add a scan (--with), or, if the pose is roughly "
                    "known, use patina register with --initial and --no-search");
  return lines;
}

} // namespace patina
