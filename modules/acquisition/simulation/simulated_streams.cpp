#include "acquisition/simulation/simulated_streams.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace patina {
namespace {

bool lost(const std::vector<Gap>& gaps, double t) {
  return std::any_of(gaps.begin(), gaps.end(),
                     [&](const Gap& gap) { return t >= gap.from && t < gap.to; });
}

double rounded(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

class Noise {
 public:
  explicit Noise(std::uint32_t seed) : random_(seed) {}
  double operator()(double sigma) { return sigma * normal_(random_); }
  Vec3 vector(double sigma) {
    const double x = (*this)(sigma), y = (*this)(sigma), z = (*this)(sigma);
    return {x, y, z};
  }
  bool happens(double chance) { return std::uniform_real_distribution<double>()(random_) < chance; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

Vec3 place(const HandState& state, const ProbeModel& probe, const Vec3& in_probe) {
  return state.tip + state.orientation * (in_probe - probe.tip);
}

} // namespace

std::vector<CameraPose> simulateCamera(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedCamera& camera, std::uint32_t seed) {
  Noise noise(seed);
  std::vector<CameraPose> poses;
  const HandCourse course(hand);
  const int frames = static_cast<int>(hand.seconds() * camera.rate);
  for (int frame = 0; frame < frames; ++frame) {
    const double t = frame / camera.rate;
    const HandState state = handAt(course, t);
    CameraPose pose;
    pose.t = t;
    pose.position = camera.camera_from_world * place(state, probe, Vec3::Zero()) +
                    noise.vector(camera.sigma_position);
    const Vec3 turn = noise.vector(camera.sigma_angle);
    pose.orientation = Eigen::Quaterniond(camera.camera_from_world.linear()) * state.orientation *
                       Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    pose.sigma_position = camera.sigma_position;
    pose.sigma_angle = camera.sigma_angle;
    if (noise.happens(camera.outliers)) pose.position += noise.vector(camera.outlier_size);
    if (!lost(camera.gaps, t)) poses.push_back(pose);
  }
  return poses;
}

std::vector<ProbeSample> simulateProbe(const SimulatedHand& hand, const ProbeModel& probe,
                                       const SimulatedProbe& stream, std::uint32_t seed) {
  Noise noise(seed);
  std::vector<ProbeSample> samples;
  const int count = static_cast<int>(hand.seconds() * stream.rate);
  // Second differences over one sample's time, which also prevent aliasing.
  const double reach = 0.5 / stream.rate;
  const HandCourse course(hand);
  for (int i = 0; i < count; ++i) {
    const double t = i / stream.rate;
    const HandState before = handAt(course, t - reach), now = handAt(course, t),
                    after = handAt(course, t + reach);
    ProbeSample sample;
    sample.t = t + stream.clock_offset + stream.clock_skew * t;
    for (std::size_t k = 0; k < probe.axes.size(); ++k) {
      const AccelerometerAxis& axis = probe.axes[k];
      const Vec3 acceleration =
          (place(before, probe, axis.position) - 2 * place(now, probe, axis.position) +
           place(after, probe, axis.position)) /
          (reach * reach);
      const double exact =
          axis.direction.dot(now.orientation.conjugate() * (acceleration - kGravity));
      sample.acceleration[k] = rounded(exact + stream.bias[k] + noise(probe.acceleration_noise),
                                       probe.acceleration_step);
    }
    sample.force =
        rounded(now.force + stream.force_bias + noise(probe.force_noise), probe.force_step);
    if (!lost(stream.gaps, t)) samples.push_back(sample);
  }
  return samples;
}

std::vector<RateSample> simulateRates(const SimulatedHand& hand, const ProbeModel& probe,
                                      const SimulatedProbe& stream, std::uint32_t seed) {
  Noise noise(seed);
  std::vector<RateSample> rates;
  const int count = static_cast<int>(hand.seconds() * stream.rate);
  const double reach = 0.5 / stream.rate;
  const HandCourse course(hand);
  for (int i = 0; i < count; ++i) {
    const double t = i / stream.rate;
    const Eigen::AngleAxisd turn(handAt(course, t - reach).orientation.conjugate() *
                                 handAt(course, t + reach).orientation);
    RateSample sample;
    sample.t = t + stream.clock_offset + stream.clock_skew * t;
    const double angle = std::remainder(turn.angle(), 2 * std::numbers::pi);
    sample.rate =
        angle / (2 * reach) * turn.axis() + stream.rate_bias + noise.vector(probe.rate_noise);
    if (!lost(stream.gaps, t)) rates.push_back(sample);
  }
  return rates;
}

std::vector<PathSample> truthAt(const SimulatedHand& hand, const Pose& camera_from_world,
                                const std::vector<double>& times) {
  std::vector<PathSample> truth;
  truth.reserve(times.size());
  const HandCourse course(hand);
  for (const double t : times) {
    const HandState state = handAt(course, t);
    PathSample sample;
    sample.t = t;
    sample.position = camera_from_world * state.tip;
    sample.orientation = Eigen::Quaterniond(camera_from_world.linear()) * state.orientation;
    sample.sigma = sample.sigma_angle = 0;
    sample.force = state.force;
    sample.touching = state.touching;
    truth.push_back(sample);
  }
  return truth;
}

} // namespace patina
