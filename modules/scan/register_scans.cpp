#include "scan/register_scans.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "acquisition/registration/closest_point_loop.h"
#include "acquisition/registration/first_guess.h"
#include "acquisition/registration/scan_options.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_report.h"
#include "scan/scan_doubts.h"

namespace patina {
namespace {

constexpr std::size_t kFewest = 3; // samples that can be laid

using Paths = std::vector<std::vector<PathSample>>;
using Method = ScanRegistrationOptions::Method;

// An order of the scans that does not depend on how they were named or listed, so that sums over
// all of their samples round alike.
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
  LoopOptions options;
  options.literal = literal;
  const LoopFit fit = closestPointLoop(target, points, start, options);
  if (fit.fell_back)
    warnings.push_back("the path lies in a plane, where the literal fit does not exist; each step "
                       "was fitted by singular values");
  Registration result;
  result.mesh_from_path = fit.mesh_from_path;
  result.mean_distance = fit.mean_distance;
  result.rms = std::sqrt(fit.mean_square);
  result.last_turn = fit.last_turn;
  result.last_shift = fit.last_shift;
  result.iterations = fit.iterations;
  result.converged = fit.converged;
  for (const Vec3& p : points) result.misses.push_back(target.miss(fit.mesh_from_path * p));
  result.counts.assign(points.size(), true);
  return result;
}

// The joint fit knows one compliance: each scan's forces become depths.
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

// Once more from there, with what presses of a standing probe say of the compliances beforehand.
void pressAgain(const SurfaceTarget& target, const std::vector<Vec3>& points, const Paths& paths,
                RegistrationOptions fitting, RegisteredScans& all, Progress& progress) {
  fitting.expected.resize(paths.size());
  bool told = false;
  for (std::size_t s = 0; s < paths.size(); ++s) {
    const auto& press = all.presses[s] =
        complianceOverMesh(target, all.registration.mesh_from_path, paths[s]);
    if (!press || !press->isTold()) continue;
    fitting.expected[s] = {press->compliance, press->compliance_deviation};
    told = true;
  }
  if (!told) return;
  fitting.search = fitting.rivals = false;
  Registration again =
      registerPath(target, points, all.registration.mesh_from_path, fitting, progress);
  again.rivals = std::move(all.registration.rivals);
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
  cut(part.misses);
  cut(part.counts);
  part.compliances = {registration.compliances[scan]};
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < part.misses.size(); ++i)
    if (part.counts[i]) {
      squares += part.misses[i].distance * part.misses[i].distance;
      ++n;
    }
  if (paths.size() > 1) part.rms = std::sqrt(squares / std::max(n, 1.));
  return part;
}

std::vector<PathSample> touchingOn(const TriangleMesh& mesh, std::vector<PathSample> path,
                                   std::vector<std::string>& warnings) {
  path = inContact(std::move(path));
  std::vector<PathSample> near = path;
  const std::vector<PathSample> far = leaveOutFar(near, 2 * bounds(mesh).diagonal().norm());
  if (far.size() > near.size()) return path; // of another unit, which the registration finds out
  path = std::move(near);
  if (!far.empty())
    warnings.push_back(
        "the sample at " + formatNumber(far.front().t) +
        " s lies farther from the path's middle than the mesh is long, and is left out" +
        (far.size() > 1 ? ", as are " + formatCount(far.size() - 1) + " more" : ""));
  return path;
}

namespace {

// In the order of orderOf().
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
  for (const std::vector<PathSample>& one : paths)
    if (one.size() < kFewest) {
      const std::string which =
          paths.size() > 1 ? "one of the " + formatCount(paths.size()) + " scans " : "";
      throw Error(which + "has fewer than three samples in contact");
    }
  RegistrationOptions fitting = optionsFor(path);
  fitting.noise = all.noise = options.noise.value_or(fitting.noise);
  fitting.roughness = options.roughness;
  fitting.outliers = options.outliers;
  fitting.search = fitting.rivals = options.search;
  if (!options.guess) fitting.around = anywhereOn(target);
  if (!fitting.force.empty()) fitting.scan = scan;
  if (options.compliance) {
    fitting.force.clear();
    fitting.scan.clear();
    for (const PathSample& sample : path)
      fitting.pressed.push_back(*options.compliance * sample.force);
  }
  const Pose start = options.guess.value_or(middleOnMiddle(target.mesh(), points));
  all.registration =
      options.method == Method::distance
          ? registerPath(target, points, start, fitting, progress)
          : byLoop(target, points, start, options.method == Method::literal, all.warnings);
  all.presses.resize(paths.size());
  if (!fitting.force.empty() && options.method == Method::distance)
    pressAgain(target, points, paths, fitting, all, progress);
  all.registration.compliances.resize(paths.size(), options.compliance.value_or(0));
  if (options.search && options.method == Method::distance)
    all.doubts = scanDoubts(target, points, fitting, all.registration, progress);
  if (options.refine && options.method == Method::distance) {
    std::vector<double> pressed = fitting.pressed;
    if (!fitting.force.empty())
      pressed = ScanForces(fitting.force, fitting.scan).pressed(all.registration.compliances);
    all.joint = refineAll(target, pressed, fitting, path, all.registration, progress);
  }
  // A probe that slides presses harder on a ridge than in a groove, so that the fit takes texture
  // for stiffness; what presses say is the scan's.
  for (std::size_t s = 0; s < paths.size(); ++s)
    if (all.presses[s] && all.presses[s]->isTold() && !options.compliance)
      all.registration.compliances[s] = all.presses[s]->compliance;
  for (std::size_t s = 0; s < paths.size(); ++s) {
    const auto begin = path.begin() + static_cast<std::ptrdiff_t>(all.first[s]);
    paths[s].assign(begin, begin + static_cast<std::ptrdiff_t>(paths[s].size()));
  }
  all.paths = std::move(paths);
  return all;
}

// Of a list that is sorted, as it was before.
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
  for (std::vector<PathSample>& path : paths)
    path = touchingOn(target.mesh(), std::move(path), warnings);
  const std::vector<std::size_t> order = orderOf(paths);
  Paths sorted;
  for (const std::size_t s : order) sorted.push_back(std::move(paths[s]));
  RegisteredScans all = registerSorted(target, std::move(sorted), options, progress);
  unsort(all.paths, order);
  unsort(all.first, order);
  unsort(all.presses, order);
  unsort(all.registration.compliances, order);
  all.warnings.insert(all.warnings.begin(), warnings.begin(), warnings.end());
  return all;
}

} // namespace patina
