#include "haptics/hold.h"

namespace patina {
namespace {

constexpr double kApart = 0.2; // sine of the angle from which on a wall is another one

} // namespace

Hold::Hold(const Contact& contact) noexcept : contact_(&contact) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(contact.walls); ++i) {
    const Vec3& normal = contact.wall[i].normal;
    const Vec3 own = normal - across(normal);
    const double length = own.norm();
    if (i > 0 && length < kApart) continue;
    wall_[static_cast<std::size_t>(count_)] = i;
    axis_[static_cast<std::size_t>(count_++)] = i > 0 ? Vec3(own / length) : normal;
  }
}

Vec3 Hold::across(const Vec3& v) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
    sum += v.dot(axis_[i]) * axis_[i];
  return sum;
}

Eigen::Matrix<double, 3, 2> Hold::free() const noexcept {
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
