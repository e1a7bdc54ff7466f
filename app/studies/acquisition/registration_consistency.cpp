#include "app/studies/acquisition/registration_consistency.h"

#include <algorithm>
#include <cmath>

#include "acquisition/registration/first_guess.h"
#include "acquisition/registration/scan_options.h"
#include "app/studies/acquisition/registration_cases.h"
#include "app/studies/framework/query_timing.h"
#include "core/decompose.h"
#include "core/percentiles.h"
#include "field/surface/models.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

TriangleMesh stone() {
  TriangleMesh mesh = icosphere(1, 40);
  for (Vec3& p : mesh.positions) {
    p *= 0.035 + 0.006 * p.x() * p.y() + 0.005 * std::sin(3 * p.z() + p.x()) +
         0.003 * std::cos(5 * p.y() - 2 * p.z()) + 0.004 * p.x();
    p.x() *= 1.3;
  }
  return mesh;
}

} // namespace

std::vector<TrustBody> trustBodies(std::size_t count) {
  std::vector<TrustBody> bodies = {{"dinosaur", dinosaur()}};
  const Pose side(rotationFromTo(-Vec3::UnitY(), Vec3::UnitZ()));
  if (count > 1)
    bodies.push_back({"its side", transformed(bodies[0].mesh, Eigen::Affine3d(side.matrix()))});
  if (count > 2) bodies.push_back({"stone", stone()});
  if (count > 3) bodies.push_back({"bumpy sheet", bumpySheet(100)});
  return bodies;
}

ConsistencyTrial trustTrial(const SurfaceTarget& target, double seconds, unsigned seed,
                            Progress& progress) {
  const ScannedCase scan = scanCase(target.mesh(), seconds, seed, progress);
  std::vector<Vec3> points;
  for (const PathSample& sample : scan.path) points.push_back(sample.position);
  RegistrationOptions options = defaultOptions(scan.path);
  options.search_options = globalSearch(target);
  ConsistencyTrial trial;
  const double begin = threadSeconds();
  const Registration found =
      registerPath(target, points, alignCenters(target.mesh(), points), options, progress);
  trial.seconds = threadSeconds() - begin;
  trial.warned = isUnreliable(found);
  trial.free = found.free.size();
  // Rotations are scaled to lengths by the points' radius.
  const double radius = scaleOf(points, Pose::Identity()).radius;
  const Pose off = scan.mesh_from_path * found.mesh_from_path.inverse();
  const Eigen::AngleAxisd turn(off.linear());
  Vec6 error;
  error << radius * turn.angle() * turn.axis(), off * found.middle - found.middle;
  Mat6 covariance = found.covariance;
  covariance.topRows<3>() *= radius;
  covariance.leftCols<3>() *= radius;
  const SymmetricEigen eigen(covariance);
  double squares = 0, freedoms = 0;
  for (int k = 0; k < 6; ++k) {
    if (eigen.values[k] < 1e-9 * eigen.values[5]) continue; // unobservable
    const double along = eigen.vectors.col(k).dot(error);
    squares += along * along;
    trial.nees += along * along / eigen.values[k];
    ++freedoms;
  }
  trial.nees /= freedoms;
  trial.error = std::sqrt(squares);
  trial.deviations = trial.error / std::sqrt(covariance.trace());
  return trial;
}

WorkPrecisionTable consistencyTable(const StudyOptions& options, Progress& progress) {
  const unsigned seeds = options.quick ? 1 : options.thorough ? 20 : 4;
  WorkPrecisionTable table =
      tableOf("Simulated scans, registered without a first guess: error of the place, median and "
              "worst of those called unique, of " +
                  std::to_string(seeds) + " a row; squared error in stated deviations by freedom",
              "mm");
  for (const TrustBody& body : trustBodies(options.quick ? 1 : 4)) {
    const SurfaceTarget target(body.mesh, 0, true);
    for (const double seconds : {4., 8., 20.}) {
      std::vector<double> errors, nees, times;
      double warned = 0, wrong = 0, reported = 0;
      for (unsigned seed = 1; seed <= seeds; ++seed) {
        progress.throwIfCancelled();
        const ConsistencyTrial trial = trustTrial(target, seconds, seed, progress);
        times.push_back(trial.seconds);
        warned += trial.warned;
        wrong += trial.deviations > 5;
        reported += trial.deviations > 5 && (trial.warned || trial.free > 0);
        if (trial.warned || trial.free > 0) continue;
        errors.push_back(trial.error);
        nees.push_back(trial.nees);
      }
      WorkPrecisionRow row;
      row.settings = {{"body", body.name}, {"seconds", seconds}};
      row.error = errors.empty() ? 0 : 1e3 * percentiles(errors).p50;
      row.error_max = errors.empty() ? 0 : 1e3 * percentiles(errors).max;
      row.ns = 1e9 * percentiles(times).p50;
      double sum = 0;
      for (const double value : nees) sum += value;
      row.more = {{"unique", static_cast<double>(errors.size())},
                  {"mean NEES", sum / std::max(1., static_cast<double>(nees.size()))},
                  {"warned", warned},
                  {"off by 5 deviations", wrong},
                  {"of which told", reported}};
      table.rows.push_back(row);
    }
  }
  return table;
}

} // namespace patina
