// How painted relief is felt (K21, F6, F8).
#pragma once

#include <cstdint>

namespace patina {

// pulled: the image is read at the contact's closest point, whatever the voxel. baked: the field's
// nodes are moved by it, as in the paper; costs nothing a tick and loses what is finer than the
// grid.
enum class ReliefMode : std::uint8_t { pulled, baked };

// Which image is the relief: the one that was painted, or the grey value of the painted colour
// (image-based haptic texturing).
enum class ReliefFrom : std::uint8_t { painted, color };

// conservative: the force is the gradient of a potential, so that no loop does work. literal: as
// the papers have it (F6).
enum class ForceForm : std::uint8_t { conservative, literal };

struct ReliefSettings {
  ReliefMode mode = ReliefMode::pulled;
  ReliefFrom source = ReliefFrom::painted;
  double height = 1e-3; // s [m] of g = 1; negative engraves what was raised
  ForceForm form = ForceForm::conservative;
  double smoothing = 0; // [m], standard deviation of a Gaussian along the surface; 0 = none
  bool operator==(const ReliefSettings&) const = default;
};

} // namespace patina
