#include "field/sampling/line_profile.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace patina {

std::vector<LineSample> profileAlong(const FieldSampler& sampler, const Vec3& from, const Vec3& to,
                                     std::size_t count) {
  const double length = (to - from).norm();
  if (!(length > 0 && std::isfinite(length))) throw Error("a line needs two ends that differ");
  std::vector<LineSample> profile(std::max<std::size_t>(2, count));
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(profile.size() - 1);
    LineSample& sample = profile[i];
    sample.along = part * length;
    sample.point = from + part * (to - from);
    const GridSample found = sampler.at(sample.point);
    sample.phi =
        found.region == FieldRegion::band ? found.phi : std::numeric_limits<double>::quiet_NaN();
  }
  return profile;
}

} // namespace patina
