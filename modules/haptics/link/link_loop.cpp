#include "haptics/link/link_loop.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace patina {
namespace {

constexpr double kPollInterval = 0.02; // [s], while the device is not open

double since(double now, double then) {
  return then < 0 ? std::numeric_limits<double>::infinity() : now - then;
}

} // namespace

LinkLoop::LinkLoop(std::unique_ptr<DeviceLink> link, const GuardSpec& guard,
                   std::shared_ptr<DeviceClock> clock, std::shared_ptr<LinkStatistics> notes)
    : link_(std::move(link)), guard_(guard), clock_(std::move(clock)), notes_(std::move(notes)) {
  if (!link_ || !clock_ || !notes_)
    throw std::invalid_argument("link loop: it needs a link, a clock and notes");
  shown_.status = reading_.status = DeviceStatus::reconnecting;
}

LinkLoop::~LinkLoop() {
  if (open_) link_->exchange(Vec3::Zero());
  link_->close();
}

const DeviceState& LinkLoop::step(const LinkCommand& command) noexcept {
  if (open_)
    exchange(command);
  else
    tryToOpen();
  notes_->status.store(shown_.status, std::memory_order_relaxed);
  return shown_;
}

void LinkLoop::tryToOpen() noexcept {
  const double now = clock_->now();
  if (now < next_try_) return clock_->waitUntil(std::min(next_try_, now + kPollInterval));
  DeviceLink::Opening opening = link_->open();
  if (!opening.answers) {
    if (opening.cause.empty()) return; // opening takes more steps
    notes_->setCause(opening.cause);
    next_try_ = clock_->now() + (opening.notified_by_hotplug ? kPollInterval : kRetryInterval);
    return;
  }
  notes_->setCause({});
  notes_->connect_count.fetch_add(1, std::memory_order_relaxed);
  open_ = true;
  reading_.status = DeviceStatus::calibrating; // the position is unknown before the first exchange
  last_exchange_ = good_at_ = clock_->now();
}

void LinkLoop::exchange(const LinkCommand& command) noexcept {
  const double before = clock_->now();
  const double looked = notes_->heartbeat_at.load(std::memory_order_relaxed);
  const ForceGuard::ForceRequest asked{command.force, since(before, command.at),
                                       looked < 0 ? 0 : before - looked,
                                       notes_->requires_deadman.load(std::memory_order_relaxed)};
  const Vec3 force = guard_.limit(asked, reading_, before - last_exchange_);
  last_exchange_ = before;
  if (command.at == last_command_) notes_->overruns.fetch_add(1, std::memory_order_relaxed);
  last_command_ = command.at;

  reading_ = link_->exchange(force);
  const double after = clock_->now();
  notes_->inhibit.store(guard_.inhibit(), std::memory_order_relaxed);
  notes_->gain.store(guard_.gain(), std::memory_order_relaxed);
  notes_->heat.store(guard_.heat(), std::memory_order_relaxed);
  const bool somewhere =
      effectiveStatus(reading_) == DeviceStatus::ok && reading_.position.allFinite();
  if (somewhere ||
      // a calibrating device responds without a position
      reading_.status == DeviceStatus::calibrating) {
    shown_ = reading_;
    good_at_ = after;
    if (somewhere)
      measured_at_ = before - reading_.age; // lower bound, for any delay of this thread
    notes_->round_trip.record(static_cast<std::int64_t>(1e9 * (after - before)));
    notes_->round_trips.fetch_add(1, std::memory_order_relaxed);
  } else {
    notes_->faults.fetch_add(1, std::memory_order_relaxed);
    if (reading_.status == DeviceStatus::ok)
      reading_.status = DeviceStatus::protocol_error; // not a number
    const bool for_good = reading_.status == DeviceStatus::gone;
    if (for_good || after - good_at_ > kFaultTimeout) leave();
  }
  shown_.age = after - measured_at_;
  if (shown_.status == DeviceStatus::ok && shown_.age > kMaxStateAge)
    shown_.status = DeviceStatus::reconnecting;
}

void LinkLoop::leave() noexcept {
  notes_->setCause(std::string("the device ") + text(reading_.status));
  link_->exchange(Vec3::Zero()); // the last command may have carried force
  link_->close();
  open_ = false;
  notes_->inhibit = ForceInhibit::device;
  notes_->gain = 0;
  shown_.status = reading_.status = DeviceStatus::reconnecting;
  next_try_ = clock_->now() + kPollInterval;
}

} // namespace patina
