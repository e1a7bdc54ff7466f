// Which image of an object is its relief: painted, or the grey value of its colour (K21).
#pragma once

#include <array>
#include <memory>

#include "scene/paint/object_paint.h"
#include "scene/paint/relief_settings.h"

namespace patina {

// 0.2126 R + 0.7152 G + 0.0722 B of the sRGB values as they are painted, times coverage: in [0, 1],
// 0 where nothing is painted and where it is black.
double grey(const std::array<double, 3>& color);

// An image with the colour that it was made of; only the tiles in which two colours differ are
// made anew. One thread.
struct GreyImage {
  std::shared_ptr<const TiledImage> color, grey;
};
GreyImage greyOf(std::shared_ptr<const TiledImage> color, const GreyImage& known = {});

// The relief image of one object, one channel; null: none. `known` keeps what was made of colour,
// for the next version; may be null.
std::shared_ptr<const TiledImage> reliefOf(const ObjectPaint& paint, ReliefFrom from,
                                           GreyImage* known = nullptr);
// Whether there is one.
bool hasRelief(const ObjectPaint& paint, ReliefFrom from);
// The paint with that image as its relief, for what shows it; the same where relief is painted.
std::shared_ptr<const ObjectPaint> withRelief(std::shared_ptr<const ObjectPaint> paint,
                                              ReliefFrom from, GreyImage* known = nullptr);

} // namespace patina
