#include "haptics/devices/replayed_hand.h"

#include <cmath>
#include <stdexcept>

namespace patina {
namespace {

class ReplayedHand final : public Device {
 public:
  explicit ReplayedHand(std::vector<TimedTip> path) : path_(std::move(path)) {
    const auto refuse = [](bool wrong, const char* what) {
      if (wrong) throw std::invalid_argument(std::string("replayed hand: ") + what);
    };
    refuse(path_.empty(), "no rows");
    for (std::size_t i = 0; i < path_.size(); ++i) {
      refuse(!path_[i].tip.allFinite() || !std::isfinite(path_[i].t), "a row is not finite");
      refuse(i > 0 && path_[i].t <= path_[i - 1].t, "t must increase");
    }
    t_ = path_.front().t;
  }

  DeviceState exchange(const Vec3&, double dt) noexcept override {
    t_ += dt;
    while (next_ < path_.size() && path_[next_].t <= t_) ++next_;
    if (next_ == path_.size()) return {path_.back().tip};
    const TimedTip& from = path_[next_ - 1];
    const TimedTip& to = path_[next_];
    return {from.tip + (t_ - from.t) / (to.t - from.t) * (to.tip - from.tip)};
  }

 private:
  std::vector<TimedTip> path_;
  std::size_t next_ = 1; // the first row that lies ahead
  double t_ = 0;
};

} // namespace

std::unique_ptr<Device> makeReplayedHand(std::vector<TimedTip> path) {
  return std::make_unique<ReplayedHand>(std::move(path));
}

} // namespace patina
