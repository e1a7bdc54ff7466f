#include "app/gui/aligning/around_place.h"

#include "acquisition/registration/error_map.h"
#include "core/error.h"

namespace patina {

void AroundPlace::forget() {
  job_.silence(); // also of a map that is not here yet
  if (error_.empty()) return;
  error_.clear();
  emit errorChanged();
}

void AroundPlace::look() {
  plot_->setBasin(std::nullopt);
  forget();
  std::vector<double> rms;
  for (const Pose& step : alignment_.steps())
    rms.push_back(residualsOf(*alignment_.target(), alignment_.points(), step).rms);
  rms.resize(alignment_.done() + 1);
  plot_->setSteps(rms);
  job_.start([this, target = alignment_.target(), points = alignment_.points(),
              path = alignment_.path(), found = alignment_.found(),
              pose = alignment_.pose()](Progress& progress, const Background::Deliver& deliver) {
    try {
      const Registration at = found ? *found : registeredAt(*target, path, pose);
      deliver(false,
              [this, error = errorMapOf(target->mesh(), at, kErrorReach * target->extent())] {
                error_ = error;
                emit errorChanged();
              });
      const Basin basin = basinOf(*target, points, pose, progress);
      deliver(true, [this, basin] { plot_->setBasin(basin); });
    } catch (const Cancelled&) {
      deliver(true, [] {});
    }
  });
}

} // namespace patina
