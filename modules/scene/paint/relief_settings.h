// Rendering of painted relief (K21, F6, F8).
#pragma once

#include <cstdint>

namespace patina {

// pulled: the image is sampled at the contact's closest point in each tick, independent of the
// voxel. baked: it displaces the field's nodes, as in the paper; this takes no time per tick and
// loses detail below the grid's resolution.
enum class ReliefMode : std::uint8_t { pulled, baked };

// Image that gives the relief: the painted one, or the grey value of the painted colour
// (image-based haptic texturing).
enum class ReliefSource : std::uint8_t { painted, color };

// conservative: the force is the gradient of a potential, so that no closed path generates work.
// literal: as published in the papers (F6).
enum class ForceForm : std::uint8_t { conservative, literal };

struct ReliefSettings {
  ReliefMode mode = ReliefMode::pulled;
  ReliefSource source = ReliefSource::painted;
  double height = 1e-3; // s [m] at an image value of 1; negative values engrave
  ForceForm form = ForceForm::conservative;
  double smoothing = 0; // [m], standard deviation of a Gaussian along the surface; 0 = none
  bool operator==(const ReliefSettings&) const = default;
};

} // namespace patina
