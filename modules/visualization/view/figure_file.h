// Saves a view as a figure, in any of the formats.
#pragma once

#include <filesystem>

#include "visualization/values/figure.h"
#include "visualization/view/scene_view.h"

namespace patina {

// The extension is .png .tif .tiff, or .svg .pdf, in which texts and the scale bar are vectors.
bool canSaveFigure(const std::filesystem::path& path);
// Draws and writes the figure. Throws as drawFigure(), writeFigure() and writeVectorFigure() do.
void saveFigure(SceneView& view, const Figure& figure, const std::filesystem::path& path);

} // namespace patina
