#include "acquisition/calibration/still_probe.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr double kGravityLength = 9.80665; // [m/s^2]
constexpr double kWindow = 0.5;            // [s]
constexpr double kTurned = 0.01;           // more is a movement [rad]
constexpr std::size_t kAttitudes = 8;
constexpr double kAlike = 2e-3; // of the normal equations' largest: what is less is not known

struct Attitude {
  Eigen::Quaterniond camera_from_probe;
  std::array<double, 4> reading{};
  double force = 0, windows = 1, sigma = 0; // sigma: of the turn [rad]
};

// A probe that is held on shows the same steps again: one attitude, and not another.
bool isHeldOn(const Attitude& before, const Attitude& now) {
  return before.camera_from_probe.angularDistance(now.camera_from_probe) <
         kTurned + 3 * std::hypot(before.sigma, now.sigma);
}

void join(Attitude& attitude, const Attitude& more) {
  const double share = 1 / ++attitude.windows;
  attitude.camera_from_probe = attitude.camera_from_probe.slerp(share, more.camera_from_probe);
  for (std::size_t k = 0; k < 4; ++k)
    attitude.reading[k] += share * (more.reading[k] - attitude.reading[k]);
  attitude.force += share * (more.force - attitude.force);
}

template <class Value>
std::vector<const Value*> within(const std::vector<Value>& values, double from, double to) {
  std::vector<const Value*> inside;
  for (auto at = std::lower_bound(values.begin(), values.end(), from,
                                  [](const Value&value, double t) { return value.t < t; });
       at != values.end() && at->t < to; ++at)
    inside.push_back(&*at);
  return inside;
}

std::optional<Attitude> attitudeIn(const std::vector<const CameraPose*>& poses,
                                   const std::vector<const ProbeSample*>& samples,
                                   double most_variance) {
  if (poses.size() < 3 || samples.size() < 50) return std::nullopt;
  Attitude attitude;
  const CameraPose& middle = *poses[poses.size() / 2];
  for (const CameraPose* pose : poses)
    if (pose->orientation.angularDistance(middle.orientation) >
        kTurned + 3 * std::hypot(pose->sigma_angle, middle.sigma_angle))
      return std::nullopt;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(); // of quaternions near each other
  for (const CameraPose* pose : poses) {
    const Eigen::Vector4d q = pose->orientation.coeffs();
    sum += q.dot(middle.orientation.coeffs()) < 0 ? Eigen::Vector4d(-q) : q;
  }
  attitude.camera_from_probe = Eigen::Quaterniond(sum).normalized();
  attitude.sigma = middle.sigma_angle / std::sqrt(static_cast<double>(poses.size()));
  const double n = static_cast<double>(samples.size());
  for (const ProbeSample* sample : samples) attitude.force += sample->force / n;
  for (std::size_t k = 0; k < 4; ++k) {
    double mean = 0, squares = 0;
    for (const ProbeSample* sample : samples) mean += sample->acceleration[k] / n;
    for (const ProbeSample* sample : samples)
      squares += std::pow(sample->acceleration[k] - mean, 2) / n;
    if (squares > most_variance) return std::nullopt;
    attitude.reading[k] = mean;
  }
  return attitude;
}

// Least squares of readings against rows that end in 1, for the bias.
struct Affine {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  void add(const Vec3& row, double reading) {
    const Eigen::Vector4d full(row.x(), row.y(), row.z(), 1);
    normal += full * full.transpose();
    right += reading * full;
  }
};

} // namespace

std::optional<StillProbe> fitStillProbe(const std::vector<CameraPose>& poses,
                                        const std::vector<ProbeSample>& samples,
                                        const ProbeModel& model) {
  std::vector<Attitude> attitudes;
  if (poses.empty()) return std::nullopt;
  bool goes_on = false;
  for (double t = poses.front().t; t < poses.back().t; t += kWindow) {
    const auto attitude = attitudeIn(within(poses, t, t + kWindow), within(samples, t, t + kWindow),
                                     9 * model.accelerationVariance());
    if (attitude && goes_on && isHeldOn(attitudes.back(), *attitude))
      join(attitudes.back(), *attitude);
    else if (attitude)
      attitudes.push_back(*attitude);
    goes_on = attitude.has_value();
  }
  if (attitudes.size() < kAttitudes) return std::nullopt;

  StillProbe fit;
  fit.attitudes = attitudes.size();
  for (std::size_t k = 0; k < 4; ++k) fit.directions[k] = model.axes[k].direction;
  std::array<Affine, 4> axes;
  // In turn: gravity with the axes as they are, then the axes with gravity as it is.
  for (int round = 0; round < 200; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      Vec3 mean = Vec3::Zero(); // without it, and the readings', the bias has no part
      double reading = 0;
      const double n = static_cast<double>(attitudes.size());
      for (const Attitude& a : attitudes) {
        mean += a.camera_from_probe * fit.directions[k] / n;
        reading += a.reading[k] / n;
      }
      for (const Attitude& a : attitudes) {
        const Vec3 row = a.camera_from_probe * fit.directions[k] - mean;
        normal += row * row.transpose();
        right -= (a.reading[k] - reading) * row;
      }
    }
    const SymmetricSolver solver(normal);
    if (!(solver.evenness() > kAlike)) return std::nullopt;
    fit.gravity = kGravityLength * Vec3(solver.solve(right)).normalized();
    double change = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      axes[k] = Affine();
      for (const Attitude& a : attitudes)
        axes[k].add(-(a.camera_from_probe.conjugate() * fit.gravity) / kGravityLength,
                    a.reading[k] / kGravityLength);
      const SymmetricSolver axis(axes[k].normal);
      if (!(axis.evenness() > kAlike)) return std::nullopt;
      const Eigen::Vector4d solved = axis.solve(axes[k].right);
      fit.gain[k] = solved.head<3>().norm();
      const Vec3 direction = solved.head<3>() / fit.gain[k];
      change = std::max(change, (direction - fit.directions[k]).norm());
      fit.directions[k] = direction;
      fit.bias[k] = kGravityLength * solved[3];
    }
    if (change < 1e-12) break;
  }
  double squares = 0;
  for (const Attitude& a : attitudes) {
    fit.force_zero += a.force / static_cast<double>(attitudes.size());
    for (std::size_t k = 0; k < 4; ++k) {
      const double shown =
          -fit.directions[k].dot(a.camera_from_probe.conjugate() * fit.gravity) + fit.bias[k];
      squares += std::pow(a.reading[k] - shown, 2);
    }
  }
  // Four axes with a direction and a bias each, and gravity's direction.
  const double freedom = std::max(1., 4. * static_cast<double>(attitudes.size()) - 14);
  fit.rms = std::sqrt(squares / freedom);
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Matrix4d inverse = SymmetricSolver(axes[k].normal).inverse();
    fit.deviation[k] =
        fit.rms / kGravityLength * std::sqrt(inverse.topLeftCorner<3, 3>().trace() / 3);
    fit.bias_deviation[k] = fit.rms * std::sqrt(inverse(3, 3));
  }
  return fit;
}

} // namespace patina
