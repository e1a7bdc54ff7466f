// Pictures that a camera would take of a body of markers, for tests and simulated scans (A04). It
// shares nothing with what finds markers but the lens: each pixel is a mean of rays.
#pragma once

#include "acquisition/camera.h"

namespace patina {

// A rig's marker as it is printed.
struct PrintedMarker {
  RigMarker place;
  int side = 0;           // bits
  std::uint64_t code = 0; // as in MarkerFamily
  double margin = 1;      // of white around the black, in bits
};

// A disc before everything: a finger, a cable.
struct Occluder {
  Vec2 middle = Vec2::Zero(); // [px]
  double radius = 0;          // [px]
  double grey = 0.4;
};

struct FrameLook {
  double white = 0.85, black = 0.08; // of the print, 1 is the brightest grey
  double ground = 0.45;              // of what is behind it
  double waves = 0.08;               // of the ground, relative
  double shade = 0.3;                // light from one side of the picture to the other, relative
  double shade_angle = 0.6;          // towards where it falls off [rad]
  double slope_shade = 0.4;          // of a face that is seen edge on, relative
  double blur = 0.6;                 // of lens and focus, a Gaussian's deviation [px]
  double noise = 2;                  // of a pixel [grey levels]
  std::vector<Occluder> occluders;
};

// What is the same in all frames of a camera.
class FrameRenderer {
 public:
  // Throws std::invalid_argument where the lens folds within the picture. A fisheye lens may see
  // farther than 89 degrees from its axis; there the picture shows the ground.
  FrameRenderer(const Camera& camera, std::vector<PrintedMarker> markers);

  // `camera_from_probe` are poses evenly spread over the exposure, at least one.
  GreyFrame render(const std::vector<Pose>& camera_from_probe, const FrameLook& look,
                   std::uint32_t seed) const;

  // Where a point of the camera's frame is seen.
  Vec2 pixelOf(const Vec3& in_camera) const;

 private:
  Camera camera_;
  std::vector<PrintedMarker> markers_;
  std::vector<Vec2> rays_;      // through the corners of pixels, on the plane z = 1
  std::vector<double> ripples_; // of the ground, of each pixel
};

} // namespace patina
