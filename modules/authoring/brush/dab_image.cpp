#include "authoring/brush/dab_image.h"

#include <algorithm>
#include <cmath>

#include "authoring/brush/near_texels.h"
#include "authoring/brush/texel_place.h"

namespace patina {
namespace {

constexpr double kInvisible = 1e-6; // what the eraser leaves below this is nothing

TiledImage copyOr(const std::shared_ptr<const TiledImage>& image, const TexelMap& texels,
                  int channels) {
  return image ? *image : TiledImage(texels.width, texels.height, channels);
}

bool isEmpty(const TiledImage& image) {
  for (std::size_t t = 0; t < image.tileCount(); ++t)
    if (image.tile(t)) return false;
  return true;
}

} // namespace

ImageStroke::ImageStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                         std::shared_ptr<const TiledImage> start, int channels, const Ink& ink)
    : surface_(std::move(surface)), object_(&surface_->objects[object]), start_(std::move(start)),
      image_(copyOr(start_, *object_->texels, channels)),
      weights_(object_->texels->width, object_->texels->height, 1), ink_(ink),
      written_(image_.tileCount(), false) {}

std::size_t ImageStroke::paint(const Dab& dab, const Brush& brush,
                               std::span<const std::int32_t> faces) {
  if (brush.mode == StrokeMode::smooth && !ink_.erases) return smooth(dab, brush, faces);
  const Vec3 centre = dab.centre();
  const double reach = dab.reach();
  std::size_t count = 0;
  for (const std::int32_t face : faces) {
    const FaceTexels texels(*surface_, *object_, face);
    const double footprint = texels.footprint();
    texels.forNear(centre, reach, [&](int i, int j) {
      const Vec3 point = texels.at(i, j).point;
      const double weight = weightAt(dab, brush, point);
      if (!(weight > 0)) return;
      ++count;
      lay(texelAt(i, j, point, footprint), weight, brush.mode);
    });
  }
  return count;
}

ImageStroke::Texel ImageStroke::texelAt(int i, int j, const Vec3& point, double footprint) const {
  return {image_.tileOf(i, j), image_.offsetOf(i, j), point, footprint};
}

void ImageStroke::lay(const Texel& texel, double weight, StrokeMode mode) {
  std::array<double, 4> under{};
  if (mode == StrokeMode::build_up) {
    under = valuesIn(&image_, texel);
  } else {
    const std::size_t at = texel.offset / static_cast<std::size_t>(image_.channels());
    const float* before = weights_.tile(texel.tile);
    if (before && weight <= static_cast<double>(before[at])) return;
    weights_.writable(texel.tile)[at] = static_cast<float>(weight);
    under = valuesIn(start_.get(), texel);
  }
  const bool adds = mode == StrokeMode::add && !ink_.erases;
  for (std::size_t c = 0; c < 4; ++c) {
    under[c] = (adds ? 1 : 1 - weight) * under[c] + (ink_.erases ? 0 : weight * ink_.value[c]);
    if (ink_.erases && std::abs(under[c]) < kInvisible) under[c] = 0;
  }
  set(texel, under);
}

std::array<double, 4> ImageStroke::valuesIn(const TiledImage* image, const Texel& texel) const {
  std::array<double, 4> values{};
  const float* tile = image ? image->tile(texel.tile) : nullptr;
  if (!tile) return values;
  for (std::size_t c = 0; c < static_cast<std::size_t>(image_.channels()); ++c)
    values[c] = static_cast<double>(tile[texel.offset + c]);
  return values;
}

void ImageStroke::set(const Texel& texel, const std::array<double, 4>& values) {
  const auto channels = static_cast<std::size_t>(image_.channels());
  std::array<float, 4> rounded{};
  for (std::size_t c = 0; c < channels; ++c) rounded[c] = static_cast<float>(values[c]);
  static constexpr std::array<float, 4> kNothing{};
  const float* tile = image_.tile(texel.tile);
  const float* before = tile ? tile + texel.offset : kNothing.data();
  // A tile stays shared, or absent, until something in it becomes other than it was.
  if (std::equal(rounded.begin(), rounded.begin() + image_.channels(), before)) return;
  std::copy_n(rounded.begin(), channels, image_.writable(texel.tile) + texel.offset);
  changed_ = true;
  written_[texel.tile] = true;
  const Vec3 margin = Vec3::Constant(texel.footprint); // a bilinear look-up reads a texel away
  region_.extend(texel.point - margin);
  region_.extend(texel.point + margin);
}

std::size_t ImageStroke::smooth(const Dab& dab, const Brush& brush,
                                std::span<const std::int32_t> faces) {
  struct Place {
    Texel texel;
    double weight;
  };
  std::vector<Place> places;
  std::vector<NearTexel> near;
  const Vec3 centre = dab.centre();
  const double reach = dab.reach();
  for (const std::int32_t face : faces) {
    const FaceTexels texels(*surface_, *object_, face);
    const double footprint = texels.footprint();
    const Vec3 normal = texels.normal();
    texels.forNear(centre, reach, [&](int i, int j) {
      const TexelPlace place = texels.at(i, j);
      const Texel texel = texelAt(i, j, place.point, footprint);
      places.push_back({texel, weightAt(dab, brush, place.point)});
      near.push_back({place.point, normal, footprint, place.inside, valuesIn(&image_, texel)});
    });
  }
  const std::vector<std::array<double, 4>> means = meansOfNeighbours(near);
  std::size_t count = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double w = places[n].weight;
    if (!(w > 0)) continue;
    ++count;
    std::array<double, 4> values = near[n].values;
    for (std::size_t c = 0; c < 4; ++c) values[c] += w * (means[n][c] - values[c]);
    set(places[n].texel, values);
  }
  return count;
}

std::shared_ptr<const TiledImage> ImageStroke::take() {
  changed_ = false;
  if (isEmpty(image_)) return nullptr;
  return std::make_shared<const TiledImage>(image_.published());
}

void ImageStroke::dropEmpty() {
  image_.dropEmptyTiles();
  changed_ = true;
}

std::vector<std::size_t> ImageStroke::takeTiles() {
  std::vector<std::size_t> tiles;
  for (std::size_t t = 0; t < written_.size(); ++t)
    if (written_[t]) tiles.push_back(t);
  written_.assign(written_.size(), false);
  return tiles;
}

Box3 ImageStroke::takeRegion() {
  const Box3 region = region_;
  region_.setEmpty();
  return region;
}

} // namespace patina
