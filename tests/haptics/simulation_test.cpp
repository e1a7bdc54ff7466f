// Compares the report of a simulated run with its own rows and an independent body.
#include "haptics/simulation/simulation.h"

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/law/limit_stage.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

struct Tick {
  Vec3 tip;
  double dt;
  LawOutput felt;
};
struct Recorded {
  SimulationSpec spec;
  std::vector<Tick> ticks;
  std::vector<SimulationRow> rows;
  SimulationReport report;
};

// A damped wall below `surface`, with an occasional fault.
Recorded recorded(const SimulationSpec& spec, double stiffness, double damping) {
  Recorded run{spec, {}, {}, {}};
  Vec3 last = Vec3::Zero();
  const ForceLaw law = [&](const Vec3& tip, double dt) {
    LawOutput felt;
    felt.depth = (tip - spec.surface).dot(spec.inward);
    felt.touching = felt.depth > 0;
    felt.fault = run.ticks.size() % 7 == 3;
    if (felt.touching)
      felt.force = -stiffness * felt.depth * spec.inward -
                   (run.ticks.empty() ? 0.0 : damping / dt) * (tip - last);
    last = tip;
    run.ticks.push_back({tip, dt, felt});
    return felt;
  };
  Progress progress;
  run.report =
      simulate(law, spec, progress, [&](const SimulationRow& row) { run.rows.push_back(row); });
  return run;
}

SimulationSpec randomSpec(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  SimulationSpec spec;
  spec.device.mass = 0.05 + unit(random);
  spec.device.damping = 2 * unit(random);
  spec.device.delay = static_cast<int>(random() % 3);
  spec.device.rate = random() % 2 ? 1000 : 500;
  if (random() % 2) spec.device.encoder_step = 1e-5;
  if (random() % 2) spec.hand = {0.2 * unit(random), unit(random), 100 * unit(random)};
  spec.press = 2 * unit(random);
  spec.surface = 0.1 * randomDirection(random);
  spec.inward = random() % 2 ? randomDirection(random) : Vec3(-Vec3::UnitY());
  spec.depth = 2e-3 * (unit(random) - 0.5);
  spec.speed = 0.1 * (unit(random) - 0.3);
  spec.seconds = 3 + unit(random);
  if (random() % 3 == 0) spec.saturation = 0.5 + unit(random);
  if (random() % 3 == 0) spec.jitter = PeriodRange{0.5e-3, 2e-3};
  if (random() % 3 == 0) spec.missed = MissedTick{1 + unit(random), 0.01};
  if (random() % 3 == 0) spec.teleport = Teleport{2 * unit(random), 1e-3 * randomDirection(random)};
  if (random() % 4 == 0) spec.rate_limit = 2000 * unit(random);
  return spec;
}

// Checks tick lengths, delayed forces, and the body's motion.
void expectTicks(const Recorded& run) {
  const SimulationSpec& spec = run.spec;
  const auto delay = static_cast<std::size_t>(spec.device.delay);
  const Oscillator body{spec.device.mass + spec.hand.mass, spec.device.damping + spec.hand.damping,
                        spec.hand.stiffness, 0};
  std::vector<Vec3> wanted;
  bool teleported = false, missed = false;
  for (std::size_t k = 0; k + 1 < run.rows.size(); ++k) {
    const Tick& tick = run.ticks[k];
    const SimulationRow &row = run.rows[k], &next = run.rows[k + 1];
    const double dt = next.t - row.t;
    ASSERT_NEAR(run.ticks[k + 1].dt, dt, 1e-12);
    if (spec.missed && !missed && row.t >= spec.missed->at) {
      missed = true;
      ASSERT_NEAR(dt, spec.missed->lasts, 1e-12);
    } else if (spec.jitter) {
      ASSERT_GE(dt, spec.jitter->shortest - 1e-12);
      ASSERT_LE(dt, spec.jitter->longest + 1e-12);
    } else {
      ASSERT_NEAR(dt, 1 / spec.device.rate, 1e-12);
    }

    const double step = spec.device.encoder_step;
    ASSERT_LE((tick.tip - row.position).norm(), 0.5 * std::sqrt(3.0) * step + 1e-15);
    if (step > 0) {
      const double read = (tick.tip - spec.surface).dot(spec.inward) / step;
      ASSERT_NEAR(read, std::round(read), 1e-6);
    }
    wanted.push_back(tick.felt.force);
    if (spec.rate_limit) {
      const Vec3 last = k > 0 ? wanted[k - 1] : Vec3(Vec3::Zero());
      const Vec3 went = k > 0 ? tick.tip - run.ticks[k - 1].tip : Vec3(Vec3::Zero());
      wanted.back() = last + scaledTo(wanted.back() - last, *spec.rate_limit * went.norm());
    }
    Vec3 acts = k < delay ? Vec3(Vec3::Zero()) : wanted[k - delay];
    if (spec.saturation) acts = scaledTo(acts, *spec.saturation);
    ASSERT_LT((row.force - acts).norm(), 1e-12);

    const ZohStep held = zohStep(body, dt);
    Vec3 rest = spec.surface + spec.depth * spec.inward; // rest position of the hand's spring
    if (teleported) rest += spec.teleport->by;
    const Vec3 x = row.position - rest, force = row.force + spec.press * spec.inward;
    Vec3 to = rest + held.xx * x + held.xv * row.velocity + held.xf * force;
    if (spec.teleport && !teleported && next.t >= spec.teleport->at) {
      teleported = true;
      to += spec.teleport->by;
    }
    ASSERT_LT((next.position - to).norm(), 1e-12) << k;
    const Vec3 velocity = held.vx * x + held.vv * row.velocity + held.vf * force;
    ASSERT_LT((next.velocity - velocity).norm(), 1e-12) << k;
  }
}

