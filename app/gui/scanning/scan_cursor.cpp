#include "app/gui/scanning/scan_cursor.h"

#include <algorithm>

#include "app/gui/scanning/open_scan.h"

namespace patina {
namespace {

constexpr double kSameMoment = 1e-4; // [s]

} // namespace

void ScanCursor::set(double time) {
  const Gap all = scan_.span();
  time = std::clamp(time, all.from, all.to);
  if (time == time_) return;
  time_ = time;
  emit moved();
}

void ScanCursor::rewind() {
  time_ = scan_.span().from;
}

void ScanCursor::step(int frames) {
  if (scan_.files() == nullptr) return;
  const std::vector<Frame>& all = scan_.files()->frames;
  if (all.empty()) return set(time_ + frames / 30.);
  const int last = static_cast<int>(all.size()) - 1;
  set(all[static_cast<std::size_t>(std::clamp(static_cast<int>(frame()) + frames, 0, last))].t);
}

std::size_t ScanCursor::frame() const {
  const std::vector<Frame>& frames = scan_.files()->frames;
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), time_,
                       [](const Frame& frame, double when) { return frame.t < when; });
  if (after == frames.begin()) return 0;
  const auto i = static_cast<std::size_t>(after - frames.begin());
  return after == frames.end() || time_ - frames[i - 1].t <= after->t - time_ ? i - 1 : i;
}

const Finding* ScanCursor::finding() const {
  const Finding* found = nullptr;
  if (scan_.path() != nullptr)
    for (const Finding& each : scan_.path()->findings)
      if (time_ >= each.from - kSameMoment && time_ <= each.to + kSameMoment &&
          (found == nullptr || each.to - each.from < found->to - found->from))
        found = &each;
  return found;
}

std::optional<Pose> ScanCursor::probe() const {
  const ScanPath* path = scan_.path();
  if (path == nullptr) return std::nullopt;
  const CameraTrack& track = path->filtered.track;
  if (track.empty()) {
    const auto pose = poseAt(path->poses, time_);
    return pose ? std::optional(poseOf(path->poses[*pose])) : std::nullopt;
  }
  const TipMotion motion = motionAt(track, time_);
  Pose pose = Pose::Identity();
  pose.linear() = motion.orientation.toRotationMatrix();
  pose.translation() = motion.position - motion.orientation * scan_.files()->tip();
  return pose;
}

} // namespace patina
