// How many walls hold the tip, and across which directions.
#pragma once

#include "haptics/contact.h"

namespace patina {

// The directions that a contact's walls hold, and those that they leave free. A wall counts where
// it adds a direction of its own, the ones that bear most first: two that differ by less than about
// 12 degrees are one, so that the facets of a smooth surface hold as it does. Reads only the
// contact's walls.
class Hold {
 public:
  explicit Hold(const Contact& contact) noexcept;

  int count() const noexcept { return count_; } // of directions, 0 without contact
  Vec3 across(const Vec3& v) const noexcept;    // the part of v in them
  // What is left free: orthonormal columns, the last ones zero where it is less than a plane.
  Eigen::Matrix<double, 3, 2> free() const noexcept;

 private:
  std::array<Vec3, 3> axis_; // orthonormal, the first count_
  int count_ = 0;
};

} // namespace patina
