#include "visualization/view/figure_picture.h"

#include <algorithm>
#include <cmath>

#include <vtkImageData.h>

#include "core/error.h"
#include "visualization/view/figure_stage.h"

namespace patina {
namespace {

// Alpha from two pictures that differ by their background, which shows through by 1 - alpha: exact
// for any way of blending (Smith & Blinn 1996).
void separate(const unsigned char* over_black, const unsigned char* over_white,
              std::uint8_t* rgba) {
  int through = 0;
  for (int c = 0; c < 3; ++c) through += over_white[c] - over_black[c];
  const double alpha = std::clamp(1 - through / (3 * 255.0), 0.0, 1.0);
  rgba[3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
  for (int c = 0; c < 3; ++c)
    rgba[c] = rgba[3] == 0
                  ? std::uint8_t{0}
                  : static_cast<std::uint8_t>(std::lround(std::min(255.0, over_black[c] / alpha)));
}

} // namespace

FigurePicture drawFigure(SceneView& view, const Figure& figure) {
  FigureStage stage(view, figure);
  return drawFigure(stage, figure);
}

FigurePicture drawFigure(FigureStage& stage, const Figure& figure) {
  const bool transparent = figure.background == FigureBackground::transparent;
  const auto over_white = transparent ? stage.drawOver(1) : stage.draw();
  const auto over_black = transparent ? stage.drawOver(0) : over_white;
  FigurePicture picture{figure.width, figure.height, figure.dpi, {}};
  const auto width = static_cast<std::size_t>(picture.width);
  picture.rgba.resize(4 * width * static_cast<std::size_t>(picture.height));
  std::uint8_t* rgba = picture.rgba.data();
  bool any = false; // OpenGL that does not work gives black pictures.
  for (int y = picture.height - 1; y >= 0; --y) {
    const auto* black = static_cast<const unsigned char*>(over_black->GetScalarPointer(0, y, 0));
    const auto* white = static_cast<const unsigned char*>(over_white->GetScalarPointer(0, y, 0));
    for (std::size_t x = 0; x < width; ++x, rgba += 4) {
      separate(black + 3 * x, white + 3 * x, rgba);
      any = any || white[3 * x] > 0;
    }
  }
  if (!any)
    throw Error("nothing was drawn: OpenGL gave an empty picture; check that `glxinfo` works here");
  return picture;
}

} // namespace patina
