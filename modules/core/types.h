// Types that every module shares: Eigen values only.
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace patina {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;     // a point [m] or a direction
using Box3 = Eigen::AlignedBox3d; // axis-aligned [m]
using Pose = Eigen::Isometry3d;   // named by both frames: world_from_object

// Signed area of the parallelogram; positive if b lies to the left of a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a[0] * b[1] - a[1] * b[0];
}

// Converts the 32-bit index of a face, vertex, chart or slot to a container index.
inline std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}
constexpr std::int32_t kNone = -1; // no face, vertex, chart, slot

} // namespace patina
