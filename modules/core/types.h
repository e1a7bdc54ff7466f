// The shared vocabulary of every module: Eigen values and nothing else.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace patina {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;     // a point or direction; metres where it is a point
using Box3 = Eigen::AlignedBox3d; // axis-aligned, metres
using Pose = Eigen::Isometry3d;   // named by both frames: world_from_object

} // namespace patina
