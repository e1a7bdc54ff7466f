// The shared vocabulary of every module: Eigen values and nothing else.
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace patina {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;     // a point or direction; metres where it is a point
using Box3 = Eigen::AlignedBox3d; // axis-aligned, metres
using Pose = Eigen::Isometry3d;   // named by both frames: world_from_object

// Of the parallelogram they span; positive if b lies to the left of a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a[0] * b[1] - a[1] * b[0];
}

// Faces, vertices, charts and slots count in 32 bits, and containers do not.
inline std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}
constexpr std::int32_t kNone = -1; // no face, vertex, chart, slot

} // namespace patina
