// Where a tip is that touches the surface at a point, and how far it can press.
#pragma once

#include "session/build/compile_scene.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface); // unit, outwards
// How deep a force of `newtons` presses in there [m], by the law of the servo itself: what is
// painted and scanned, what a coupling softens, and the pull where the stiffness changes over the
// surface; but no height of a texture.
double pressDepth(const CompiledScene& scene, const Vec3& surface, double newtons);
double skinOf(const HapticProperties& haptics); // how far from the surface contact is [m]
// How deep a press may go that is asked to go `depth` [m] below the surface (negative: above it):
// as far as the middle between it and the other side, past which a thin part lets go.
double depthWithin(const CompiledScene& scene, const Vec3& surface, double depth);
Vec3 touching(const CompiledScene& scene, const Vec3& surface);

} // namespace patina
