#include "visualization/values/camera.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kHalfView = 15.0 * M_PI / 180; // half of VTK's default view angle of 30 degrees
constexpr double kMargin = 1.08;

struct Frame {
  Vec3 right, up, back;
};
Frame frameOf(vtkCamera& camera) {
  const Vec3 back = (Vec3(camera.GetPosition()) - Vec3(camera.GetFocalPoint())).normalized();
  const Vec3 right = Vec3(camera.GetViewUp()).cross(back).normalized();
  return {right, back.cross(right), back};
}

double halfHeight(vtkCamera& camera) {
  return camera.GetDistance() * std::tan(0.5 * camera.GetViewAngle() * M_PI / 180);
}

// Keeps the visible height of the scene with and without perspective.
void keepScale(vtkCamera& camera) {
  camera.SetParallelScale(halfHeight(camera));
}

void look(vtkCamera& camera, const Vec3& eye, const Vec3& at, const Vec3& up) {
  camera.SetPosition(eye[0], eye[1], eye[2]);
  camera.SetFocalPoint(at[0], at[1], at[2]);
  camera.SetViewUp(up[0], up[1], up[2]);
}

} // namespace

void resetCameraTo(vtkCamera& camera, const Vec3& centre, const std::vector<Vec3>& points,
                   double aspect) {
  const Frame frame = frameOf(camera);
  const double tangent = std::tan(kHalfView);
  // Min distance at which every point is in the picture.
  double distance = 0;
  for (const Vec3& point : points) {
    const Vec3 corner = point - centre;
    const double across = std::abs(corner.dot(frame.right)) / aspect;
    const double high = std::abs(corner.dot(frame.up));
    const double nearer = corner.dot(frame.back);
    // The apparent size depends on the distance only with perspective.
    const double by_depth = camera.GetParallelProjection() != 0 ? std::max(0.0, nearer) : nearer;
    distance = std::max(distance, kMargin * std::max(across, high) / tangent + by_depth);
  }
  camera.SetViewAngle(2 * kHalfView * 180 / M_PI);
  look(camera, centre + frame.back * distance, centre, frame.up);
  keepScale(camera);
}

void turnCamera(vtkCamera& camera, ViewPreset view) {
  const int axis = static_cast<int>(view) / 2; // each has a plus and a minus side
  const double sign = static_cast<int>(view) % 2 == 0 ? 1 : -1;
  const Vec3 back =
      view == ViewPreset::iso ? Vec3(0.65, -1, 0.55).normalized() : Vec3(sign * Vec3::Unit(axis));
  const Vec3 up = axis == 2 ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 centre(camera.GetFocalPoint());
  look(camera, centre + back, centre, up);
}

Eigen::Quaterniond turnOf(vtkCamera& camera) {
  const Frame frame = frameOf(camera);
  Eigen::Matrix3d axes;
  axes << frame.right, frame.up, frame.back;
  return Eigen::Quaterniond(axes);
}

void setTurn(vtkCamera& camera, const Eigen::Quaterniond& turn) {
  const Vec3 centre(camera.GetFocalPoint());
  look(camera, centre + turn * Vec3(0, 0, camera.GetDistance()), centre, turn * Vec3::UnitY());
}

Eigen::Quaterniond turnFrom(const Vec3& direction) {
  const Vec3 back = direction.normalized();
  const bool steep = back.head<2>().norm() < 1e-6;
  const Vec3 right = (steep ? Vec3::UnitY() : Vec3::UnitZ()).cross(back).normalized();
  Eigen::Matrix3d axes;
  axes << right, back.cross(right), back;
  return Eigen::Quaterniond(axes);
}

void orbit(vtkCamera& camera, double dx, double dy) {
  camera.Azimuth(-180 * dx);
  camera.Elevation(-180 * dy);
  camera.OrthogonalizeViewUp();
}

void pan(vtkCamera& camera, double dx, double dy) {
  const Frame frame = frameOf(camera);
  const Vec3 shift = -2 * halfHeight(camera) * (dx * frame.right + dy * frame.up);
  look(camera, Vec3(camera.GetPosition()) + shift, Vec3(camera.GetFocalPoint()) + shift, frame.up);
}

void zoom(vtkCamera& camera, double factor) {
  if (factor > 0) camera.Dolly(factor);
  keepScale(camera);
}

void moveInObjectMode(vtkCamera& camera, const Vec3& shift, const Vec3& turn) {
  orbit(camera, turn.y() / M_PI, -turn.x() / M_PI);
  camera.Roll(turn.z() * 180 / M_PI);
  pan(camera, shift.x(), shift.y());
  zoom(camera, std::exp(3 * shift.z())); // like a drag
}

void setParallel(vtkCamera& camera, bool on) {
  camera.SetParallelProjection(on);
  keepScale(camera);
}

Ray rayThrough(vtkCamera& camera, double x, double y) {
  const Frame frame = frameOf(camera);
  const double tangent = 2 * std::tan(0.5 * camera.GetViewAngle() * M_PI / 180);
  if (camera.GetParallelProjection() != 0) {
    const double high = 2 * camera.GetParallelScale();
    return {Vec3(camera.GetPosition()) + high * (x * frame.right + y * frame.up), -frame.back};
  }
  return {Vec3(camera.GetPosition()),
          (x * tangent * frame.right + y * tangent * frame.up - frame.back).normalized()};
}

Vec3 viewDirection(vtkCamera& camera) {
  return -frameOf(camera).back;
}

Vec3 pointInViewPlane(vtkCamera& camera, double x, double y, const Vec3& through) {
  const Ray ray = rayThrough(camera, x, y);
  const Vec3 normal = viewDirection(camera);
  return ray.origin +
         ray.direction * ((through - ray.origin).dot(normal) / ray.direction.dot(normal));
}

CameraState placeOf(vtkCamera& camera) {
  CameraState place;
  camera.GetPosition(place.data());
  camera.GetFocalPoint(place.data() + 3);
  camera.GetViewUp(place.data() + 6);
  place[9] = camera.GetViewAngle();
  place[10] = camera.GetParallelScale();
  place[11] = camera.GetParallelProjection();
  return place;
}

} // namespace patina