// rms velocity of the rows from `from` on, up to `to`.
double rms(const Recorded& run, double from, double to) {
  double sum = 0, count = 0;
  for (const SimulationRow& row : run.rows) {
    if (row.t < from - 1e-9 || row.t >= to - 1e-9) continue;
    sum += row.velocity.squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

void expectReport(const Recorded& run) {
  const SimulationSpec& spec = run.spec;
  const SimulationReport& report = run.report;
  const double end = spec.seconds;
  ASSERT_EQ(report.ticks, run.ticks.size());
  ASSERT_EQ(report.ticks, run.rows.size());
  ASSERT_LT(run.rows.back().t, end);
  EXPECT_NEAR(report.rms_early, rms(run, 1, 2), 1e-12);
  EXPECT_NEAR(report.rms_middle, rms(run, 0.5 * end - 0.5, 0.5 * end + 0.5), 1e-12);
  EXPECT_NEAR(report.rms_velocity, rms(run, end - 1, end), 1e-12);
  EXPECT_EQ(report.stable,
            report.rms_velocity < 1e-8 || report.rms_velocity < 0.9 * report.rms_early);

  std::uint64_t contacts = 0, faults = 0;
  double depth = 0, force = 0, late_force = 0, late_depth = 0, gained = 0;
  bool touches_late = false, lifts_late = false;
  const double mass = spec.device.mass + spec.hand.mass;
  Vec3 rest = spec.surface + spec.depth * spec.inward;
  bool teleported = false;
  for (std::size_t k = 0; k < run.rows.size(); ++k) {
    const SimulationRow& row = run.rows[k];
    const LawOutput& felt = run.ticks[k].felt;
    contacts += felt.touching;
    faults += felt.fault;
    depth = std::max(depth, felt.depth);
    force = std::max(force, row.force.norm());
    if (spec.teleport && !teleported && row.t >= spec.teleport->at) {
      teleported = true;
      rest += spec.teleport->by;
    }
    const Vec3 x = row.position - rest;
    const double energy =
        0.5 * (mass * row.velocity.squaredNorm() + spec.hand.stiffness * x.squaredNorm()) -
        spec.press * x.dot(spec.inward);
    gained = std::max(gained, energy - 0.5 * mass * spec.speed * spec.speed);
    if (row.t < end - 1 - 1e-9) continue;
    (felt.touching ? touches_late : lifts_late) = true;
    late_force -= row.force.dot(spec.inward);
    late_depth += (row.position - spec.surface).dot(spec.inward);
  }
  EXPECT_EQ(report.contact_ticks, contacts);
  EXPECT_EQ(report.fault_ticks, faults);
  EXPECT_EQ(report.max_depth, depth);
  EXPECT_EQ(report.max_force, force);
  EXPECT_NEAR(report.energy_gained, gained, 1e-12);
  EXPECT_EQ(report.touches_late, touches_late);
  ASSERT_EQ(report.stiffness_displayed.has_value(), touches_late && !lifts_late && late_depth > 0);
  if (report.stiffness_displayed) {
    EXPECT_NEAR(*report.stiffness_displayed / (late_force / late_depth), 1, 1e-9);
  }

  double absorbed = 0;
  for (std::size_t k = 0; k + 1 < run.rows.size(); ++k) {
    EXPECT_NEAR(run.rows[k].energy, absorbed, 1e-12);
    const SimulationRow& next = run.rows[k + 1];
    Vec3 went = next.position - run.rows[k].position;
    const bool jumps =
        spec.teleport && run.rows[k].t < spec.teleport->at && next.t >= spec.teleport->at;
    if (jumps) went -= spec.teleport->by;
    absorbed -= run.rows[k].force.dot(went);
  }
}

TEST(Simulation, ReportMatchesItsRowsAndMovesTheBodyExactly) {
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const SimulationSpec spec = randomSpec(random);
    const Recorded done = recorded(spec, 300, 0.5 * (round % 3));
    expectTicks(done);
    expectReport(done);
    if (HasFatalFailure()) return;
  }
}

// Finds the first contact that began with a speed, until its last force has acted.
TEST(Simulation, RestitutionIsSpeedOutOverSpeedIn) {
  for (const int delay : {0, 1, 2}) {
    SimulationSpec spec;
    spec.device.damping = 0;
    spec.device.delay = delay;
    spec.depth = -1e-3;
    spec.speed = 0.1;
    spec.seconds = 3;
    const Recorded done = recorded(spec, 400, 0.3);
    double in = 0;
    std::optional<double> ratio;
    const auto late = static_cast<std::size_t>(delay); // its last force acts so many ticks later
    for (std::size_t k = 1; k + late < done.rows.size() && !ratio; ++k) {
      if (done.ticks[k].felt.touching && in == 0) in = done.rows[k].velocity.dot(spec.inward);
      if (done.ticks[k - 1].felt.touching && !done.ticks[k].felt.touching)
        ratio = -done.rows[k + late].velocity.dot(spec.inward) / in;
    }
    ASSERT_TRUE(done.report.restitution && ratio);
    EXPECT_NEAR(*done.report.restitution, *ratio, 1e-12) << delay;
    EXPECT_EQ(done.report.verdict, Verdict::kLeftSurface);
    spec.press = 0.1; // the tip may return now, and does
    EXPECT_NE(recorded(spec, 400, 0.3).report.verdict, Verdict::kLeftSurface);
  }
}

TEST(Simulation, ReportsItsProgressAndStopsIfCancelled) {
  SimulationSpec spec;
  spec.seconds = 30;
  std::vector<double> told;
  std::size_t ticks = 0;
  const ForceLaw law = [&](const Vec3&, double) {
    ++ticks;
    return LawOutput{};
  };
  Progress all([&](double fraction, std::string_view) { told.push_back(fraction); });
  simulate(law, spec, all);
  ASSERT_GE(told.size(), 4U);
  for (std::size_t i = 0; i + 1 < told.size(); ++i)
    EXPECT_NEAR(told[i], 8192.0 * static_cast<double>(i) / 30000, 1e-12);
  EXPECT_EQ(told.back(), 1);

  Progress* self = nullptr;
  Progress some([&](double fraction, std::string_view) {
    if (fraction > 0.2) self->cancel();
  });
  self = &some;
  ticks = 0;
  EXPECT_THROW(simulate(law, spec, some), Cancelled);
  EXPECT_EQ(ticks, 2 * 8192U);
}

TEST(Simulation, RefusesEachValueOutOfRange) {
  const auto refused = [](auto change) {
    SimulationSpec spec;
    change(spec);
    Progress progress;
    EXPECT_THROW(
        simulate(ForceLaw([](const Vec3&, double) { return LawOutput{}; }), spec, progress),
        std::invalid_argument);
  };
  const double inf = std::numeric_limits<double>::infinity();
  refused([](auto& s) { s.seconds = 2.9; });
  refused([&](auto& s) { s.seconds = inf; });
  refused([](auto& s) { s.device.rate = 0; });
  refused([](auto& s) { s.device.encoder_step = -1e-6; });
  refused([](auto& s) { s.device.delay = -1; });
  refused([](auto& s) { s.saturation = 0; });
  refused([](auto& s) { s.jitter = PeriodRange{0, 1e-3}; });
  refused([](auto& s) { s.jitter = PeriodRange{2e-3, 1e-3}; });
  refused([](auto& s) { s.missed = MissedTick{0, 0}; });
  refused([](auto& s) { s.inward = Vec3(0, 0, 1.001); });
  refused([&](auto& s) { s.press = inf; });
  refused([&](auto& s) { s.depth = inf; });
  refused([&](auto& s) { s.speed = -inf; });
  refused([&](auto& s) { s.surface = Vec3(inf, 0, 0); });
}

} // namespace
} // namespace patina
