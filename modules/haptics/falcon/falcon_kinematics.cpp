#include "haptics/falcon/falcon_kinematics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace patina {
namespace {

constexpr double kMinDivisor = 1e-9;     // smallest divisor [m]
constexpr double kSingular = 1e-3;       // triple product of the three shanks' unit vectors
constexpr double kMaxNewtonLength = 0.1; // [m]

// Axes of a leg: u away from the base's axis, v sideways, w along the base's axis.
struct Leg {
  Vec3 u, v;
};
Leg legOf(const FalconShape& shape, std::size_t i) noexcept {
  const double c = shape.cosine[i], s = shape.sine[i];
  return {Vec3(c, s, 0), Vec3(-s, c, 0)};
}

// Handle end of the shank relative to the shaft: u and w in the thigh's plane, v sideways.
struct Reach {
  double u, w, v;
};
Reach reachOf(const FalconShape& shape, const Leg& leg, const Vec3& handle) noexcept {
  return {handle.dot(leg.u) - shape.base_radius + shape.knee_inset, handle.z(),
          handle.dot(leg.v) + shape.handle_shift - shape.side_shift};
}

// Distance from knee to handle minus the shank, and its gradient: the handle lies on a torus about
// the knee with tube radius b and ring radius d + e.
struct Gap {
  double value;
  Vec3 direction;  // with respect to the handle
  double by_angle; // derivative with respect to the thigh angle
  bool inside;     // inside the ring, where the parallelogram would have to flip
};
Gap gapOf(const FalconShape& shape, const Leg& leg, const Vec3& handle, double angle) noexcept {
  const Reach reach = reachOf(shape, leg, handle);
  const double c = std::cos(angle), s = std::sin(angle);
  const double u = reach.u - shape.thigh * c, w = reach.w - shape.thigh * s;
  const double ring = std::max(std::hypot(u, w), kMinDivisor);
  const double past = ring - shape.link;
  const double way = std::max(std::hypot(past, reach.v), kMinDivisor);
  const double du = past * u / (ring * way), dw = past * w / (ring * way), dv = reach.v / way;
  return {way - shape.shank, du * leg.u + dv * leg.v + dw * Vec3::UnitZ(),
          shape.thigh * (du * s - dw * c), past <= 0};
}

// Intersection of three spheres about the knees, which approximate the tori, on the hand's side.
Vec3 threeSpheres(const FalconShape& shape, const Angles& angles) noexcept {
  std::array<Vec3, 3> centre;
  for (std::size_t i = 0; i < 3; ++i) {
    const Leg leg = legOf(shape, i);
    const double angle = angles[static_cast<int>(i)];
    centre[i] = (shape.base_radius - shape.knee_inset + shape.thigh * std::cos(angle)) * leg.u +
                (shape.side_shift - shape.handle_shift) * leg.v +
                shape.thigh * std::sin(angle) * Vec3::UnitZ();
  }
  const double radius = shape.shank + shape.link;
  const Vec3 a = centre[1] - centre[0], b = centre[2] - centre[0];
  Vec3 normal = a.cross(b);
  const double area = normal.squaredNorm();
  if (!(area > kMinDivisor * kMinDivisor)) return centre[0] + radius * Vec3::UnitZ();
  // Circumcentre of the knees, then along their normal.
  const Vec3 middle =
      (a.squaredNorm() * b.cross(normal) - b.squaredNorm() * a.cross(normal)) / (2 * area);
  const double rise = std::sqrt(std::max(0.0, radius * radius - middle.squaredNorm()));
  if (normal.z() < 0) normal = -normal;
  return centre[0] + middle + rise / std::sqrt(area) * normal;
}

double residualOf(const FalconShape& shape, const Vec3& handle, const Angles& angles) noexcept {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Gap gap = gapOf(shape, legOf(shape, i), handle, angles[static_cast<int>(i)]);
    const double slope = std::max(std::abs(gap.by_angle), 1e-3 * shape.thigh);
    most = std::max(most, gap.inside ? 1 : std::abs(gap.value) / slope);
  }
  return most;
}

} // namespace

std::optional<Angles> falconAngles(const FalconShape& shape, const Vec3& handle) noexcept {
  Angles angles;
  for (std::size_t i = 0; i < 3; ++i) {
    const Reach reach = reachOf(shape, legOf(shape, i), handle);
    const double square = shape.shank * shape.shank - reach.v * reach.v;
    if (!(square > 0)) return std::nullopt;
    const double ring = shape.link + std::sqrt(square);
    const double far = std::hypot(reach.u, reach.w);
    if (!(far > kMinDivisor)) return std::nullopt;
    // Triangle of thigh, ring and the distance from the shaft; knee outwards.
    const double cosine =
        (far * far + shape.thigh * shape.thigh - ring * ring) / (2 * shape.thigh * far);
    if (!(std::abs(cosine) <= 1)) return std::nullopt;
    angles[static_cast<int>(i)] = std::atan2(reach.w, reach.u) - std::acos(cosine);
  }
  return angles;
}

FalconPose falconPose(const FalconShape& shape, const Angles& angles,
                      const std::optional<Vec3>& near) noexcept {
  FalconPose pose;
  if (!angles.allFinite()) {
    pose.singular = true;
    pose.residual = 1;
    return pose;
  }
  pose.handle = near && near->allFinite() ? *near : threeSpheres(shape, angles);
  for (; pose.steps < kFalconSteps; ++pose.steps) {
    Eigen::Matrix3d slope;
    Vec3 gaps;
    for (std::size_t i = 0; i < 3; ++i) {
      const int row = static_cast<int>(i);
      const Gap gap = gapOf(shape, legOf(shape, i), pose.handle, angles[row]);
      slope.row(row) = gap.direction;
      gaps[row] = gap.value;
    }
    pose.singular = !(std::abs(slope.determinant()) > kSingular);
    if (pose.singular || gaps.lpNorm<Eigen::Infinity>() < 1e-15) break;
    Vec3 step = slope.inverse() * gaps;
    const double length = step.norm();
    if (length > kMaxNewtonLength) step *= kMaxNewtonLength / length;
    pose.handle -= step;
    if (length < 1e-13) break;
  }
  pose.residual = residualOf(shape, pose.handle, angles);
  return pose;
}

std::optional<Vec3> falconTorques(const FalconShape& shape, const Vec3& handle,
                                  const Angles& angles, const Vec3& force) noexcept {
  // n_i . dp + g_i dtheta_i = 0 for each leg, so F = -sum of tau_i n_i / g_i.
  Eigen::Matrix3d directions;
  Vec3 slopes;
  for (std::size_t i = 0; i < 3; ++i) {
    const int column = static_cast<int>(i);
    const Gap gap = gapOf(shape, legOf(shape, i), handle, angles[column]);
    directions.col(column) = gap.direction;
    slopes[column] = gap.by_angle;
  }
  if (!(std::abs(directions.determinant()) > kSingular)) return std::nullopt;
  const Vec3 tensions = directions.inverse() * force;
  return -tensions.cwiseProduct(slopes);
}

} // namespace patina
