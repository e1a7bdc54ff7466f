// Active set of a contact: the directions that its walls constrain (Nocedal & Wright).
#pragma once

#include "haptics/contact/contact.h"

namespace patina {

// Span of the active wall normals and its complement. Walls are taken by decreasing multiplier; one
// within about 12 degrees of the span is merged with the nearest wall, by the sum of multiplier
// times normal. The facets of a smooth surface thus act as one wall.
class ActiveConstraints {
 public:
  explicit ActiveConstraints(const Contact& contact) noexcept;

  int count() const noexcept { return count_; } // number of independent walls, 0 without contact
  // Returns the i-th independent wall.
  const Contact::WallLoad& operator[](int i) const noexcept {
    return wall_[static_cast<std::size_t>(i)];
  }
  Vec3 constrainedPart(const Vec3& v) const noexcept; // projection of v onto the constrained span
  // Returns an orthonormal basis of the unconstrained directions; unused columns are zero.
  Eigen::Matrix<double, 3, 2> tangentBasis() const noexcept;

 private:
  void add(const Contact::WallLoad& wall) noexcept;

  std::array<Contact::WallLoad, 3> wall_;
  std::array<Vec3, 3> axis_; // orthonormal, the first count_
  int count_ = 0;
};

} // namespace patina
