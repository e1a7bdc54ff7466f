// Positions of the slices of a picture.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/types.h"

namespace patina {

// The plane of the points whose component along `normal` is `position`.
struct SlicePosition {
  Vec3 normal = Vec3::UnitY();      // unit, world
  std::optional<double> position{}; // [m]; nullopt: through the middle of the field
  bool operator==(const SlicePosition&) const = default;
};

// Parses a direction, "x", "-z" or "0,1,1", and then a position, "0,1,1:12.5mm". Throws Error.
SlicePosition parseSlice(std::string_view text);
std::string directionText(const Vec3& normal);  // "y" or "0, 0.7071, 0.7071"
std::string format(const SlicePosition& slice); // such a text, in metres and with all digits

// The first slice is always there, through the middle unless it has a position; an absent second or
// third is not drawn.
inline constexpr std::size_t kMaxSlices = 3;
using Slices = std::array<std::optional<SlicePosition>, kMaxSlices>;

} // namespace patina
