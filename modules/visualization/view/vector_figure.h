// Writes figures whose texts and scale bar are vectors, over a picture of the rest.
#pragma once

#include <filesystem>

#include "visualization/values/figure.h"
#include "visualization/view/scene_view.h"

namespace patina {

bool isVectorFigureFile(const std::filesystem::path& path); // .svg .pdf

// The resolution gives the size on paper; default: 96 pixels per inch. Texts stay texts, in
// Arial or Helvetica. As drawFigure() and writeFigure() else.
void writeVectorFigure(SceneView& view, const Figure& figure, const std::filesystem::path& path);

} // namespace patina
