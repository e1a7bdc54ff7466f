// The nearest point of an intersection of half-spaces (P05): what contact with up to three walls
// comes down to. Lengths in voxels.
#pragma once

#include <array>

#include "core/types.h"

namespace patina {

// A wall as it was seen at a point of it: L(y) = normal.y - offset, free where L >= 0.
struct WallPlane {
  Vec3 normal = Vec3::Zero(); // unit, outward
  double offset = 0;
  Vec3 seen = Vec3::Zero();

  double height(const Vec3& y) const noexcept { return normal.dot(y) - offset; }
};

// The newest last. When there is no room the one seen farthest from the new one goes.
struct Walls {
  static constexpr int kMost = 4;
  std::array<WallPlane, kMost> wall;
  int count = 0;

  void add(const WallPlane& newest) noexcept;
  void remove(int index) noexcept;
  const WallPlane& operator[](int index) const noexcept {
    return wall[static_cast<std::size_t>(index)];
  }
  WallPlane& operator[](int index) noexcept { return wall[static_cast<std::size_t>(index)]; }
};

// z = argmin |y - x|^2 subject to L_i(y) >= 0 = x + sum of load_i n_i over the active walls.
struct WallProjection {
  Vec3 z = Vec3::Zero();
  std::array<int, 3> active{};
  std::array<double, 3> load{}; // multipliers, >= 0
  int count = 0;                // of active ones
};

// Where the half-spaces have no point in common, the candidate that violates them least.
WallProjection projectOntoWalls(const Walls& walls, const Vec3& x) noexcept;

} // namespace patina
