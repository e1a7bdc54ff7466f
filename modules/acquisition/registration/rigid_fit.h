// Rigid motion between corresponding points with the least mean square (A11).
#pragma once

#include <optional>
#include <vector>

#include "core/types.h"

namespace patina {

// Solves the orthogonal Procrustes problem without reflection by the singular values of the
// cross-covariance (Arun, Huang & Blostein 1987; Kabsch 1978). Throws std::invalid_argument unless
// both lists have the same size above 0.
Pose fitRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

// Fits a 4 x 4 matrix by least squares and orthonormalises its linear part, as in the paper.
// Returns nullopt for coplanar points, which do not determine the matrix (F10).
std::optional<Pose> fitAffineThenRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

} // namespace patina
