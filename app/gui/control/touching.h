// Where a tip is that touches the surface at a point, and does not press.
#pragma once

#include "session/build/compile_scene.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface); // unit, outwards
double skinOf(const HapticProperties& haptics); // how far from the surface contact is [m]
Vec3 touching(const CompiledScene& scene, const Vec3& surface);

} // namespace patina
