#include "app/studies/field/study_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patina {
namespace {

double noCrease(const Vec3&) {
  return std::numeric_limits<double>::infinity();
}

StudyShape sphere(double radius) {
  return {"sphere",
          {Vec3::Constant(-radius), Vec3::Constant(radius)},
          [=](const Vec3& p) { return p.norm() - radius; },
          [](const Vec3& p) { return Vec3(p.normalized()); },
          noCrease};
}

StudyShape torus(double major, double minor) {
  const auto from_circle = [=](const Vec3& p) {
    const Vec3 flat(p.x(), p.y(), 0);
    return Vec3(p - flat.normalized() * major);
  };
  const Vec3 reach(major + minor, major + minor, minor);
  return {"torus",
          {-reach, reach},
          [=](const Vec3& p) { return from_circle(p).norm() - minor; },
          [=](const Vec3& p) { return Vec3(from_circle(p).normalized()); },
          noCrease};
}

double boxDistance(const Vec3& half, const Vec3& p) {
  const Vec3 d = p.cwiseAbs() - half;
  return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
}

Vec3 boxGradient(const Vec3& half, const Vec3& p) {
  const Vec3 d = p.cwiseAbs() - half;
  Vec3 direction = d.cwiseMax(0);
  Eigen::Index nearest = 0;
  if (d.maxCoeff(&nearest) <= 0) direction = Vec3::Unit(nearest);
  for (int axis = 0; axis < 3; ++axis) direction[axis] = std::copysign(direction[axis], p[axis]);
  return direction.normalized();
}

double boxEdgeDistance(const Vec3& half, const Vec3& p) {
  const Vec3 d = p.cwiseAbs() - half;
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 to_edge = d;
    to_edge[axis] = std::max(d[axis], 0.0);
    nearest = std::min(nearest, to_edge.norm());
  }
  return nearest;
}

StudyShape turnedBox(const Vec3& half) {
  const Eigen::Matrix3d box_from_world =
      (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(0.5, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.7, Vec3::UnitZ()))
          .toRotationMatrix();
  const Vec3 reach = box_from_world.transpose().cwiseAbs() * half;
  return {"box",
          {-reach, reach},
          [=](const Vec3& p) { return boxDistance(half, box_from_world * p); },
          [=](const Vec3& p) {
            return Vec3(box_from_world.transpose() * boxGradient(half, box_from_world * p));
          },
          [=](const Vec3& p) { return boxEdgeDistance(half, box_from_world * p); }};
}

} // namespace

std::vector<StudyShape> studyShapes() {
  return {sphere(0.05), torus(0.035, 0.015), turnedBox({0.04, 0.033, 0.027})};
}

double lensDepth(const Vec3& p, double radius, double a) {
  const double rim = std::sqrt(radius * radius - a * a);
  const double to_rim = std::hypot(p.x(), std::hypot(p.y(), p.z()) - rim);
  double depth = to_rim;
  for (const double centre : {-a, a}) {
    const Vec3 from = p - Vec3(centre, 0, 0);
    if (from.norm() > radius || from.isZero()) continue;
    // The radial exit counts unless it ends inside the other sphere.
    const Vec3 exit = Vec3(centre, 0, 0) + radius * from.normalized();
    if ((exit + Vec3(centre, 0, 0)).norm() >= radius) depth = std::min(depth, radius - from.norm());
  }
  return depth;
}

} // namespace patina
