// Where a Falcon's handle is for the angles of its three thighs, and the torques that a force needs
// (MATH 2.9).
#pragma once

#include <array>
#include <optional>

#include "core/types.h"

namespace patina {

// A delta robot: the thigh of a leg turns about a shaft on the base, a parallelogram joins its knee
// to the handle. Lengths in metres, angles in radians. Device frame: z from the base to the hand.
struct FalconShape {
  double thigh = 60e-3;            // a
  double shank = 102.5e-3;         // b, of the parallelogram
  double knee_inset = 14.43e-3;    // c
  double link = 22.5e-3;           // d + e, between the parallelogram's ends and its joints
  double side_shift = -25e-3;      // f
  double base_radius = 40e-3;      // r
  double handle_shift = -23.09e-3; // s
  // Of the legs, at 105, -15 and -135 degrees about z.
  std::array<double, 3> cosine{-0.25881904510252076, 0.96592582628906829, -0.70710678118654752};
  std::array<double, 3> sine{0.96592582628906829, -0.25881904510252076, -0.70710678118654752};
};

using Angles = Eigen::Vector3d; // [rad], of the thighs

// Closed form. Absent where a leg does not reach.
std::optional<Angles> falconAngles(const FalconShape& shape, const Vec3& handle) noexcept;

struct FalconPose {
  Vec3 handle = Vec3::Zero(); // [m]; finite, whatever the angles
  double residual = 0;        // [rad], the most that a thigh's angle there differs
  int steps = 0;              // of Newton
  bool singular = false;      // the legs do not hold the handle there
};
inline constexpr double kFalconResidual = 1e-9; // [rad]
inline constexpr int kFalconSteps = 6;
// Newton, from `near` where it is given, else from three spheres about the knees. At most
// kFalconSteps; what then is more than kFalconResidual belongs to no pose, or to a singular one.
FalconPose falconPose(const FalconShape& shape, const Angles& angles,
                      const std::optional<Vec3>& near = std::nullopt) noexcept;

// Torques of the thighs' shafts [N m] that are felt as `force` at the handle: its power is theirs.
// Absent at a singular pose.
std::optional<Vec3> falconTorques(const FalconShape& shape, const Vec3& handle,
                                  const Angles& angles, const Vec3& force) noexcept;

} // namespace patina
