// The mean of a picture over a piece of it.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.h"
#include "pictures/picture.h"

namespace patina {

// Premultiplied, so that what is transparent lends no colour to its neighbours.
struct PictureSample {
  double rgb[3] = {}, alpha = 0;
  double grey() const { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }
};

// Throws std::invalid_argument unless there are 1 to 4 channels and as many texels as the size
// says.
void requirePicture(const Picture& picture);

// Adds `share` of the picture's bilinear value at a place in the unit square. Outside of it the
// picture repeats, or its edge goes on. A place that is not finite adds nothing.
void addSample(const Picture& picture, const Vec2& place, bool repeats, double share,
               PictureSample& sum);

// Returns the mean over the texel of an image that is `step` wide and high at `centre`, both in the
// unit square. `placeOf` takes a place in the image to one in the picture; where the picture is
// finer than the image, up to 8 x 8 samples are taken.
template <typename PlaceOf>
PictureSample meanOver(const Picture& picture, bool repeats, const Vec2& centre, const Vec2& step,
                       const PlaceOf& placeOf) {
  constexpr double kMostSamples = 8; // a texel and axis
  const Vec2 size(picture.width, picture.height);
  double finer = 0; // texels of the picture in one of the image
  for (const Vec2& side : {Vec2(step.x() / 2, 0), Vec2(0, step.y() / 2)})
    finer = std::max(finer,
                     (placeOf(centre + side) - placeOf(centre - side)).cwiseProduct(size).norm());
  const int n = static_cast<int>(std::ceil(std::clamp(finer, 1.0, kMostSamples)));
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
