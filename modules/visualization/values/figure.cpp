#include "visualization/values/figure.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/named.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kInch = 0.0254;   // [m]
constexpr double kPaperDpi = 300;  // default for a width on paper
constexpr double kDpiOfText = 150; // resolution at which texts of a screen have 6 pt
constexpr double kMaxSide = 16384; // [pixels]

constexpr Named<FigureBackground> kBackgrounds[] = {{FigureBackground::as_seen, "as-seen"},
                                                    {FigureBackground::white, "white"},
                                                    {FigureBackground::transparent, "transparent"}};
constexpr Named<FigurePart> kParts[] = {{FigurePart::cube, "cube"},
                                        {FigurePart::scale, "scale"},
                                        {FigurePart::tool, "tool"},
                                        {FigurePart::legend, "legend"}};

} // namespace

FigureBackground parseFigureBackground(std::string_view text) {
  if (const auto found = parseIn(kBackgrounds, text)) return *found;
  throw Error("unknown background '" + std::string(text) + "'; choose from " +
              allNames(kBackgrounds));
}

std::set<FigurePart> parseFigureParts(std::string_view text) {
  std::set<FigurePart> parts;
  while (true) {
    const auto comma = text.find(',');
    const auto part = parseIn(kParts, text.substr(0, comma));
    if (!part)
      throw Error("unknown part '" + std::string(text.substr(0, comma)) + "'; choose from " +
                  allNames(kParts));
    parts.insert(*part);
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

std::string_view name(FigureBackground background) {
  return nameIn(kBackgrounds, background);
}

std::string_view name(FigurePart part) {
  return nameIn(kParts, part);
}

const std::vector<FigureBackground>& allFigureBackgrounds() {
  static const std::vector<FigureBackground> all{FigureBackground::as_seen, FigureBackground::white,
                                                 FigureBackground::transparent};
  return all;
}

const std::vector<FigurePart>& allFigureParts() {
  static const std::vector<FigurePart> all{FigurePart::cube, FigurePart::scale, FigurePart::tool,
                                           FigurePart::legend};
  return all;
}

FigureWidth parseFigureWidth(std::string_view text) {
  FigureWidth width;
  if (const auto number = parseNumber(text)) {
    if (!(*number >= 16 && *number <= kMaxSide && *number == std::floor(*number)))
      throw Error("'" + std::string(text) + "': a width is 16 to 16384 pixels, or as 85mm");
    width.pixels = static_cast<int>(*number);
    return width;
  }
  width.length = parseLength(text);
  if (!(*width.length > 0)) throw Error("'" + std::string(text) + "': a width is above 0");
  return width;
}

void setSize(Figure& figure, const FigureWidth& asked, double aspect, double seen_width) {
  figure.dpi = asked.dpi;
  if (asked.length && !figure.dpi) figure.dpi = kPaperDpi;
  double wide = asked.pixels;
  if (asked.length) wide = *asked.length / kInch * *figure.dpi;
  if (figure.dpi) *figure.dpi *= asked.scale;
  wide = std::round(wide * asked.scale);
  const double high = std::round(wide / aspect);
  if (!(std::min(wide, high) >= 16 && std::max(wide, high) <= kMaxSide))
    throw Error("the figure would be " + formatNumber(wide) + " x " + formatNumber(high) +
                " pixels; its sides may have 16 to 16384: change width, dpi or scale");
  figure.width = static_cast<int>(wide);
  figure.height = static_cast<int>(high);
  figure.magnification = std::max(1.0, asked.length ? *figure.dpi / kDpiOfText : wide / seen_width);
}

} // namespace patina
