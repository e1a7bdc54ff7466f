#include "haptics/servo/tip_servo.h"

#include <algorithm>
#include <utility>

namespace patina {

void TipServo::open(std::unique_ptr<Device> device, std::shared_ptr<TipTarget> target,
                    double rate) {
  close();
  const auto now = std::chrono::steady_clock::now();
  target_ = std::move(target);
  auto loop = std::make_unique<ServoLoop>(std::move(device), rate);
  const std::lock_guard lock(publishers_);
  if (began_once_) {
    const double since = std::chrono::duration<double>(now - began_).count();
    offset_ = std::max(since, last_t_ + 1 / rate);
  } else {
    began_ = now;
    began_once_ = true;
  }
  loop_ = std::move(loop);
  if (newest_) loop_->publish(newest_);
  loop_->start();
}

void TipServo::publish(std::shared_ptr<const HapticSnapshot> snapshot) {
  const std::lock_guard lock(publishers_);
  newest_ = std::move(snapshot);
  if (loop_) loop_->publish(newest_);
}

void TipServo::close() {
  target_.reset();
  if (!loop_) return;
  loop_->stop();
  empty(left_);
  dropped_before_ += loop_->samples().dropped();
  const std::lock_guard lock(publishers_);
  takePaintSamplesLocked(paint_left_);
  loop_.reset();
}

void TipServo::empty(std::vector<ToolSample>& into) {
  // Bounds the loop, so that a fast servo cannot block the window.
  const std::size_t most = into.size() + 20000;
  ToolSample sample;
  while (into.size() < most && loop_->samples().pop(sample)) {
    last_t_ = sample.t += offset_;
    into.push_back(sample);
  }
}

void TipServo::setTarget(const Vec3& target) {
  if (target_) target_->set(target);
}

void TipServo::addWaypoint(const Vec3& target, double t) {
  if (target_) target_->addWaypoint(target, t);
}

void TipServo::jumpTarget(const Vec3& target, double t) {
  if (target_) target_->jumpTo(target, t);
}

bool TipServo::passed() const {
  return !target_ || target_->allReached();
}

std::vector<ToolSample> TipServo::drain() {
  if (loop_)
    if (const std::unique_lock lock(publishers_, std::try_to_lock); lock) loop_->collect();
  std::vector<ToolSample> samples = std::exchange(left_, {});
  if (loop_) empty(samples);
  return samples;
}

void TipServo::takePaintSamples(std::vector<ToolSample>& into) {
  const std::lock_guard lock(publishers_);
  into.insert(into.end(), paint_left_.begin(), paint_left_.end());
  paint_left_.clear();
  takePaintSamplesLocked(into);
}

void TipServo::takePaintSamplesLocked(std::vector<ToolSample>& into) {
  if (!loop_) return;
  for (ToolSample sample; loop_->paint_samples().pop(sample);) {
    sample.t += offset_;
    into.push_back(sample);
  }
}

ServoTiming TipServo::timing() const {
  return loop_ ? loop_->timing() : ServoTiming{};
}

std::size_t TipServo::dropped() const {
  return dropped_before_ + (loop_ ? loop_->samples().dropped() : 0);
}

} // namespace patina
