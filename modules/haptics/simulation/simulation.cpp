#include "haptics/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "haptics/law/limit_stage.h"
#include "haptics/loop_model/zoh_body.h"

namespace patina {
namespace {

constexpr double kStillVelocity = 1e-8; // RMS [m/s]
constexpr double kSettling = 0.9;       // fraction of the second second's RMS velocity
// Fraction of the middle second's RMS velocity, which a permanent bounce approaches from above.
constexpr double kStillSettling = 0.95;
constexpr double kNearlyAtRest =
    1e-3; // fraction of the second second's; smaller values are rounding
constexpr double kMaxRestitution = 10;
constexpr double kMinSeconds = 3;
constexpr std::uint64_t kReportEvery = 8192; // ticks

void check(const SimulationSpec& s) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("simulate: ") + what);
  };
  require(s.seconds >= kMinSeconds && std::isfinite(s.seconds), "a run takes 3 s or more");
  require(s.device.rate > 0 && s.device.encoder_step >= 0 && s.device.delay >= 0,
          "rate must be above 0, encoder step and delay not below");
  require(!s.saturation || *s.saturation > 0, "saturation must be above 0");
  require(!s.jitter || (s.jitter->shortest > 0 && s.jitter->longest >= s.jitter->shortest),
          "the shortest period must be above 0 and not above the longest");
  require(!s.missed || s.missed->lasts > 0, "a missed tick must last longer than 0 s");
  require(std::abs(s.inward.norm() - 1) < 1e-9, "inward must be a unit vector");
  require(std::isfinite(s.press + s.depth + s.speed) && s.surface.allFinite(),
          "the start must be finite");
}

// Adds two perpendicular unit vectors; for a world axis exactly the other two.
Eigen::Matrix3d axesFrom(const Vec3& inward) {
  int least = 0;
  inward.cwiseAbs().minCoeff(&least);
  Eigen::Matrix3d axes;
  axes.col(0) = inward;
  axes.col(1) = inward.cross(Vec3(Vec3::Unit(least))).normalized();
  axes.col(2) = inward.cross(Vec3(axes.col(1)));
  return axes;
}

// Device and hand on three axes, the first one inward; depth and encoder count from `surface`.
class Body {
 public:
  explicit Body(const SimulationSpec& spec)
      : frame_(axesFrom(spec.inward)), surface_(spec.surface), start_(spec.depth, 0, 0),
        press_(spec.press),
        encoder_(spec.device.encoder_step), oscillator_{spec.device.mass + spec.hand.mass,
                                                        spec.device.damping + spec.hand.damping,
                                                        spec.hand.stiffness, spec.device.coulomb},
        held_(oscillator_, 1 / spec.device.rate) {
    held_.axes[0].v = spec.speed;
  }

  double depth() const { return start_[0] + held_.axes[0].x; }
  double inwardVelocity() const { return held_.axes[0].v; }
  Vec3 fromSurface() const { return start_ + held_.position(); }
  Vec3 position() const { return surface_ + frame_ * fromSurface(); }
  Vec3 velocity() const { return frame_ * held_.velocity(); }
  Vec3 measured() const { return surface_ + frame_ * encoded(fromSurface(), encoder_); }
  // Kinetic energy and the hand spring's, minus the work of the press.
  double energy() const {
    double sum = -press_ * held_.axes[0].x;
    for (const Motion& axis : held_.axes)
      sum += 0.5 * (oscillator_.mass * axis.v * axis.v + oscillator_.spring * axis.x * axis.x);
    return sum;
  }
  void teleport(const Vec3& by) { start_ += frame_.transpose() * by; }

  // Applies a constant force and returns the displacement.
  Vec3 advance(const Vec3& force, double seconds) {
    return frame_ * held_.advance(frame_.transpose() * force + Vec3(press_, 0, 0), seconds);
  }

 private:
  Eigen::Matrix3d frame_; // world_from_device
  Vec3 surface_;
  Vec3 start_; // device frame
  double press_;
  double encoder_;
  Oscillator oscillator_;
  ZohBody held_;
};

// Generates the tick lengths.
class Clock {
 public:
  explicit Clock(const SimulationSpec& spec)
      : period_(1 / spec.device.rate), jitter_(spec.jitter), missed_(spec.missed),
        random_(spec.seed) {}
  double next(double t) {
    if (missed_ && t >= missed_->at) {
      const double lasts = missed_->lasts;
      missed_.reset();
      return lasts;
    }
    if (!jitter_) return period_;
    constexpr double kScale = 1.0 / 4294967296.0;
    return jitter_->shortest + (jitter_->longest - jitter_->shortest) * kScale * random_();
  }

 private:
  double period_;
  std::optional<PeriodRange> jitter_;
  std::optional<MissedTick> missed_;
  std::mt19937 random_;
};

// Measures incoming and outgoing speed of the first contact.
class Bounce {
 public:
  explicit Bounce(int delay) : delay_(delay) {}
  void observe(bool touching, double inward_velocity) {
    if (ratio_) return;
    if (touching) {
      if (!inside_ && inward_velocity > 0) in_ = inward_velocity;
      inside_ = true;
      since_left_ = 0;
    } else if (in_ > 0 && since_left_++ == delay_) {
      ratio_ = -inward_velocity / in_;
    }
  }
  std::optional<double> ratio() const { return ratio_; }

 private:
  int delay_;
  bool inside_ = false;
  double in_ = 0;
  int since_left_ = 0;
  std::optional<double> ratio_;
};

