// Pose of a tip in contact with the surface at a point, and how deep it can press.
#pragma once

#include "session/compile/compile_scene.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface); // Unit normal, outwards.
// Returns the depth [m] at which the servo's force law gives `newtons`. Includes material, coupling
// and stiffness gradient, but not the height of a texture.
double pressDepth(const CompiledScene& scene, const Vec3& surface, double newtons);
double contactOffset(const HapticProperties& haptics); // Distance from the surface [m].
// Clamps a depth [m] below the surface (negative: above) to half the thickness there. Beyond the
// middle, a thin part would push the tip out at the other side.
double clampedDepth(const CompiledScene& scene, const Vec3& surface, double depth);
Vec3 tipAtContact(const CompiledScene& scene, const Vec3& surface);

} // namespace patina
