#include "haptics/contact/active_constraints.h"

#include <algorithm>
#include <utility>

namespace patina {
namespace {

constexpr double kApart = 0.2; // sine of the angle above which a wall is independent

} // namespace

ActiveConstraints::ActiveConstraints(const Contact& contact) noexcept {
  for (int i = 0; i < contact.walls; ++i) add(contact.wall[static_cast<std::size_t>(i)]);
}

void ActiveConstraints::add(const Contact::WallLoad& wall) noexcept {
  const auto along = [&](const Contact::WallLoad& other) { return other.normal.dot(wall.normal); };
  const auto end = wall_.begin() + count_;
  const auto nearest = std::max_element(
      wall_.begin(), end, [&](const auto& a, const auto& b) { return along(a) < along(b); });
  // An opposite wall lies in the same span, but constrains the other side.
  const bool same = nearest != end && along(*nearest) > 0 &&
                    (wall.normal - constrainedPart(wall.normal)).norm() < kApart;
  if (same) {
    const Vec3 sum = nearest->multiplier * nearest->normal + wall.multiplier * wall.normal;
    const double load = sum.norm();
    if (load > 0) *nearest = {sum / load, load};
  } else {
    wall_[static_cast<std::size_t>(count_++)] = wall;
  }
  const int count = std::exchange(count_, 0);
  for (; count_ < count; ++count_) {
    const auto i = static_cast<std::size_t>(count_);
    const Vec3& normal = wall_[i].normal;
    axis_[i] = count_ > 0 ? Vec3((normal - constrainedPart(normal)).normalized()) : normal;
  }
}

Vec3 ActiveConstraints::constrainedPart(const Vec3& v) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
    sum += v.dot(axis_[i]) * axis_[i];
  return sum;
}

Eigen::Matrix<double, 3, 2> ActiveConstraints::tangentBasis() const noexcept {
  Eigen::Matrix<double, 3, 2> free = Eigen::Matrix<double, 3, 2>::Zero();
  if (count_ == 2) {
    free.col(0) = axis_[0].cross(axis_[1]);
  } else if (count_ == 1) {
    free.col(0) = axis_[0].unitOrthogonal();
    free.col(1) = axis_[0].cross(Vec3(free.col(0)));
  }
  return free;
}

} // namespace patina
