// Colour scales of what the picture shows, as the user has set them: plain values, without VTK.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/named.h"

namespace patina {

struct ValueRange {
  double low = 0, high = 1; // SI
  bool operator==(const ValueRange&) const = default;
};

// standard: the thing's own map, such as a diverging one for distance.
enum class ColorMap : std::uint8_t { standard, viridis, cividis, magma, turbo, cool_warm, greys };
inline constexpr Named<ColorMap> kColorMaps[] = {
    {ColorMap::standard, "standard"}, {ColorMap::viridis, "viridis"},
    {ColorMap::cividis, "cividis"},   {ColorMap::magma, "magma"},
    {ColorMap::turbo, "turbo"},       {ColorMap::cool_warm, "cool-warm"},
    {ColorMap::greys, "greys"}};

struct ColorScale {
  ColorMap map = ColorMap::standard;
  bool reversed = false;
  bool logarithmic = false; // needs a range above 0; otherwise the lowest colour is high / 1000
  bool symmetric = false;   // the range is widened to be symmetric about 0
  int bands = 0;            // number of colours, 2 .. 64; 0: continuous
  // The range is this one; or it leaves out this share of the values [%, 0 .. 49] at each end; or,
  // with neither, it follows the values.
  std::optional<ValueRange> range{};
  std::optional<double> percentile{};
  std::optional<double> opacity{}; // 0 .. 1; absent: the thing's own
  std::optional<int> digits{};     // digits of the scale's numbers, 1 .. 9; absent: automatic
  bool operator==(const ColorScale&) const = default;
};

// Parses "viridis,reversed,bands=8,log,symmetric,range=-2:2mm,percentile=2,opacity=0.5,digits=3",
// any of it in any order; "none" gives the default. A range is in SI, or a length with its unit.
// Throws Error naming the choices.
ColorScale parseColorScale(std::string_view text);
// Returns the text of what differs from the default, empty for the default itself.
std::string format(const ColorScale& scale);

// Scales by the name of the drawn thing; a thing without an entry has the default.
using ColorScales = std::map<std::string, ColorScale>;
// Names of all things that have a scale: "slice", "iso", "mesh", "error", "relief" and
// the material channels.
const std::vector<std::string>& coloredThings();
// Parses "slice=viridis,range=-2:2mm" into the table. Throws Error for an unknown thing.
void parseColorScaleOf(std::string_view text, ColorScales& scales);
ColorScale scaleOf(const ColorScales& scales, const std::string& thing);

// Range in which values from `found` are coloured; `sorted` holds the values, ascending, for a
// percentile, or nothing.
ValueRange shownRange(const ColorScale& scale, const ValueRange& found,
                      const std::vector<double>& sorted = {});

} // namespace patina
