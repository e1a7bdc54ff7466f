#include "acquisition/simulation/hand_gestures.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// A sum of sines; its rms is 1/sqrt(2).
class Sway {
 public:
  Sway(std::mt19937& random, double low, double high) {
    for (Sine& sine : sines_) {
      const double share = static_cast<double>(random()) / 4294967295.;
      sine.frequency = low + (high - low) * share;
      sine.phase = kTwoPi * static_cast<double>(random()) / 4294967295.;
    }
  }
  double at(double t) const {
    double sum = 0;
    for (const Sine& sine : sines_) sum += std::sin(kTwoPi * sine.frequency * t + sine.phase);
    return sum / std::sqrt(static_cast<double>(sines_.size()));
  }

 private:
  struct Sine {
    double frequency = 0, phase = 0;
  };
  std::array<Sine, 3> sines_;
};

struct Sways {
  std::array<Sway, 3> axis;
  Sways(std::mt19937& random, double low, double high)
      : axis{Sway(random, low, high), Sway(random, low, high), Sway(random, low, high)} {}
  Vec3 at(double t) const { return {axis[0].at(t), axis[1].at(t), axis[2].at(t)}; }
};

Eigen::Quaterniond turned(const Vec3& angles) {
  return Eigen::AngleAxisd(angles.x(), Vec3::UnitX()) *
         Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(angles.z(), Vec3::UnitZ());
}

// Steps from 0 to 1 within `lasting`, at rest at both ends (Flash & Hogan 1985).
double minimumJerk(double t, double lasting) {
  const double x = std::clamp(t / lasting, 0., 1.);
  return x * x * x * (10 - 15 * x + 6 * x * x);
}

// Distance at unit speed from rest to rest; starts at 0 and stops at `lasting`, both within a few
// times `softness` [s].
double startAndStop(double t, double lasting, double softness) {
  const auto ramp = [&](double x) {
    return x > 30 * softness ? x : softness * std::log1p(std::exp(x / softness));
  };
  return ramp(t) - ramp(t - lasting);
}

// The motion without tremor; `sway` are slow, `quick` are faster sways.
HandState motionAt(HandGesture kind, const Sways& sway, const Sways& quick, double t) {
  HandState state;
  Vec3 angles = 0.2 * quick.at(0.7 * t);
  switch (kind) {
  case HandGesture::slow:
    state.tip = 0.04 * sway.at(t) + Vec3(0, 0, 0.1);
    angles = 0.2 * sway.at(t + 50);
    break;
  case HandGesture::fast:
    state.tip = 0.06 * quick.at(t) + Vec3(0, 0, 0.15);
    angles = 0.4 * quick.at(0.7 * t + 50);
    break;
  case HandGesture::turning: {
    constexpr double kPeriod = 0.65, kLasting = 0.25;
    const double count = std::floor(t / kPeriod);
    const double there = minimumJerk(t - count * kPeriod, kLasting);
    // The hand turns between attitudes that the sways draw.
    const Vec3 from = 0.6 * sway.at(7.3 * count), to = 0.6 * sway.at(7.3 * (count + 1));
    angles = from + there * (to - from);
    state.tip = 0.02 * sway.at(t) + 0.03 * angles + Vec3(0, 0, 0.1);
    break;
  }
  case HandGesture::tapping: {
    // A rebound |sin| whose corners take about 5 ms.
    const double phase = std::numbers::pi * (3 * t + 0.1 * std::sin(kTwoPi * 0.31 * t));
    constexpr double kCorner = 0.05;
    const double height = std::sqrt(std::pow(std::sin(phase), 2) + kCorner * kCorner) - kCorner;
    state.tip = Vec3(0.03 * sway.axis[0].at(t), 0.03 * sway.axis[1].at(t), 0.03 * height);
    angles = 0.15 * sway.at(t + 50) + 0.15 * height * Vec3(1, 0.3, 0.1);
    state.touching = height < 0.05;
    state.force = state.touching ? 2 * (1 - height / 0.05) : 0;
    break;
  }
  case HandGesture::stopping: {
    constexpr double kPeriod = 0.8, kLasting = 0.3, kSpeed = 0.4, kSoftness = 4e-3;
    const double count = std::floor(t / kPeriod), since = t - count * kPeriod - 0.25;
    const bool back = std::fmod(std::abs(count), 2) == 1;
    const double along = kSpeed * startAndStop(since, kLasting, kSoftness),
                 whole = kSpeed * kLasting;
    const double place = back ? whole - along : along;
    state.tip = Vec3(place - whole / 2, 0.3 * place, 0) + 0.01 * sway.at(t) + Vec3(0, 0, 0.05);
    angles = 0.1 * sway.at(t + 50) + place * Vec3(0.3, 1, 0.5);
    break;
  }
  }
  state.orientation = turned(angles);
  return state;
}

} // namespace

const char* nameOf(HandGesture gesture) {
  switch (gesture) {
  case HandGesture::slow:
    return "slow";
  case HandGesture::fast:
    return "fast";
  case HandGesture::turning:
    return "turning";
  case HandGesture::tapping:
    return "tapping";
  case HandGesture::stopping:
    return "stopping";
  }
  return "";
}

SimulatedHand gesture(HandGesture kind, std::uint32_t seed, double seconds) {
  SimulatedHand hand;
  hand.seed = seed;
  hand.moves = {{Vec2(0, 0), seconds, 0, 0, 1}};
  std::mt19937 random(seed);
  const Sways sway(random, 0.1, 0.4), quick(random, 0.7, 2), tremor(random, 8, 11);
  hand.gesture = [kind, sway, quick, tremor, amplitude = hand.tremor,
                  tilt = hand.tremor_tilt](double t) {
    HandState state = motionAt(kind, sway, quick, t);
    state.tip += amplitude * tremor.at(t);
    state.orientation = state.orientation * turned(tilt * tremor.at(t + 20));
    return state;
  };
  return hand;
}

} // namespace patina
