// Mean of a picture over an area.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.h"
#include "pictures/picture.h"

namespace patina {

// Premultiplied, so that transparent texels do not colour their neighbours.
struct PictureSample {
  double rgb[3] = {}, alpha = 0;
  double grey() const { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }
};

// Throws std::invalid_argument unless there are 1 to 4 channels and as many texels as the size
// requires.
void requirePicture(const Picture& picture);

// Adds `share` of the picture's bilinear value at a point of the unit square. Outside it the
// picture repeats, or its edge is extended. A non-finite point adds nothing.
void addSample(const Picture& picture, const Vec2& place, bool repeats, double share,
               PictureSample& sum);

// Returns the mean over the texel of an image that is `step` wide and high at `centre`, both in the
// unit square. `placeOf` maps an image point to the picture; up to 8 x 8 samples are taken if the
// picture is finer than the image.
template <typename PlaceOf>
PictureSample meanOver(const Picture& picture, bool repeats, const Vec2& centre, const Vec2& step,
                       const PlaceOf& placeOf) {
  constexpr double kMaxSamples = 8; // per texel and axis
  const Vec2 size(picture.width, picture.height);
  double finer = 0; // picture texels per image texel
  for (const Vec2& side : {Vec2(step.x() / 2, 0), Vec2(0, step.y() / 2)})
    finer = std::max(finer,
                     (placeOf(centre + side) - placeOf(centre - side)).cwiseProduct(size).norm());
  const int n = static_cast<int>(std::ceil(std::clamp(finer, 1.0, kMaxSamples)));
  PictureSample sum;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec2 place =
          centre + Vec2(((x + 0.5) / n - 0.5) * step.x(), ((y + 0.5) / n - 0.5) * step.y());
      addSample(picture, placeOf(place), repeats, 1.0 / (n * n), sum);
    }
  return sum;
}

} // namespace patina
