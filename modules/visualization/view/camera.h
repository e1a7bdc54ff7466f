// Moving the camera and moving a point with the mouse: plain functions on a VTK camera.
#pragma once

#include <array>
#include <vector>

#include <vtkCamera.h>

#include "core/types.h"
#include "visualization/view/view_options.h"

namespace patina {

// Looks at what it looked at before, from a preset side.
void turnCamera(vtkCamera& camera, ViewPreset view);
// How it is turned: its right, up and back in the world.
Eigen::Quaterniond turnOf(vtkCamera& camera);
// Turned like that about what it looks at, which stays as far away.
void setTurn(vtkCamera& camera, const Eigen::Quaterniond& turn);
// Looking from that direction, not zero, with z up; straight from above or below, y.
Eigen::Quaterniond turnFrom(const Vec3& direction);
// Looks at `centre` from the present direction, as near as all points allow. aspect = width /
// height.
void fitCamera(vtkCamera& camera, const Vec3& centre, const std::vector<Vec3>& points,
               double aspect);

// dx, dy in fractions of the picture's height, to the right and up.
void orbit(vtkCamera& camera, double dx, double dy);
void pan(vtkCamera& camera, double dx, double dy);
void zoom(vtkCamera& camera, double factor); // > 1 comes nearer
// What it looks at, carried as a thing in the hand: shift in fractions of the picture's height to
// the right, up and towards the eye; turn about the same axes, a small rotation vector [rad].
void carry(vtkCamera& camera, const Vec3& shift, const Vec3& turn);
// Without perspective; what it looks at keeps its size.
void setParallel(vtkCamera& camera, bool on);

// The point under the mouse in the plane through `through` that faces the camera.
// x, y in fractions of the picture's height from its centre, to the right and up.
Vec3 pointInViewPlane(vtkCamera& camera, double x, double y, const Vec3& through);
Vec3 viewDirection(vtkCamera& camera); // unit, away from the eye

// Where it stands and how it looks: position, focal point, up, angle, parallel scale, and whether
// it is parallel. Not its clipping range, which follows what is drawn.
using CameraPlace = std::array<double, 12>;
CameraPlace placeOf(vtkCamera& camera);

struct Ray {
  Vec3 origin, direction; // direction is unit
};
Ray rayThrough(vtkCamera& camera, double x, double y);

} // namespace patina
