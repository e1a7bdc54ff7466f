// Selects an object's relief image: painted, or the grey value of its colour (K21).
#pragma once

#include <array>
#include <memory>

#include "scene/paint/object_paint.h"
#include "scene/paint/relief_settings.h"

namespace patina {

// Returns 0.2126 R + 0.7152 G + 0.0722 B of the painted sRGB values, times coverage: in [0, 1], 0
// for unpainted or black texels.
double grey(const std::array<double, 3>& color);

// A grey image and the colour image it was made from. Only tiles with a changed colour are computed
// again. One thread.
struct GreyImage {
  std::shared_ptr<const TiledImage> color, grey;
};
GreyImage greyOf(std::shared_ptr<const TiledImage> color, const GreyImage& known = {});

// Returns the relief image of one object, one channel; null: none. `known` caches the grey image
// for the next version; may be null.
std::shared_ptr<const TiledImage> reliefOf(const ObjectPaint& paint, ReliefSource from,
                                           GreyImage* known = nullptr);
// Returns true if there is one.
bool hasRelief(const ObjectPaint& paint, ReliefSource from);
// Returns the paint with that image as its relief, for display; unchanged if relief is painted.
std::shared_ptr<const ObjectPaint> withRelief(std::shared_ptr<const ObjectPaint> paint,
                                              ReliefSource from, GreyImage* known = nullptr);

} // namespace patina
