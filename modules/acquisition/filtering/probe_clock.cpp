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
constexpr double kAlike = 0.5;        // how long errors may stay alike [s]
constexpr double kChance = 1e-4;      // that clocks that agree are set all the same

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

// Offset, skew and the four biases.
using ClockVector = Eigen::Matrix<double, 6, 1>;
using ClockSquare = Eigen::Matrix<double, 6, 6>;

// Normal equations about some x.
struct Equations {
  ClockSquare normal = ClockSquare::Zero();
  ClockVector right = ClockVector::Zero();

  void add(const ClockVector& row, double residual) {
    normal += row * row.transpose();
    right += row * residual;
  }
};

struct ClockFit {
  Equations all;
  std::vector<Equations> parts;  // what comes of half a second each, where errors may stay alike
  double squares = 0, count = 0; // of what is left
};

ClockFit fitAbout(const ClockVector& x, double start, const std::vector<Window>& windows,
                  const Expected& expected) {
  ClockFit fit;
  double part_end = -INFINITY;
  for (const Window& window : windows) {
    const double since = window.t - start, t = window.t - x[0] - x[1] * since;
    const auto before = expected.at(t - kDifference), now = expected.at(t),
               after = expected.at(t + kDifference);
    if (!before || !now || !after) continue;
    if (window.t > part_end) {
      fit.parts.emplace_back();
      part_end = window.t + kAlike;
    }
    for (int k = 0; k < 4; ++k) {
      const double rate = ((*after)[k] - (*before)[k]) / (2 * kDifference);
      ClockVector row = ClockVector::Zero();
      row[0] = -rate, row[1] = -rate * since, row[2 + k] = 1;
      const double residual = window.shown[k] - (*now)[k] - x[2 + k];
      fit.all.add(row, residual);
      fit.parts.back().add(row, residual);
      fit.squares += residual * residual;
      fit.count += 1;
    }
  }
  return fit;
}

// Covariance by how far it moves the solution to leave out one part after the other (the
// jackknife): of a stroke on which all depends the others say how little they know without it.
ClockSquare covarianceByParts(const ClockFit& fit, const ClockVector& solution) {
  const double count = static_cast<double>(fit.parts.size());
  ClockVector sum = ClockVector::Zero();
  ClockSquare squares = ClockSquare::Zero();
  for (const Equations& part : fit.parts) {
    const ClockVector moved =
        ClockVector(
            SymmetricSolver(fit.all.normal - part.normal).solve(fit.all.right - part.right)) -
        solution;
    sum += moved;
    squares += moved * moved.transpose();
  }
  return (count - 1) / count * (squares - 1 / count * sum * sum.transpose());
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
  // Gauss and Newton.
  ClockVector x = ClockVector::Zero();
  x[0] = coarseOffset(windows, expected);
  constexpr int kRounds = 6;
  bool settled = false, told = false;
  for (int round = 0; round < kRounds && !settled; ++round) {
    const ClockFit fit = fitAbout(x, clock.start, windows, expected);
    const SymmetricSolver solver(fit.all.normal);
    if (fit.count < 100 || fit.parts.size() < 4 || !(solver.evenness() > 1e-12))
      return std::nullopt;
    const ClockVector change = solver.solve(fit.all.right);
    x += change;
    const ClockSquare even = fit.squares / (fit.count - 6) * ClockSquare(solver.inverse()),
                      alike = covarianceByParts(fit, change);
    const auto surprise = [both = Vec2(x.head<2>())](const ClockSquare& P) {
      return both.dot(P.topLeftCorner<2, 2>().inverse() * both);
    };
    clock.offset = x[0];
    clock.skew = x[1];
    clock.offset_deviation = std::sqrt(std::max(even(0, 0), alike(0, 0)));
    clock.skew_deviation = std::sqrt(std::max(even(1, 1), alike(1, 1)));
    settled = std::abs(change[0]) < 0.1 * clock.offset_deviation;
    told = std::sqrt(even(0, 0)) < kWorstOffset;
    // Chi squared and Hotelling's T squared, of two: both must find it strange.
    const double free = static_cast<double>(fit.parts.size()) - 1;
    clock.differs = surprise(even) > -2 * std::log(kChance) &&
                    surprise(alike) > free * (std::pow(kChance, -2 / (free - 1)) - 1);
  }
  const bool found =
      settled && std::abs(clock.offset) < 1.1 * kFarthest && std::abs(clock.skew) < 0.02 && told;
  return found ? std::optional(clock) : std::nullopt;
}

} // namespace patina
