// The band around the surface that an offset or a magnet acts in (K12, K13).
#pragma once

#include <optional>
#include <string>

#include "field/store/surface_field.h"
#include "scene/haptic_properties.h"
#include "visualization/values/palette.h"

namespace patina {

struct TouchBand {
  enum class Kind { offset, magnet } kind = Kind::offset;
  double edge = 0; // [m]: the band is 0 < phi < edge
  bool operator==(const TouchBand&) const = default;
};

// nullopt if the surface is felt where it is.
std::optional<TouchBand> touchBand(const HapticProperties& haptics);

// Whether the field holds the iso-surface at the band's edge without a gap.
bool isStored(const TouchBand& band, const SurfaceField& field);

// "offset 2 mm"; where the edge is not stored, that it is not drawn and why.
std::string bandLegend(const TouchBand& band, const SurfaceField& field);
const palette::Color& bandColor(const TouchBand& band);

} // namespace patina
