#include "acquisition/calibration/probe_calibration.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/decompose.h"

namespace patina {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// Line: reading = zero + slope * force.
struct ShownLine {
  double zero = 0, slope = 0;
  double residual(const KnownForce& r) const { return r.reading - zero - slope * r.force; }
};

// Theil-Sen estimator (Sen 1968): the median slope of all pairs tolerates a quarter of outliers.
ShownLine theilSenLine(const std::vector<KnownForce>& readings) {
  std::vector<double> slopes, zeros;
  for (const KnownForce& a : readings)
    for (const KnownForce& b : readings)
      if (b.force > a.force) slopes.push_back((b.reading - a.reading) / (b.force - a.force));
  ShownLine line{0, median(slopes)};
  for (const KnownForce& r : readings) zeros.push_back(line.residual(r));
  line.zero = median(zeros);
  return line;
}

} // namespace

std::optional<ForceFit> fitForce(const std::vector<KnownForce>& readings) {
  std::set<double> forces;
  for (const KnownForce& r : readings) forces.insert(r.force);
  if (readings.size() < 4 || forces.size() < 3) return std::nullopt;
  const ShownLine first = theilSenLine(readings);
  std::vector<double> residuals;
  for (const KnownForce& r : readings) residuals.push_back(std::abs(first.residual(r)));
  const double count = static_cast<double>(readings.size());
  const double range = std::abs(first.slope) * (*forces.rbegin() - *forces.begin());
  // The outlier limit is wider for few readings, whose median residual is uncertain. It is at least
  // kFair of the range, which allows for the sensor's nonlinearity.
  constexpr double kFair = 0.005;
  const double most =
      std::max(3.5 * 1.4826 * (1 + 5 / (count - 2)) * median(residuals), kFair * range);
  ForceFit fit;
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (residuals[i] > most) {
      fit.rejected.push_back(i);
      continue;
    }
    n += 1, x += readings[i].force, y += readings[i].reading;
    xx += readings[i].force * readings[i].force, xy += readings[i].force * readings[i].reading;
  }
  const double spread = xx - x * x / n;
  if (n < 3 || !(spread > 0)) return std::nullopt;
  ShownLine line{0, (xy - x * y / n) / spread};
  line.zero = (y - line.slope * x) / n;
  double squares = 0;
  for (std::size_t i = 0; i < readings.size(); ++i)
    if (residuals[i] <= most) squares += line.residual(readings[i]) * line.residual(readings[i]);
  const double variance = squares / (n - 2), slope_deviation = std::sqrt(variance / spread);
  if (!(std::abs(line.slope) > 5 * slope_deviation)) return std::nullopt;
  fit.zero = line.zero;
  fit.gain = 1 / line.slope;
  fit.zero_deviation = std::sqrt(variance * xx / (n * spread));
  fit.gain_deviation = slope_deviation / (line.slope * line.slope);
  fit.rms = std::sqrt(squares / n) / std::abs(line.slope);
  return fit;
}

namespace {

constexpr double kGravityLength = 9.80665; // [m/s^2]
constexpr double kWindow = 0.5;            // [s]
constexpr double kTurned = 0.01;           // a larger rotation is a movement [rad]
constexpr std::size_t kAttitudes = 8;
// Relative eigenvalue below which the attitudes do not determine the axes.
constexpr double kMinEigenvalueRatio = 2e-3;

struct Attitude {
  Eigen::Quaterniond camera_from_probe;
  std::array<double, 4> reading{};
  double force = 0, windows = 1, sigma = 0; // sigma: deviation of the attitude [rad]
};

// Returns true if two windows belong to the same static pose, whose readings repeat.
bool isSameStaticPose(const Attitude& before, const Attitude& now) {
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
                                   double max_variance) {
  if (poses.size() < 3 || samples.size() < 50) return std::nullopt;
  Attitude attitude;
  const CameraPose& middle = *poses[poses.size() / 2];
  for (const CameraPose* pose : poses)
    if (pose->orientation.angularDistance(middle.orientation) >
        kTurned + 3 * std::hypot(pose->sigma_angle, middle.sigma_angle))
      return std::nullopt;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(); // quaternions of nearly equal orientations
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
    if (squares > max_variance) return std::nullopt;
    attitude.reading[k] = mean;
  }
  return attitude;
}

// Least squares for rows that end in 1, which is the coefficient of the bias.
struct Affine {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d rhs = Eigen::Vector4d::Zero();
  void add(const Vec3& row, double reading) {
    const Eigen::Vector4d full(row.x(), row.y(), row.z(), 1);
    normal += full * full.transpose();
    rhs += reading * full;
  }
};

} // namespace

std::optional<AccelerometerCalibration>
calibrateAccelerometers(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& model) {
  std::vector<Attitude> attitudes;
  if (poses.empty()) return std::nullopt;
  bool goes_on = false;
  for (double t = poses.front().t; t < poses.back().t; t += kWindow) {
    const auto attitude = attitudeIn(within(poses, t, t + kWindow), within(samples, t, t + kWindow),
                                     9 * model.accelerationVariance());
    if (attitude && goes_on && isSameStaticPose(attitudes.back(), *attitude))
      join(attitudes.back(), *attitude);
    else if (attitude)
      attitudes.push_back(*attitude);
    goes_on = attitude.has_value();
  }
  if (attitudes.size() < kAttitudes) return std::nullopt;

  AccelerometerCalibration fit;
  fit.attitudes = attitudes.size();
  for (std::size_t k = 0; k < 4; ++k) fit.directions[k] = model.axes[k].direction;
  std::array<Affine, 4> axes;
  // Alternates between gravity for fixed axes and axes for fixed gravity.
  for (int round = 0; round < 200; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 rhs = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      Vec3 mean = Vec3::Zero(); // subtracting the means eliminates the bias
      double reading = 0;
      const double n = static_cast<double>(attitudes.size());
      for (const Attitude& a : attitudes) {
        mean += a.camera_from_probe * fit.directions[k] / n;
        reading += a.reading[k] / n;
      }
      for (const Attitude& a : attitudes) {
        const Vec3 row = a.camera_from_probe * fit.directions[k] - mean;
        normal += row * row.transpose();
        rhs -= (a.reading[k] - reading) * row;
      }
    }
    const SymmetricSolver solver(normal);
    if (!(solver.reciprocalCondition() > kMinEigenvalueRatio)) return std::nullopt;
    fit.gravity = kGravityLength * Vec3(solver.solve(rhs)).normalized();
    double change = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      axes[k] = Affine();
      for (const Attitude& a : attitudes)
        axes[k].add(-(a.camera_from_probe.conjugate() * fit.gravity) / kGravityLength,
                    a.reading[k] / kGravityLength);
      const SymmetricSolver axis(axes[k].normal);
      if (!(axis.reciprocalCondition() > kMinEigenvalueRatio)) return std::nullopt;
      const Eigen::Vector4d solved = axis.solve(axes[k].rhs);
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
  // The parameters are a direction and a bias for each of four axes, and gravity's direction.
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
