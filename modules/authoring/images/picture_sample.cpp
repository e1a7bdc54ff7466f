#include "authoring/images/picture_sample.h"

#include <stdexcept>

namespace patina {
namespace {

PictureSample texelOf(const Picture& picture, int i, int j) {
  const auto at = (static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width) +
                   static_cast<std::size_t>(i)) *
                  static_cast<std::size_t>(picture.channels);
  const float* value = &picture.texel[at];
  const bool grey = picture.channels < 3;
  PictureSample sample{{}, 1};
  if (picture.channels % 2 == 0) sample.alpha = static_cast<double>(value[picture.channels - 1]);
  for (int c = 0; c < 3; ++c)
    sample.rgb[c] = sample.alpha * static_cast<double>(value[grey ? 0 : c]);
  return sample;
}

int wrapped(int i, int n, bool repeats) {
  return repeats ? (i % n + n) % n : std::clamp(i, 0, n - 1);
}

} // namespace

void requirePicture(const Picture& picture) {
  const auto count = static_cast<std::size_t>(std::max(0, picture.width)) *
                     static_cast<std::size_t>(std::max(0, picture.height)) *
                     static_cast<std::size_t>(std::max(0, picture.channels));
  if (count == 0 || picture.channels > 4 || picture.texel.size() != count)
    throw std::invalid_argument("not a picture");
}

void addSample(const Picture& picture, const Vec2& place, bool repeats, double share,
               PictureSample& sum) {
  if (!place.allFinite()) return;
  const Vec2 inside =
      repeats ? Vec2(place.array() - place.array().floor()) : Vec2(place.array().max(0.0).min(1.0));
  const double x = inside.x() * picture.width - 0.5, y = inside.y() * picture.height - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  for (int corner = 0; corner < 4; ++corner) {
    const int di = corner & 1, dj = corner >> 1;
    const double part = share * (di ? x - i : 1 - (x - i)) * (dj ? y - j : 1 - (y - j));
    const PictureSample texel = texelOf(picture, wrapped(i + di, picture.width, repeats),
                                        wrapped(j + dj, picture.height, repeats));
    for (int c = 0; c < 3; ++c) sum.rgb[c] += part * texel.rgb[c];
    sum.alpha += part * texel.alpha;
  }
}

} // namespace patina
