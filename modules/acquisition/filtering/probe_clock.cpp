#include "acquisition/filtering/probe_clock.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr std::size_t kMeanOf = 16;   // samples whose mean counts: texture is shorter
constexpr std::size_t kCoarse = 100;  // windows of the first search
constexpr double kFarthest = 0.5;     // [s]
constexpr double kDifference = 5e-3;  // for derivatives by time [s]
constexpr double kWorstOffset = 0.02; // deviation with which nothing is said [s]

struct Window {
  double t;
  Eigen::Vector4d shown;
};

std::vector<Window> windowsOf(const std::vector<ProbeSample>& samples) {
  std::vector<Window> windows;
  for (std::size_t begin = 0; begin + kMeanOf <= samples.size(); begin += kMeanOf) {
    const ProbeSample &first = samples[begin], &last = samples[begin + kMeanOf - 1];
    if (last.t - first.t > 0.1) continue;
    Window window{0, Eigen::Vector4d::Zero()};
    for (std::size_t i = begin; i < begin + kMeanOf; ++i) {
      window.t += samples[i].t / kMeanOf;
      window.shown += Eigen::Vector4d(samples[i].acceleration.data()) / kMeanOf;
    }
    if (std::isfinite(window.t) && window.shown.allFinite()) windows.push_back(window);
  }
  return windows;
}

class Expected {
 public:
  Expected(const CameraTrack& track, const ProbeModel& probe, const Vec3& gravity)
      : track_(track), probe_(probe), gravity_(gravity) {}

  // Nothing in a gap.
  std::optional<Eigen::Vector4d> at(double t) const {
    const TipMotion motion = motionAt(track_, t);
    if (motion.gap) return std::nullopt;
    const Vec3 held = motion.orientation.conjugate() * (motion.acceleration - gravity_);
    Eigen::Vector4d shown;
    for (int k = 0; k < 4; ++k) {
      const AccelerometerAxis& axis = probe_.axes[static_cast<std::size_t>(k)];
      const Vec3 arm = axis.position - probe_.tip;
      shown[k] = axis.direction.dot(held + motion.rate_of_rate.cross(arm) +
                                    motion.rate.cross(motion.rate.cross(arm)));
    }
    return shown;
  }

 private:
  const CameraTrack& track_;
  const ProbeModel& probe_;
  const Vec3& gravity_;
};

// Mean square of what an offset leaves, each axis about its own mean; infinite where less than half
// of the windows is seen.
double leftBy(double offset, const std::vector<Window>& windows, const Expected& expected) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(), squares = Eigen::Vector4d::Zero();
  double count = 0;
  for (const Window& window : windows) {
    const auto value = expected.at(window.t - offset);
    if (!value) continue;
    const Eigen::Vector4d off = window.shown - *value;
    sum += off;
    squares += off.cwiseAbs2();
    count += 1;
  }
  if (2 * count < static_cast<double>(windows.size())) return INFINITY;
  return (squares.sum() - sum.squaredNorm() / count) / count;
}

double coarseOffset(const std::vector<Window>& windows, const Expected& expected) {
  std::vector<Window> few;
  const std::size_t step = std::max<std::size_t>(windows.size() / kCoarse, 1);
  for (std::size_t i = 0; i < windows.size(); i += step) few.push_back(windows[i]);
  double best = 0, least = INFINITY;
  for (double offset = -kFarthest; offset <= kFarthest; offset += 0.02)
    if (const double left = leftBy(offset, few, expected); left < least) {
      least = left;
      best = offset;
    }
  return best;
}

} // namespace

std::optional<ProbeClock> fitClock(const CameraTrack& track,
                                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                                   const Vec3& gravity) {
  const std::vector<Window> windows = windowsOf(samples);
  if (track.empty() || windows.size() < 30) return std::nullopt;
  const Expected expected(track, probe, gravity);
  ProbeClock clock;
  clock.start = samples.front().t;
  clock.offset = coarseOffset(windows, expected);
  // Gauss and Newton over offset, skew and the four biases.
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Square = Eigen::Matrix<double, 6, 6>;
  Vector x = Vector::Zero();
  x[0] = clock.offset;
  constexpr int kRounds = 6;
  bool settled = false;
  for (int round = 0; round < kRounds && !settled; ++round) {
    Square normal = Square::Zero();
    Vector right = Vector::Zero();
    double squares = 0, count = 0;
    for (const Window& window : windows) {
      const double since = window.t - clock.start, t = window.t - x[0] - x[1] * since;
      const auto before = expected.at(t - kDifference), now = expected.at(t),
                 after = expected.at(t + kDifference);
      if (!before || !now || !after) continue;
      for (int k = 0; k < 4; ++k) {
        const double rate = ((*after)[k] - (*before)[k]) / (2 * kDifference);
        Vector row = Vector::Zero();
        row[0] = -rate, row[1] = -rate * since, row[2 + k] = 1;
        const double residual = window.shown[k] - (*now)[k] - x[2 + k];
        normal += row * row.transpose();
        right += row * residual;
        squares += residual * residual;
        count += 1;
      }
    }
    const SymmetricSolver solver(normal);
    if (count < 100 || !(solver.evenness() > 1e-12)) return std::nullopt;
    const Vector change = solver.solve(right);
    x += change;
    const Square P = squares / (count - 6) * solver.inverse();
    clock.offset = x[0];
    clock.skew = x[1];
    clock.offset_deviation = std::sqrt(P(0, 0));
    settled = std::abs(change[0]) < 0.1 * clock.offset_deviation;
    clock.skew_deviation = std::sqrt(P(1, 1));
    const Vec2 both = x.head<2>();
    // Of chi^2 with two degrees of freedom, once in 10,000.
    clock.differs = both.dot(P.topLeftCorner<2, 2>().inverse() * both) > 18.4;
  }
  const bool found = settled && std::abs(clock.offset) < 1.1 * kFarthest &&
                     std::abs(clock.skew) < 0.02 && clock.offset_deviation < kWorstOffset;
  return found ? std::optional(clock) : std::nullopt;
}

} // namespace patina
