#include "haptics/devices/link/link_loop.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace patina {
namespace {

constexpr double kNap = 0.02; // [s], while there is nothing to turn with

double since(double now, double then) {
  return then < 0 ? std::numeric_limits<double>::infinity() : now - then;
}

} // namespace

LinkLoop::LinkLoop(std::unique_ptr<DeviceLink> link, const GuardSpec& guard,
                   std::shared_ptr<DeviceClock> clock, std::shared_ptr<LinkNotes> notes)
    : link_(std::move(link)), guard_(guard), clock_(std::move(clock)), notes_(std::move(notes)) {
  if (!link_ || !clock_ || !notes_)
    throw std::invalid_argument("link loop: it needs a link, a clock and notes");
  shown_.status = reading_.status = DeviceStatus::away;
}

LinkLoop::~LinkLoop() {
  if (open_) link_->turn(Vec3::Zero());
  link_->close();
}

const DeviceState& LinkLoop::step(const LinkCommand& command) noexcept {
  if (open_)
    turn(command);
  else
    tryToOpen();
  notes_->status.store(shown_.status, std::memory_order_relaxed);
  return shown_;
}

void LinkLoop::tryToOpen() noexcept {
  const double now = clock_->now();
  if (now < next_try_) return clock_->waitUntil(std::min(next_try_, now + kNap));
  DeviceLink::Opening opening = link_->open();
  if (!opening.answers) {
    if (opening.cause.empty()) return; // it merely takes time
    notes_->setCause(opening.cause);
    next_try_ = clock_->now() + (opening.told ? kNap : kTryAgain);
    return;
  }
  notes_->setCause({});
  notes_->openings.fetch_add(1, std::memory_order_relaxed);
  open_ = true;
  reading_.status =
      DeviceStatus::calibrating; // nothing is known of its place before the first turn
  last_turn_ = good_at_ = clock_->now();
}

void LinkLoop::turn(const LinkCommand& command) noexcept {
  const double before = clock_->now();
  const double looked = notes_->looked_at.load(std::memory_order_relaxed);
  const ForceGuard::Asked asked{command.force, since(before, command.at),
                                looked < 0 ? 0 : before - looked,
                                notes_->needs_button.load(std::memory_order_relaxed)};
  const Vec3 force = guard_.pass(asked, reading_, before - last_turn_);
  last_turn_ = before;
  if (command.at == last_command_) notes_->overruns.fetch_add(1, std::memory_order_relaxed);
  last_command_ = command.at;

  reading_ = link_->turn(force);
  const double after = clock_->now();
  notes_->hold.store(guard_.hold(), std::memory_order_relaxed);
  notes_->gain.store(guard_.gain(), std::memory_order_relaxed);
  notes_->heat.store(guard_.heat(), std::memory_order_relaxed);
  const bool somewhere = judge(reading_) == DeviceStatus::ok && reading_.position.allFinite();
  if (somewhere || reading_.status == DeviceStatus::calibrating) { // it answers, if from nowhere
    shown_ = reading_;
    good_at_ = after;
    if (somewhere)
      measured_at_ = before - reading_.age; // not earlier, whoever had the processor meanwhile
    notes_->round_trip.record(static_cast<std::int64_t>(1e9 * (after - before)));
    notes_->turns.fetch_add(1, std::memory_order_relaxed);
  } else {
    notes_->faults.fetch_add(1, std::memory_order_relaxed);
    if (reading_.status == DeviceStatus::ok) reading_.status = DeviceStatus::garbled; // no number
    const bool for_good = reading_.status == DeviceStatus::gone;
    if (for_good || after - good_at_ > kGiveUp) leave();
  }
  shown_.age = after - measured_at_;
  if (shown_.status == DeviceStatus::ok && shown_.age > kOldestAge)
    shown_.status = DeviceStatus::away;
}

void LinkLoop::leave() noexcept {
  notes_->setCause(std::string("the device ") + text(reading_.status));
  link_->turn(Vec3::Zero()); // the last may have carried force
  link_->close();
  open_ = false;
  notes_->hold = Hold::device;
  notes_->gain = 0;
  shown_.status = reading_.status = DeviceStatus::away;
  next_try_ = clock_->now() + kNap;
}

} // namespace patina
