// Kinematics of the Falcon: handle position from thigh angles, torques for a force (MATH 2.9).
#pragma once

#include <array>
#include <optional>

#include "core/types.h"

namespace patina {

// Three-legged parallel robot (Tsai 1999; Stamper 1997): each thigh rotates about a shaft on the
// base; a parallelogram joins its knee to the handle. [m], [rad]; z from the base to the hand.
struct FalconShape {
  double thigh = 60e-3;            // a
  double shank = 102.5e-3;         // b, the parallelogram
  double knee_inset = 14.43e-3;    // c
  double link = 22.5e-3;           // d + e, between the parallelogram's ends and its joints
  double side_shift = -25e-3;      // f
  double base_radius = 40e-3;      // r
  double handle_shift = -23.09e-3; // s
  // Directions of the legs, 105, -15 and -135 degrees about z.
  std::array<double, 3> cosine{-0.25881904510252076, 0.96592582628906829, -0.70710678118654752};
  std::array<double, 3> sine{0.96592582628906829, -0.25881904510252076, -0.70710678118654752};
};

using Angles = Eigen::Vector3d; // thigh angles [rad]

// Inverse kinematics in closed form. Absent if a leg does not reach.
std::optional<Angles> falconAngles(const FalconShape& shape, const Vec3& handle) noexcept;

struct FalconPose {
  Vec3 handle = Vec3::Zero(); // [m]; finite for any angles
  double residual = 0;        // largest error of a thigh angle [rad]
  int steps = 0;              // Newton steps
  bool singular = false;      // the legs do not determine the handle's position
};
inline constexpr double kFalconResidual = 1e-9; // [rad]
inline constexpr int kFalconSteps = 6;
// Forward kinematics by Newton's method, from `near` or the intersection of three spheres, in at
// most kFalconSteps; a residual above kFalconResidual means no pose, or a singular one.
FalconPose falconPose(const FalconShape& shape, const Angles& angles,
                      const std::optional<Vec3>& near = std::nullopt) noexcept;

// Shaft torques [N m] for `force` at the handle, by equal power. Absent at a singular pose.
std::optional<Vec3> falconTorques(const FalconShape& shape, const Vec3& handle,
                                  const Angles& angles, const Vec3& force) noexcept;

} // namespace patina
