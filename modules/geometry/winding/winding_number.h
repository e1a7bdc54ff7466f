// Generalised winding number (K01; Jacobson et al. 2013, Barill et al. 2018): about 1 inside and 0
// outside, also for cracked, holed, overlapping or partly inverted meshes.
#pragma once

#include <memory>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Hierarchy of moments up to second order: far clusters use their expansion, near ones exact solid
// angles. Coordinates are relative to the mesh's centre and size. Immutable; queries may run on any
// number of threads.
// Exactly coincident triangles (equal corner positions) count once, with the orientation of most of
// them. If both orientations are equally frequent, they cancel (a wall between two touching
// bodies), unless most triangles of their connected part are such: a body combined with its own
// inverse still has an inside. Triangles with a non-finite corner are ignored.
class WindingNumber {
 public:
  // accuracy: a cluster is expanded if the query is farther than accuracy times its radius. 2 keeps
  // the error below 1e-2, as the tests measure against the exact sum.
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

} // namespace patina
