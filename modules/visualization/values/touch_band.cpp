#include "visualization/values/touch_band.h"

#include "core/numbers.h"

namespace patina {
namespace {

// isoSurface() skips cells with a node beyond the band; within this margin there is none.
double reach(const SurfaceField& field) {
  return (field.band - 2) * field.grid.voxel;
}

} // namespace

std::optional<TouchBand> touchBand(const HapticProperties& haptics) {
  if (haptics.offset.value_or(0) > 0) return TouchBand{TouchBand::Kind::offset, *haptics.offset};
  if (haptics.magnet && haptics.magnet->range > 0)
    return TouchBand{TouchBand::Kind::magnet, haptics.magnet->range};
  return std::nullopt;
}

bool isStored(const TouchBand& band, const SurfaceField& field) {
  return band.edge <= reach(field);
}

std::string bandLegend(const TouchBand& band, const SurfaceField& field) {
  const std::string words = (band.kind == TouchBand::Kind::offset ? "offset " : "magnet range ") +
                            formatLength(band.edge);
  if (isStored(band, field)) return words;
  return words + ": not drawn, the field holds up to " + formatLength(reach(field));
}

const palette::Color& bandColor(const TouchBand& band) {
  return band.kind == TouchBand::Kind::offset ? palette::kOffsetBand : palette::kMagnetBand;
}

} // namespace patina
