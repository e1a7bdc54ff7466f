// Renders a camera's frames of a simulated hand's probe by ray casting (A04), for tests and
// simulated scans. The pictures share only the lens model with the tracker.
#pragma once

#include <functional>

#include "acquisition/simulation/simulated_hand.h"
#include "acquisition/values/camera.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// A marker of the rig as it is printed.
struct PrintedMarker {
  RigMarker place;
  int side = 0;           // bits per side, without the black border
  std::uint64_t code = 0; // see MarkerFamily
  double margin = 1;      // white margin around the black border, in bits
};

// A disc in front of everything, such as a finger or a cable.
struct Occluder {
  Vec2 middle = Vec2::Zero(); // [px]
  double radius = 0;          // [px]
  double grey = 0.4;
};

struct FrameLook {
  double white = 0.85, black = 0.08; // grey of the print; 1 is white
  double ground = 0.45;              // grey of the background
  double waves = 0.08;               // relative amplitude of the background's ripples
  double shade = 0.3;                // relative fall-off of the light across the picture
  double shade_angle = 0.6;          // direction of the fall-off [rad]
  double slope_shade = 0.4;          // relative fall-off on a face seen edge on
  double blur = 0.6;                 // deviation of the Gaussian blur of lens and focus [px]
  double noise = 2;                  // deviation of a pixel [grey levels]
  std::vector<Occluder> occluders;
};

// Renders frames of one camera; the lens rays are computed once.
class FrameRenderer {
 public:
  // Throws std::invalid_argument if the lens model is not invertible within the picture. Beyond 89
  // degrees from the axis of a fisheye lens the picture shows the ground.
  FrameRenderer(const Camera& camera, std::vector<PrintedMarker> markers);

  // `camera_from_probe` are poses at equally spaced times of the exposure, at least one.
  GreyFrame render(const std::vector<Pose>& camera_from_probe, const FrameLook& look,
                   std::uint32_t seed) const;

  // Projects a point of the camera's frame to a pixel.
  Vec2 pixelOf(const Vec3& in_camera) const;

 private:
  Camera camera_;
  std::vector<PrintedMarker> markers_;
  std::vector<Vec2> rays_;      // through corners of pixels, on the plane z = 1
  std::vector<double> ripples_; // background ripple of each pixel
};

struct CaptureSettings {
  double rate = 30;            // [Hz]
  double exposure = 4e-3;      // centered at each frame's time, with motion blur [s]
  std::vector<Gap> occlusions; // times with occluded markers
  FrameLook look;
  std::uint32_t seed = 1;
};

using ProbeMotion = std::function<Pose(double t)>; // camera_from_probe
// The result refers to `hand`, which must outlive it unchanged.
ProbeMotion motionOf(const SimulatedHand& hand, const ProbeModel& probe,
                     const Pose& camera_from_world);
// Returns frame i, at the time i / rate.
GreyFrame frameAt(const FrameRenderer& renderer, const ProbeMotion& camera_from_probe,
                  const CaptureSettings& course, int i);

} // namespace patina
