#include "acquisition/registration/free_motions.h"

#include <cmath>
#include <cstdio>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr double kWeak = 3e-2; // of the largest eigenvalue: what is stiffer needs no trial
constexpr double kFar = 10;    // times the noise: as far as a motion must be told

struct Trial {
  const SurfaceTarget& target;
  const std::vector<Vec3>& points;
  const PathFit& fit;
  double noise, together;
  const std::vector<double>& pressed;
  MotionScale scale;

  double facetError() const { // rms of what counts [m]
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (fit.weights[i] > 0) {
        const double e = target.facetError(fit.misses[i].foot.face);
        squares += e * e;
        ++n;
      }
    return std::sqrt(squares / std::max(n, 1.0));
  }

  // Mean square of what counts once the path was moved along `direction` and has found its place
  // again in all others.
  double squareAfter(const Vec6& direction, double length) const {
    Pose moved = scale.motion(length * direction) * fit.mesh_from_path;
    double square = 0;
    for (int round = 0; round < 3; ++round) {
      Mat6 normal = Mat6::Zero();
      Vec6 right = Vec6::Zero();
      double n = 0;
      square = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (fit.weights[i] == 0) continue;
        const Vec3 p = moved * points[i];
        Miss miss = target.miss(p, fit.misses[i].foot.face);
        if (!pressed.empty()) miss.distance += pressed[i];
        Vec6 g = scale.gradient(p, miss.direction);
        g -= direction * direction.dot(g);
        normal += g * g.transpose();
        right -= miss.distance * g;
        square += miss.distance * miss.distance;
        ++n;
      }
      square /= n;
      const SymmetricEigen eigen(normal);
      Vec6 step = Vec6::Zero();
      for (int k = 0; k < 6; ++k)
        if (eigen.values[k] > 1e-4 * eigen.values[5])
          step += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
      if (round < 2) moved = scale.motion(step) * moved;
    }
    return square;
  }

  bool unseen(const Vec6& direction) const {
    const double facets = facetError();
    double n = 0;
    for (const double w : fit.weights) n += w > 0 ? 1 : 0;
    const double shared = together * noise * noise / std::max(n - 6, 1.0);
    const double most = fit.rms * fit.rms + facets * facets + shared;
    // Well beyond what facets explain, but still on the body.
    const double length = std::min(kFar * std::max(noise, 2 * facets), scale.radius / 2);
    return squareAfter(direction, length) < most && squareAfter(direction, -length) < most;
  }
};

// Slides first, then turns about axes at right angles, each through the point of its axis nearest
// to the path and without the shift that a slide accounts for.
std::vector<FreeMotion> named(const Eigen::MatrixXd& basis, const MotionScale& scale) {
  const Svd svd(basis.topRows(3));
  std::vector<FreeMotion> slides, turns;
  for (Eigen::Index k = basis.cols() - 1; k >= 0; --k) {
    const double turn = k < svd.values.size() ? svd.values[k] : 0;
    const Vec6 motion = basis * svd.v.col(k);
    const Vec3 angle = motion.head<3>() / scale.radius;
    Vec3 shift = motion.tail<3>();
    if (turn < 0.05) { // hardly any
      slides.push_back({FreeMotion::Kind::slide, shift.normalized(), Vec3::Zero(), 0});
      continue;
    }
    for (const FreeMotion& slide : slides) shift -= slide.axis * slide.axis.dot(shift);
    const Vec3 axis = angle.normalized();
    turns.push_back({FreeMotion::Kind::turn, axis,
                     scale.centre + angle.cross(shift) / angle.squaredNorm(),
                     axis.dot(shift) / angle.norm()});
  }
  slides.insert(slides.end(), turns.begin(), turns.end());
  for (FreeMotion& motion : slides) { // the largest component counts forwards
    Eigen::Index largest;
    motion.axis.cwiseAbs().maxCoeff(&largest);
    if (motion.axis[largest] < 0) motion.axis = -motion.axis;
  }
  return slides;
}

std::string direction(const Vec3& v) {
  const auto tidy = [](double x) { return std::abs(x) < 5e-4 ? 0.0 : x; };
  char text[80];
  std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", tidy(v[0]), tidy(v[1]), tidy(v[2]));
  return text;
}

void add(FreeMotions& free, const Vec6& direction) {
  free.basis.conservativeResize(6, free.basis.cols() + 1);
  free.basis.rightCols(1) = direction;
}

} // namespace

std::string inWords(const FreeMotion& motion) {
  if (motion.kind == FreeMotion::Kind::slide)
    return "free to slide along " + direction(motion.axis);
  return "free to turn about the axis " + direction(motion.axis) + " through " +
         direction(1e3 * motion.through) + " mm";
}

FreeMotions freeMotions(const SurfaceTarget& target, const std::vector<Vec3>& points,
                        const PathFit& fit, double noise, double together,
                        const std::vector<double>& pressed) {
  const Trial trial{
      target, points, fit, noise, together, pressed, scaleOf(points, fit.mesh_from_path)};
  const SymmetricEigen eigen(fit.normal);
  FreeMotions free;
  for (int k = 0; k < 6; ++k) {
    const Vec6 direction = eigen.vectors.col(k);
    const double share = eigen.values[k] / eigen.values[5];
    if (share > kWeak || (share > kBlind && !trial.unseen(direction))) continue;
    add(free, direction);
  }
  if (free.basis.cols() > 0) free.named = named(free.basis, trial.scale);
  return free;
}

void addUnknown(FreeMotions& free, const ErrorLaw& law, const MotionScale& scale) {
  const Eigen::Index before = free.basis.cols();
  while (free.basis.cols() < 6) {
    const SymmetricEigen eigen(law.covariance(free.basis));
    // Of what is nearly singular rounding may make a variance below 0.
    const int most = -eigen.values[0] > eigen.values[5] ? 0 : 5;
    if (!(std::sqrt(std::abs(eigen.values[most])) > scale.radius / 2)) break;
    add(free, eigen.vectors.col(most));
  }
  if (free.basis.cols() > before) free.named = named(free.basis, scale);
}

} // namespace patina
