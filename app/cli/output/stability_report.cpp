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

// Small ratios are what the map is for: 0.00042, not 0.000.
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

Json stabilityJson(const SurfaceStability& stability, const Scene& scene) {
  const StabilityMap& map = stability.map;
  Json json = Json::object();
  json.set("ratio_min", map.worst_ratio);
  json.set("at", vectorJson(stability.surface->positions[map.worst]));
  json.set("ratio_median", median(map.ratio));
  json.set("buzzing", share(map.buzzing, map));
  json.set("slipping", share(map.slipping, map));
  json.set("jumping", share(map.jumping, map));
  json.set("limit", map.limits.plain);
  json.set("limit_damped", map.limits.damped);
  json.set("coupled", map.limits.coupled());
  json.set("device_given", scene.device_model.has_value());
  return json;
}

TextRows stabilityRows(const SurfaceStability& stability, const Scene& scene) {
  const StabilityMap& map = stability.map;
  const Vec3& at = stability.surface->positions[map.worst];
  const auto percent = [&](std::size_t count) { return rounded(100 * share(count, map)) + " %"; };
  std::string where = "smallest K*/K " + ratioText(map.worst_ratio) + " at " +
                      formatLength(at.x()) + ", " + formatLength(at.y()) + ", " +
                      formatLength(at.z()) + "; median " + ratioText(median(map.ratio));
  if (map.buzzing) where += "; " + percent(map.buzzing) + " of the surface is below 1: it buzzes";
  TextRows rows = {{"stability", where}};
  if (map.slipping)
    rows.emplace_back("slipping",
                      percent(map.slipping) +
                          ": a light grip does not hold the tip there; judged as a plane");
  if (map.jumping) rows.emplace_back("jumping", percent(map.jumping) + ": the force jumps; grey");
  rows.emplace_back("device", deviceText(scene));
  if (map.limits.coupled()) rows.emplace_back("coupling", "on: the map is of the coupled loop");
  return rows;
}

} // namespace patina::cli
