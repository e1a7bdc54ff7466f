// A figure for a paper: size, background and parts, in the words of `patina render`.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace patina {

enum class FigureBackground : std::uint8_t { as_seen, white, transparent };
enum class FigurePart : std::uint8_t {
  cube,  // the cube in the corner, or the axes
  scale, // scale bar
  tool,
  legend // scalar bars, and the name of the band
};

// Throw Error naming the choices. Parts: "cube,legend".
FigureBackground parseFigureBackground(std::string_view text);
std::set<FigurePart> parseFigureParts(std::string_view text);
std::string_view name(FigureBackground background);
std::string_view name(FigurePart part);
const std::vector<FigureBackground>& allFigureBackgrounds();
const std::vector<FigurePart>& allFigureParts();

struct Figure {
  int width = 1280, height = 960; // pixels, 16 .. 16384
  double magnification = 1;       // pixels of the figure per pixel of a screen of 72 dpi, >= 1
  std::optional<double> dpi;      // written into the file [pixels/inch]
  FigureBackground background = FigureBackground::as_seen;
  std::set<FigurePart> without;
  bool keeps_camera = false; // A view in no window is fitted otherwise.
};

// Requested size: a width in pixels, or on paper.
struct FigureWidth {
  int pixels = 1280;
  std::optional<double> length{}; // [m]; replaces the pixels
  std::optional<double> dpi{};    // pixels per inch of paper; 300 if there is a length
  double scale = 1;               // 1 .. 4: pixels per pixel of that width
  bool operator==(const FigureWidth&) const = default;
};
// Parses "1004" or "85mm". Throws Error.
FigureWidth parseFigureWidth(std::string_view text);
// Sets size, resolution and magnification of a figure with this ratio of width to height. Texts
// have about 6 pt on paper; otherwise they are magnified as the picture is from `seen_width`, the
// width of the same picture on a screen of 72 dpi [pixels]. Throws Error if a side is out of range.
void setSize(Figure& figure, const FigureWidth& asked, double aspect, double seen_width);

} // namespace patina
