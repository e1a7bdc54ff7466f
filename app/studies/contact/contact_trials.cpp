#include "app/studies/contact/contact_trials.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "app/studies/contact/scenes.h"

namespace patina {
namespace {

constexpr double kDeepest = 8e-3; // [m]

// Returns true if the method reports a relocation in this tick.
template <class AnyContact> bool snapped(const AnyContact& contact) {
  if constexpr (requires { contact.snap; })
    return contact.snap;
  else
    return false;
}

template <class T> void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

} // namespace

void TrialReport::add(const TrialReport& other) {
  ticks += other.ticks;
  contacts += other.contacts;
  lost += other.lost;
  pulls += other.pulls;
  faults += other.faults;
  relocations += other.relocations;
  unverified += other.unverified;
  excesses += other.excesses;
  worst_excess = std::max(worst_excess, other.worst_excess);
  append(error, other.error);
  append(error_at, other.error_at);
  append(relocation_error, other.relocation_error);
  append(free_error, other.free_error);
  append(samples, other.samples);
  append(entry_samples, other.entry_samples);
  append(ns, other.ns);
}

ContactMethod methodOf(const HapticSnapshot& snapshot) {
  const auto memory = std::make_shared<ContactMemory>();
  return {[memory, &snapshot](const Vec3& tip, double dt) {
            return patina::tick(snapshot, *memory, tip, dt);
          },
          [memory] { memory->reset(); }, snapshot.field->grid.voxel};
}

ContactMethod exactProxy(const ExactSurface& surface, double iso, double voxel) {
  struct Memory {
    bool known = false;
    Vec3 tip = Vec3::Zero(), c = Vec3::Zero();
  };
  const auto memory = std::make_shared<Memory>();
  return {[memory, iso, &surface](const Vec3& tip, double dt) {
            if (!memory->known) *memory = {true, tip, tip};
            const double ball = (tip - memory->tip).norm() + kOwnSpeed * dt;
            *memory = {true, tip, proxyOracle(surface, iso, tip, memory->c, ball).point};
            Contact contact;
            contact.tip = tip;
            contact.dt = dt;
            contact.frictionless_point = contact.vcp = memory->c;
            contact.depth = (memory->c - tip).norm();
            contact.touching = contact.depth > 0;
            contact.force = kTestStiffness * (memory->c - tip);
            return contact;
          },
          [memory] { memory->known = false; }, voxel};
}

ContactChecker::ContactChecker(ContactMethod method, const ExactSurface& surface, double iso)
    : method_(std::move(method)), surface_(surface), iso_(iso), voxel_(method_.voxel) {}

void ContactChecker::restart() {
  method_.forget();
  has_last_ = false;
  depth_ = 0;
}

Contact ContactChecker::feel(const Vec3& tip, TrialReport& report, double dt) {
  const auto begin = std::chrono::steady_clock::now();
  const Contact now = method_.tick(tip, dt);
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  ++report.ticks;
  if (now.fault || !now.force.allFinite()) ++report.faults;
  if (!has_last_) {
    has_last_ = true;
    own_ = tip;
    last_ = now;
    return now;
  }
  const double step = (tip - last_.tip).norm(), ball = step + kOwnSpeed * dt;
  const double excess =
      (now.force - last_.force).norm() - kTestStiffness * (2 * step + kOwnSpeed * dt);
  // NaN counts as the worst excess.
  report.worst_excess = std::max(report.worst_excess, std::isfinite(excess) ? excess : 1e9);
  report.excesses += !(excess <= 0.05);

  if (last_.touching)
    report.samples.push_back(now.samples);
  else if (now.touching || now.samples > 1)
    report.entry_samples.push_back(now.samples);

  Vec3 seed = own_;
  if (last_.touching) {
    if (surface_.distance(last_.frictionless_point) > iso_ - voxel_)
      seed = last_.frictionless_point;
  } else if (surface_.distance(last_.tip) > iso_ - 0.75 * voxel_) {
    seed = last_.tip;
  }
  const ProxyAnswer answer = proxyOracle(surface_, iso_, tip, seed, ball);
  const ProxyAnswer own = proxyOracle(surface_, iso_, tip, own_, ball);
  own_ = own.point;
  last_ = now;
  depth_ = std::max((answer.point - tip).norm(), (own_ - tip).norm());
  const bool in_contact = (answer.found && (answer.point - tip).norm() > 0.5 * voxel_) ||
                          isCertainlyInside(surface_, iso_, 0.75 * voxel_, tip);
  if (!answer.found) ++report.unverified;
  if (in_contact) {
    ++report.contacts;
    report.relocations += snapped(now);
    report.lost += now.force.squaredNorm() == 0;
    report.pulls += answer.found && now.force.dot(answer.point - tip) < 0;
    report.ns.push_back(time.count());
  }
  if (answer.found && (in_contact || now.touching)) {
    const bool ran = snapped(now) || answer.at_ball;
    (ran ? report.relocation_error : report.error)
        .push_back((now.force - kTestStiffness * (answer.point - tip)).norm());
    if (!ran) report.error_at.push_back(answer.point);
    report.free_error.push_back((now.force - kTestStiffness * (own_ - tip)).norm());
  }
  return now;
}

TrialReport runTrials(const ContactMethod& method, const ExactSurface& surface, double iso,
                      long contacts, unsigned seed) {
  TrialReport report;
  TouchPaths paths(surface, iso, seed);
  ContactChecker checker(method, surface, iso);
  checker.restart();
  while (report.contacts < contacts && report.ticks < 4 * contacts) {
    const TouchPaths::Touch touch = paths.touch();
    if (touch.fresh) checker.restart();
    for (const Vec3& tip : touch.tips) {
      checker.feel(tip, report);
      if (checker.depth() > kDeepest) break;
    }
    if (checker.depth() > 0) paths.forget();
  }
  return report;
}

TrialReport runPath(const ContactMethod& method, const ExactSurface& surface, double iso,
                    const std::vector<Vec3>& tips) {
  TrialReport report;
  ContactChecker checker(method, surface, iso);
  checker.restart();
  for (const Vec3& tip : tips) checker.feel(tip, report);
  return report;
}

LoopReport runLoops(const ContactMethod& method, const ExactSurface& surface, double iso, int loops,
                    unsigned seed) {
  LoopReport report;
  TouchPaths paths(surface, iso, seed);
  for (int tried = 0; report.loops < loops && tried < 20 * loops; ++tried) {
    const TouchPaths::Place place = tried % 2 ? paths.placeByACrease() : paths.place();
    if (!paths.reachable(place)) continue;
    ++report.loops;
    method.forget();
    Vec3 last_tip = Vec3::Zero(), last_force = Vec3::Zero();
    double work = 0; // energy given to the hand
    bool first = true;
    for (const Vec3& tip : paths.loop(place)) {
      const Vec3 force = method.tick(tip, kTick).force;
      if (!first) work += 0.5 * (force + last_force).dot(tip - last_tip);
      first = false;
      last_tip = tip;
      last_force = force;
    }
    report.generated_energy = std::max(report.generated_energy, work);
  }
  return report;
}

} // namespace patina
