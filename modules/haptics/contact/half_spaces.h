// Nearest point of an intersection of half-spaces (P05), a quadratic program for a contact with up
// to three walls. Lengths in voxels.
#pragma once

#include <array>

#include "core/types.h"

namespace patina {

// Wall linearised at a point: L(y) = normal.y - offset, free where L >= 0.
struct WallPlane {
  Vec3 normal = Vec3::Zero(); // unit, outward
  double offset = 0;
  Vec3 point = Vec3::Zero();

  double height(const Vec3& y) const noexcept { return normal.dot(y) - offset; }
};

// Walls, the newest last; a full array drops the one linearised farthest from the new one.
struct Walls {
  static constexpr int kMax = 4;
  std::array<WallPlane, kMax> wall;
  int count = 0;

  void add(const WallPlane& newest) noexcept;
  void remove(int index) noexcept;
  const WallPlane& operator[](int index) const noexcept {
    return wall[static_cast<std::size_t>(index)];
  }
  WallPlane& operator[](int index) noexcept { return wall[static_cast<std::size_t>(index)]; }
};

// z = argmin |y - x|^2 subject to L_i(y) >= 0, z = x + sum of multiplier_i n_i.
struct WallProjection {
  Vec3 z = Vec3::Zero();
  std::array<int, 3> active{};
  std::array<double, 3> multiplier{}; // Lagrange multipliers, >= 0
  int count = 0;                      // number of active walls
};

// Returns the least violating candidate if the half-spaces have no common point.
WallProjection projectOntoWalls(const Walls& walls, const Vec3& x) noexcept;

} // namespace patina
