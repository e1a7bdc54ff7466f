// The force of a surface whose heights are known, by looking at many of its points: what a felt
// force is judged by. Shares nothing with field, contact and textures.
#pragma once

#include <functional>
#include <vector>

#include "core/types.h"

namespace patina {

using HeightOver = std::function<double(const Vec2&)>; // [m]

// Of a frictionless spring of `stiffness` [N/m] from the surface's nearest point; zero above it.
// Looks up to `reach` aside [m]: the surface must not be nearer from farther away.
Vec3 trueForce(const HeightOver& surface, const Vec3& tip, double stiffness, double reach);

} // namespace patina
