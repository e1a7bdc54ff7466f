// Generalised winding number (MATH K01): about 1 inside, 0 outside, also for cracked, holed,
// overlapping or partly inverted meshes.
#pragma once

#include <memory>

#include "geometry/triangle_mesh.h"

namespace patina {

// A hierarchy of dipole (and higher) moments; far clusters by their expansion, near ones by exact
// solid angles. Immutable; queries may run on any number of threads.
class WindingNumber {
 public:
  // accuracy: a cluster is expanded when the query is farther than accuracy x its radius. 2 gives
  // an error below 1e-2, measured by the tests against the exact sum.
  explicit WindingNumber(const TriangleMesh& mesh, double accuracy = 2.0);
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;
  ~WindingNumber();

  double at(const Vec3& p) const;
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

// The exact sum over all triangles: the oracle.
double windingNumberBruteForce(const TriangleMesh& mesh, const Vec3& p);

} // namespace patina
