// Where a tip is that touches the surface at a point, and how far it can press.
#pragma once

#include "session/build/compile_scene.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface); // unit, outwards
double skinOf(const HapticProperties& haptics); // how far from the surface contact is [m]
// So far below the surface, or less: past its middle a thin part lets go, on its other side.
double depthWithin(const CompiledScene& scene, const Vec3& surface, double depth);
Vec3 touching(const CompiledScene& scene, const Vec3& surface);

} // namespace patina
