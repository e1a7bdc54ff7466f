// Where a tip is that touches the surface at a point, and how far it can press.
#pragma once

#include "session/build/compile_scene.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface); // unit, outwards
// How stiff the surface is felt to be there [N/m], by the law of the servo itself: what is painted
// and scanned, and what a coupling softens, but no height of a texture.
double stiffnessAt(const CompiledScene& scene, const Vec3& surface);
double skinOf(const HapticProperties& haptics); // how far from the surface contact is [m]
// How deep a press may go that is asked to go `depth` [m] below the surface (negative: above it):
// as far as the middle between it and the other side, past which a thin part lets go.
double depthWithin(const CompiledScene& scene, const Vec3& surface, double depth);
Vec3 touching(const CompiledScene& scene, const Vec3& surface);

} // namespace patina
