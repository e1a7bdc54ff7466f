// Draws a view as a figure and writes it into a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "visualization/values/figure.h"
#include "visualization/view/scene_view.h"

namespace patina {

struct FigurePicture {
  int width = 0, height = 0; // [pixels]
  std::optional<double> dpi; // [pixels/inch]
  // Red, green, blue, alpha of each pixel, in rows from the top; not premultiplied.
  std::vector<std::uint8_t> rgba;
};

// A view in a window keeps its camera and returns to the window; one in no window is fitted first
// unless the figure keeps its camera. The alpha of a transparent background is 0. Throws Error
// without a display (see display.h), without memory for the picture, or if nothing could be drawn.
FigurePicture drawFigure(SceneView& view, const Figure& figure);

// Writes .png, .tif and .tiff (deflated); no alpha if every pixel is opaque. Atomic.
// Throws Error for another extension, FileError.
void writeFigure(const FigurePicture& picture, const std::filesystem::path& path);
bool isFigureFile(const std::filesystem::path& path); // checks the extension

} // namespace patina
