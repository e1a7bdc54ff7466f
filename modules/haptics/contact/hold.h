// How many walls hold the tip, and across which directions.
#pragma once

#include "haptics/contact/contact.h"

namespace patina {

// The directions that a contact's walls hold, and those that they leave free. A wall counts where
// it adds a direction of its own, the ones that bear most first; one that adds none belongs to the
// nearest that counts, and what counts is the sum of load times normal. So two that differ by less
// than about 12 degrees are one, and the facets of a smooth surface hold as it does.
class WallHold {
 public:
  explicit WallHold(const Contact& contact) noexcept;

  int count() const noexcept { return count_; } // of walls that count, 0 without contact
  // The i-th of them; they span what is held.
  const Contact::WallLoad& operator[](int i) const noexcept {
    return wall_[static_cast<std::size_t>(i)];
  }
  Vec3 across(const Vec3& v) const noexcept; // the part of v that they hold
  // What is left free: orthonormal columns, the last ones zero where it is less than a plane.
  Eigen::Matrix<double, 3, 2> free() const noexcept;

 private:
  void add(const Contact::WallLoad& wall) noexcept;

  std::array<Contact::WallLoad, 3> wall_;
  std::array<Vec3, 3> axis_; // orthonormal, the first count_
  int count_ = 0;
};

} // namespace patina
