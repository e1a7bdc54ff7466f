#include "haptics/spring_stage.h"

#include <algorithm>
#include <numbers>

#include <Eigen/LU>

namespace patina {

void SpringStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (!contact.touching) return;
  contact.stiffness = contact.material.stiffness;
  contact.force = contact.stiffness * (contact.vcp - contact.tip);
}

VelocityFilterStage::VelocityFilterStage(double cutoff_hz)
    : time_(1 / (2 * std::numbers::pi * cutoff_hz)) {}

void VelocityFilterStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const double share = contact.dt > 0 ? contact.dt / (contact.dt + time_) : 0;
  memory.velocity += share * (contact.velocity - memory.velocity);
  contact.velocity = memory.velocity;
}

void dampSticking(Contact& contact, const Vec3& damper) noexcept {
  if (!(contact.stick_radius > 0)) return;
  const Vec3& n = contact.normal;
  contact.force += damper;
  const Vec3 drag = contact.force - contact.stiffness * (contact.candidate - contact.tip);
  const Vec3 tangential = drag - drag.dot(n) * n;
  // The margin keeps rounding from touching a force that was within the bound undamped.
  const double bearable = contact.stiffness * contact.stick_radius * (1 + 1e-9);
  const double magnitude = tangential.norm();
  if (magnitude > bearable) contact.force -= (1 - bearable / magnitude) * tangential;
}

void dampWalls(Contact& contact, double damping, bool magnetic) noexcept {
  if (contact.attracted)
    contact.force -=
        contact.attraction * damping * contact.velocity.dot(contact.normal) * contact.normal;
  if (!contact.touching) return;
  // The velocity's part across the walls, told apart by wall.
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  Vec3 across = Vec3::Zero();
  const auto press = [&](const Contact::WallLoad& wall, double speed) {
    across += speed * wall.normal;
    const double push = -damping * speed;
    contact.force +=
        (magnetic ? push : std::max(push, -contact.stiffness * wall.load)) * wall.normal;
  };
  if (contact.walls == 1) {
    press(contact.wall[0], contact.velocity.dot(contact.wall[0].normal));
  } else if (contact.walls > 1) {
    const int n = contact.walls;
    Matrix gram(n, n);
    Vector speed(n);
    for (int i = 0; i < n; ++i) {
      const Vec3& normal = contact.wall[static_cast<std::size_t>(i)].normal;
      speed[i] = normal.dot(contact.velocity);
      for (int j = 0; j < n; ++j)
        gram(i, j) = normal.dot(contact.wall[static_cast<std::size_t>(j)].normal);
    }
    speed = gram.inverse() * speed;
    for (int i = 0; i < n; ++i) press(contact.wall[static_cast<std::size_t>(i)], speed[i]);
  }
  dampSticking(contact, -damping * (contact.velocity - across));
}

void DampingStage::apply(Contact& contact, ContactMemory&) const noexcept {
  dampWalls(contact, contact.material.damping, magnetic_);
}

} // namespace patina
