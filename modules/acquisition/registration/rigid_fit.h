// Points onto points (A11): the turn and shift that bring one list nearest to another, in the mean
// square.
#pragma once

#include <optional>
#include <vector>

#include "core/types.h"

namespace patina {

// By the singular values of the cross-covariance (Arun, Huang and Blostein 1987), never a
// reflection. As many points in both; throws std::invalid_argument otherwise or without any.
Pose fitRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

// As the paper words it: a 4 x 4 matrix by least squares, whose turning part then gets unit
// singular values. Nullopt where the points lie in a plane and leave the matrix open (F10).
std::optional<Pose> fitAffineThenRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

} // namespace patina
