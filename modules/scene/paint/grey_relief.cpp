#include "scene/paint/grey_relief.h"

#include <algorithm>

namespace patina {
namespace {

constexpr std::array<double, 3> kLuma{0.2126, 0.7152, 0.0722};

} // namespace

double grey(const std::array<double, 3>& color) {
  return kLuma[0] * color[0] + kLuma[1] * color[1] + kLuma[2] * color[2];
}

GreyImage greyOf(std::shared_ptr<const TiledImage> color, const GreyImage& known) {
  if (!color) return {};
  if (color == known.color) return known;
  const bool keeps = known.grey && known.color->width() == color->width() &&
                     known.color->height() == color->height();
  TiledImage made = keeps ? *known.grey : TiledImage(color->width(), color->height(), 1);
  for (std::size_t index = 0; index < color->tileCount(); ++index) {
    if (keeps && color->sharedTile(index) == known.color->sharedTile(index)) continue;
    const float* from = color->tile(index);
    if (!from && !made.tile(index)) continue;
    float* to = made.writable(index);
    for (int t = 0; t < kTileSide * kTileSide; ++t) {
      const float* rgb = from ? from + t * kColorChannels : nullptr;
      to[t] = !rgb ? 0.0F
                   : static_cast<float>(
                         std::clamp(grey({static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                                          static_cast<double>(rgb[2])}),
                                    0.0, 1.0));
    }
  }
  return {std::move(color), std::make_shared<const TiledImage>(std::move(made))};
}

std::shared_ptr<const TiledImage> reliefOf(const ObjectPaint& paint, ReliefSource from,
                                           GreyImage* known) {
  if (from == ReliefSource::painted) return paint.relief;
  GreyImage made = greyOf(paint.color, known ? *known : GreyImage{});
  if (known) *known = made;
  return made.grey;
}

bool hasRelief(const ObjectPaint& paint, ReliefSource from) {
  return (from == ReliefSource::painted ? paint.relief : paint.color) != nullptr;
}

std::shared_ptr<const ObjectPaint> withRelief(std::shared_ptr<const ObjectPaint> paint,
                                              ReliefSource from, GreyImage* known) {
  if (!paint || from == ReliefSource::painted) return paint;
  auto shown = std::make_shared<ObjectPaint>(*paint);
  shown->relief = reliefOf(*paint, from, known);
  return shown;
}

} // namespace patina
