#include "app/cli/output/stability_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {
namespace {

double median(std::vector<float> values) {
  std::erase_if(values, [](float v) { return std::isnan(v); });
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double share(std::size_t count, const StabilityMap& map) {
  return static_cast<double>(count) / static_cast<double>(map.ratio.size());
}

// Small ratios matter most: 0.00042, not 0.000.
std::string ratioText(double ratio) {
  if (ratio >= 0.9995) return rounded(ratio);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", ratio);
  return text;
}

std::string deviceText(const Scene& scene) {
  const DeviceModel device = scene.device_model.value_or(DeviceModel{});
  std::string text = rounded(device.mass) + " kg, " + rounded(device.damping) + " N s/m, " +
                     rounded(device.rate) + " Hz";
  if (device.delay) text += ", delay " + std::to_string(device.delay);
  return scene.device_model ? text : text + " (assumed: the scene has no device.* values)";
}

} // namespace

SurfaceStability requiredStability(const CompiledScene& compiled, Progress& progress) {
  auto stability = surfaceStability(compiled, progress);
  if (!stability)
    throw Error("stability: nothing of this surface can be pressed; thin sheets need a tip.radius");
  return std::move(*stability);
}

const Keys& stabilityKeys() {
  static const Keys keys = {
      {"ratio_min", "", "stability", "smallest K*/K of the surface"},
      {"at", "m", "where", "", Shown::never},
      {"ratio_median", "", "median K*/K", "", Shown::never},
      {"buzzing", "", "buzzing", "fraction of the surface below 1", Shown::never},
      {"slipping", "", "slipping", "fraction that a light grip does not hold", Shown::if_any},
      {"jumping", "", "jumping", "fraction where the force jumps", Shown::if_any},
      {"limit", "N/m", "limit", "", Shown::never},
      {"limit_damped", "N/m", "damped limit", "", Shown::never},
      {"device_given", "", "device", "the scene's, not the assumed one"},
      {"coupled", "", "coupling", "", Shown::if_any}};
  return keys;
}

Report stabilityReport(const SurfaceStability& stability, const Scene& scene) {
  const StabilityMap& map = stability.map;
  const Vec3& at = stability.surface->positions[map.worst];
  const double middle = median(map.ratio);
  const auto percent = [&](std::size_t count) { return rounded(100 * share(count, map)) + " %"; };
  std::string where = "smallest K*/K " + ratioText(map.worst_ratio) + " at " +
                      shown(vectorJson(at), "m") + "; median " + ratioText(middle);
  if (map.buzzing) where += "; " + percent(map.buzzing) + " of the surface is below 1: it buzzes";
  Report report(stabilityKeys());
  report.set("ratio_min", map.worst_ratio, where);
  report.set("at", vectorJson(at)).set("ratio_median", middle);
  report.set("buzzing", share(map.buzzing, map));
  report.set("slipping", share(map.unstable_count, map),
             percent(map.unstable_count) +
                 ": a light grip does not hold the tip there; judged as a plane");
  report.set("jumping", share(map.discontinuous_count, map),
             percent(map.discontinuous_count) + ": the force jumps; dark");
  report.set("limit", map.limits.device_only).set("limit_damped", map.limits.damped);
  report.set("device_given", scene.device_model.has_value(), deviceText(scene));
  report.set("coupled", map.limits.coupled(), "on: the map is of the coupled loop");
  return report;
}

} // namespace patina::cli
