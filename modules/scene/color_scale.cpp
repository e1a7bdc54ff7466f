#include "scene/color_scale.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"
#include "scene/paint/channels.h"

namespace patina {
namespace {

constexpr std::string_view kWords =
    "a map (standard, viridis, cividis, magma, turbo, cool-warm, greys), reversed, log, symmetric, "
    "bands=N, range=LOW:HIGH, percentile=P, opacity=O, digits=N";

double numberIn(std::string_view word, std::string_view text, double low, double high, bool whole) {
  const std::optional<double> value = parseNumber(text);
  if (!value || !(*value >= low && *value <= high) || (whole && *value != std::floor(*value)))
    throw Error(std::string(word) + "=" + std::string(text) + ": it must be a " +
                (whole ? "whole " : "") + "number from " + formatNumber(low) + " to " +
                formatNumber(high));
  return *value;
}

// Parses "-2:2mm"; a unit of HIGH counts for LOW too.
ValueRange rangeIn(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos)
    throw Error("range=" + std::string(text) + ": it must be LOW:HIGH");
  std::string low(text.substr(0, colon));
  const std::string high(text.substr(colon + 1));
  if (parseNumber(low) && !parseNumber(high))
    low += high.substr(high.find_last_of("0123456789.") + 1);
  const ValueRange range{parseLength(low), parseLength(high)};
  if (!(range.low < range.high))
    throw Error("range=" + std::string(text) + ": LOW must be less than HIGH");
  return range;
}

void take(std::string_view word, ColorScale& scale) {
  const auto equal = word.find('=');
  const std::string_view key = word.substr(0, equal);
  const std::string_view value = equal == std::string_view::npos ? "" : word.substr(equal + 1);
  if (const auto map = parseIn(kColorMaps, word))
    scale.map = *map;
  else if (word == "reversed")
    scale.reversed = true;
  else if (word == "log")
    scale.logarithmic = true;
  else if (word == "symmetric")
    scale.symmetric = true;
  else if (key == "bands")
    scale.bands = static_cast<int>(numberIn(key, value, 2, 64, true));
  else if (key == "range")
    scale.range = rangeIn(value), scale.percentile.reset();
  else if (key == "percentile")
    scale.percentile = numberIn(key, value, 0, 49, false), scale.range.reset();
  else if (key == "opacity")
    scale.opacity = numberIn(key, value, 0, 1, false);
  else if (key == "digits")
    scale.digits = static_cast<int>(numberIn(key, value, 1, 9, true));
  else
    throw Error("'" + std::string(word) +
                "' is no word of a colour scale; known are: " + std::string(kWords));
}

} // namespace

ColorScale parseColorScale(std::string_view text) {
  ColorScale scale;
  if (text.empty() || text == "none") return scale;
  while (true) {
    const auto comma = text.find(',');
    take(text.substr(0, comma), scale);
    if (comma == std::string_view::npos) return scale;
    text.remove_prefix(comma + 1);
  }
}

std::string format(const ColorScale& scale) {
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : ",") + word; };
  if (scale.map != ColorMap::standard) add(std::string(nameIn(kColorMaps, scale.map)));
  if (scale.reversed) add("reversed");
  if (scale.logarithmic) add("log");
  if (scale.symmetric) add("symmetric");
  if (scale.bands > 0) add("bands=" + std::to_string(scale.bands));
  if (scale.range)
    add("range=" + formatNumber(scale.range->low) + ":" + formatNumber(scale.range->high));
  if (scale.percentile) add("percentile=" + formatNumber(*scale.percentile));
  if (scale.opacity) add("opacity=" + formatNumber(*scale.opacity));
  if (scale.digits) add("digits=" + std::to_string(*scale.digits));
  return text;
}

const std::vector<std::string>& coloredThings() {
  static const auto all = [] {
    std::vector<std::string> names{"slice", "iso", "mesh", "error", "relief"};
    for (const Channel& row : kChannels) names.emplace_back(row.key);
    return names;
  }();
  return all;
}

void parseColorScaleOf(std::string_view text, ColorScales& scales) {
  const auto equal = text.find('=');
  const std::string thing(text.substr(0, equal));
  const auto& all = coloredThings();
  if (equal == std::string_view::npos || std::find(all.begin(), all.end(), thing) == all.end()) {
    std::string known;
    for (const std::string& name : all) known += (known.empty() ? "" : ", ") + name;
    throw Error("'" + std::string(text) + "' is not THING=SCALE; things are: " + known);
  }
  scales[thing] = parseColorScale(text.substr(equal + 1));
}

ColorScale scaleOf(const ColorScales& scales, const std::string& thing) {
  const auto found = scales.find(thing);
  return found == scales.end() ? ColorScale{} : found->second;
}

ValueRange shownRange(const ColorScale& scale, const ValueRange& found,
                      const std::vector<double>& sorted) {
  ValueRange range = scale.range.value_or(found);
  if (scale.percentile && !sorted.empty()) {
    const double last = static_cast<double>(sorted.size() - 1);
    const auto at = [&](double share) {
      return sorted[static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * last))];
    };
    range = {at(*scale.percentile / 100), at(1 - *scale.percentile / 100)};
  }
  if (scale.symmetric) {
    const double reach = std::max(std::abs(range.low), std::abs(range.high));
    range = {-reach, reach};
  }
  if (scale.logarithmic && range.high > 0) range.low = std::max(range.low, range.high / 1000);
  if (!(range.low < range.high))
    range.high = range.low + std::max(1e-12, std::abs(range.low) * 1e-6);
  return range;
}

} // namespace patina
