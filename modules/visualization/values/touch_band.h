// Band around the surface in which an offset or a magnet acts (K12, K13).
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

// nullopt if there is neither offset nor magnet.
std::optional<TouchBand> touchBand(const HapticProperties& haptics);

// Returns true if the field contains the whole iso-surface at the band's edge.
bool isStored(const TouchBand& band, const SurfaceField& field);

// "offset 2 mm"; if the edge is not stored, also that it is not drawn and why.
std::string bandLegend(const TouchBand& band, const SurfaceField& field);
const palette::Color& bandColor(const TouchBand& band);

} // namespace patina
