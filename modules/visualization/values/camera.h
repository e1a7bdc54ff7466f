// Moves a VTK camera, or a point with the mouse: free functions.
#pragma once

#include <array>
#include <vector>

#include <vtkCamera.h>

#include "core/types.h"
#include "visualization/values/view_options.h"

namespace patina {

// Views the same focal point from a preset side.
void turnCamera(vtkCamera& camera, ViewPreset view);
// Orientation: the camera's right, up and back in the world.
Eigen::Quaterniond turnOf(vtkCamera& camera);
// Rotates the camera about its focal point at the same distance.
void setTurn(vtkCamera& camera, const Eigen::Quaterniond& turn);
// Orientation for a view along a direction, not zero, with z up; y if it is vertical.
Eigen::Quaterniond turnFrom(const Vec3& direction);
// Views `centre` from the present direction, as close as all points allow. aspect = width / height.
void resetCameraTo(vtkCamera& camera, const Vec3& centre, const std::vector<Vec3>& points,
                   double aspect);

// dx, dy in picture heights, to the right and up.
void orbit(vtkCamera& camera, double dx, double dy);
void pan(vtkCamera& camera, double dx, double dy);
void zoom(vtkCamera& camera, double factor); // > 1 moves closer
// Moves the camera so that the scene follows the hand ("object mode"). `shift` is in picture
// heights (right, up, towards the viewer), `turn` is a rotation vector about the same axes [rad].
void moveInObjectMode(vtkCamera& camera, const Vec3& shift, const Vec3& turn);
// Switches perspective off or on; the focal point keeps its size.
void setParallel(vtkCamera& camera, bool on);

// Point under the mouse in the plane through `through` that faces the camera. x, y in picture
// heights from the centre, to the right and up.
Vec3 pointInViewPlane(vtkCamera& camera, double x, double y, const Vec3& through);
Vec3 viewDirection(vtkCamera& camera); // unit, away from the camera

// Position, focal point, up, view angle, parallel scale, and whether it is parallel; not the
// clipping range, which depends on the scene.
using CameraState = std::array<double, 12>;
CameraState placeOf(vtkCamera& camera);

struct Ray {
  Vec3 origin, direction; // direction is unit
};
Ray rayThrough(vtkCamera& camera, double x, double y);

} // namespace patina
