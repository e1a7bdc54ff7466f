// Generalised winding number (K01): about 1 inside, 0 outside, also for cracked, holed,
// overlapping or partly inverted meshes.
#pragma once

#include <memory>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A hierarchy of moments up to second order; far clusters by their expansion, near ones by exact
// solid angles. Coordinates are kept relative to the mesh's centre and size, so that neither
// matters. Immutable; queries may run on any number of threads.
//
// Exactly coincident triangles (same corner positions) count once, with the orientation that most
// of them have. Where as many face either way, they cancel (a wall between two touching bodies),
// unless most triangles of their connected part are such: a body joined with its own inverse still
// has an inside. Triangles with a non-finite corner count nothing.
class WindingNumber {
 public:
  // accuracy: a cluster is expanded when the query is farther than accuracy x its radius. 2 gives
  // an error below 1e-2, measured by the tests against the exact sum.
  explicit WindingNumber(const TriangleMesh& mesh, double accuracy = 2.0);
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;
  ~WindingNumber();

  double at(const Vec3& p) const; // 0 for a point that is not finite
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// The exact sum over all triangles, coincident ones included: the oracle.
double windingNumberBruteForce(const TriangleMesh& mesh, const Vec3& p);

} // namespace patina
