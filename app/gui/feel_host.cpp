#include "app/gui/feel_host.h"

namespace patina {

void FeelHost::open(std::shared_ptr<const HapticSnapshot> snapshot, const Vec3& start) {
  close();
  auto mouse = makeMouseDevice(start);
  mouse_ = mouse.get();
  loop_ = std::make_unique<ServoLoop>(std::move(mouse), 1000);
  loop_->publish(std::move(snapshot));
  loop_->start();
}

void FeelHost::publish(std::shared_ptr<const HapticSnapshot> snapshot) {
  if (loop_) loop_->publish(std::move(snapshot));
}

void FeelHost::close() {
  mouse_ = nullptr;
  loop_.reset();
}

void FeelHost::setTarget(const Vec3& target) {
  if (mouse_ != nullptr) mouse_->setTarget(target);
}

std::vector<ToolSample> FeelHost::drain() {
  std::vector<ToolSample> samples;
  if (!loop_) return samples;
  ToolSample sample;
  while (samples.size() < 20000 && loop_->samples().pop(sample)) samples.push_back(sample);
  return samples;
}

ServoTiming FeelHost::timing() const {
  return loop_ ? loop_->timing() : ServoTiming{};
}

std::size_t FeelHost::dropped() const {
  return loop_ ? loop_->samples().dropped() : 0;
}

} // namespace patina