struct MeanSquare {
  double sum = 0;
  std::uint64_t count = 0;
  void add(double square) {
    sum += square;
    ++count;
  }
  double root() const { return count ? std::sqrt(sum / static_cast<double>(count)) : 0; }
};

// RMS velocities of single seconds may fall by chance if the tip is thrown far; its energy then
// exceeds that of start and press.
Verdict judge(const SimulationReport& run, double accounted) {
  if (!run.touches_late && run.contact_ticks > 0) return Verdict::kLeftSurface;
  if (run.rms_velocity < kStillVelocity) return Verdict::kAtRest;
  const bool calmer = run.stable && (run.rms_velocity < kStillSettling * run.rms_middle ||
                                     run.rms_velocity < kNearlyAtRest * run.rms_early);
  return calmer && run.energy_gained <= accounted ? Verdict::kDecaying : Verdict::kUnstable;
}

} // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
  case Verdict::kLeftSurface:
    return "left the surface";
  case Verdict::kAtRest:
    return "at rest";
  case Verdict::kDecaying:
    return "calming down";
  case Verdict::kUnstable:
    break;
  }
  return "does not settle";
}

SimulationReport simulate(const ForceLaw& law, const SimulationSpec& spec, Progress& progress,
                          const RowSink& row) {
  check(spec);
  Body body(spec);
  DelayLine line(spec.device.delay);
  Clock clock(spec);
  Bounce bounce(spec.device.delay);
  bool teleports = spec.teleport.has_value();
  SimulationReport report;
  MeanSquare early, middle, late;
  const double half = 0.5 * spec.seconds, energy_before = body.energy();
  double stored = 0; // energy in the surface at the start [J]
  bool lifts_late = false;
  double late_force = 0, late_depth = 0, t = 0, dt = 1 / spec.device.rate;
  Vec3 last_tip = body.measured(), last_force = Vec3::Zero();
  const double ticks = spec.seconds * spec.device.rate;
  const double margin = 1e-6 / spec.device.rate; // rounding of a sum of periods
  for (std::uint64_t k = 0; t < spec.seconds - margin; ++k) {
    if (k % kReportEvery == 0) {
      progress.throwIfCancelled();
      progress.report(static_cast<double>(k) / ticks, "simulating");
    }
    if (teleports && t >= spec.teleport->at) {
      body.teleport(spec.teleport->by);
      teleports = false;
    }
    const Vec3 tip = body.measured();
    const LawOutput felt = law(tip, dt);
    Vec3 wanted = felt.force;
    if (k == 0) stored = 0.5 * std::abs(wanted.dot(spec.inward) * spec.depth);
    if (spec.rate_limit) {
      const Vec3 change = wanted - last_force;
      wanted = last_force + scaledTo(change, *spec.rate_limit * (tip - last_tip).norm());
    }
    last_tip = tip;
    last_force = wanted;
    Vec3 force = line.exchange(wanted);
    if (spec.saturation) force = scaledTo(force, *spec.saturation);

    ++report.ticks;
    report.contact_ticks += felt.touching;
    report.fault_ticks += felt.fault;
    report.max_depth = std::max(report.max_depth, felt.depth);
    report.max_force = std::max(report.max_force, force.norm());
    bounce.observe(felt.touching, body.inwardVelocity());
    const double square = body.velocity().squaredNorm();
    if (t >= 1 - margin && t < 2 - margin) early.add(square);
    if (t >= half - 0.5 - margin && t < half + 0.5 - margin) middle.add(square);
    report.energy_gained = std::max(report.energy_gained, body.energy() - energy_before);
    if (t >= spec.seconds - 1 - margin) {
      late.add(square);
      late_force -= force.dot(spec.inward);
      late_depth += body.depth();
      report.touches_late |= felt.touching;
      lifts_late |= !felt.touching;
    }
    if (row) row({t, body.position(), body.velocity(), force, report.energy.absorbed});

    dt = clock.next(t);
    report.energy.add(force, body.advance(force, dt), spec.device.damping, dt);
    t = spec.jitter || spec.missed ? t + dt : static_cast<double>(k + 1) / spec.device.rate;
  }
  report.rms_velocity = late.root();
  report.rms_early = early.root();
  report.stable =
      report.rms_velocity < kStillVelocity || report.rms_velocity < kSettling * report.rms_early;
  // A bouncing tip has mean force and depth, but their ratio is not a stiffness.
  if (report.touches_late && !lifts_late && late_depth > 0)
    report.stiffness_displayed = late_force / late_depth;
  report.rms_middle = middle.root();
  report.verdict =
      judge(report, stored + 0.5 * (spec.device.mass + spec.hand.mass) * spec.speed * spec.speed +
                        std::abs(spec.press) * (report.max_depth + std::abs(spec.depth)));
  const std::optional<double> ratio = bounce.ratio();
  const bool lost = report.verdict == Verdict::kLeftSurface && spec.press > 0;
  if (ratio && *ratio >= 0 && *ratio <= kMaxRestitution && !lost) report.restitution = ratio;
  progress.report(1, "simulating");
  return report;
}

SimulationReport simulate(const HapticSnapshot& snapshot, const SimulationSpec& spec,
                          Progress& progress, const RowSink& row) {
  ContactMemory memory;
  const ForceLaw law = [&](const Vec3& tip, double dt) {
    const Contact contact = tick(snapshot, memory, tip, dt);
    return LawOutput{contact.force, contact.touching, contact.fault, contact.depth};
  };
  return simulate(law, spec, progress, row);
}

} // namespace patina
