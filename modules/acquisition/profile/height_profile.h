// A surface's height along the probe's path, from acceleration (A07): a smoother in arc length, so
// that standing still teaches nothing, a slow stretch little, and no speed is divided by.
#pragma once

#include <optional>
#include <vector>

#include "acquisition/filtering/contact.h"
#include "acquisition/filtering/filtered_scan.h"

namespace patina {

// Slower than this along the surface the probe stands: what moves then is the hand's tremor and
// what the surface yields, and neither is a height [m/s].
inline constexpr double kStandingSpeed = 5e-3;

// The tip at one time, in contact.
struct TracedSample {
  double t = 0;            // [s]
  double along = 0;        // way since the beginning, never less than before [m]
  double speed = 0;        // along the path, 0 or more [m/s]
  double speeding = 0;     // its change [m/s^2]
  double turn = 1;         // cosine between the path's direction before and here
  double acceleration = 0; // along the surface's normal, gravity taken off [m/s^2]
  bool stands = false;     // tells nothing then, and gets the height of the place where it stands
  double yielding = 0;     // how far the surface is pressed in: compliance times force [m]
  double giving = 0;       // its acceleration: compliance times that of the force [m/s^2]
  // What the camera says of the tip's height, where a frame was; its standard deviation [m].
  std::optional<double> height;
  double height_sigma = 0;
};

struct HeightOptions {
  double acceleration_variance = 0.0022; // of each sample, white (ProbeModel) [m^2/s^4]
  double bias = 0.02;                    // of the acceleration, standard deviation [m/s^2]
  double bias_change = 0.005;            // by how much it wanders in a second [m/s^2/s^.5]
  // Of the roughness: rms [m] and the length at which it changes [m]. Absent: as is likeliest.
  std::optional<double> rms, length;
};

struct ProfilePoint {
  double along = 0;  // [m]
  double height = 0; // of the surface, along its normal [m]
  double sigma = 0;  // standard deviation [m]
  // At which the tip was drawn over it [m/s]; absent: nobody knows.
  std::optional<double> speed{};
};

struct HeightProfile {
  std::vector<ProfilePoint> points; // one a sample
  double rms = 0, length = 0;       // of the roughness that was assumed or found [m]
};

// One stretch of contact. Without any camera height the profile floats: its mean and slope are
// those of the assumption that roughness has none.
HeightProfile heightAlong(const std::vector<TracedSample>& samples, const HeightOptions& options);

// The roughness under which the accelerations of all stretches together are likeliest. Only what
// heights are made of counts, below a sixth of the sampling rate unless the tip moves fast: two
// integrations make the rest vanish, and sensors shape it.
struct Roughness {
  double rms, length; // [m]
};
Roughness likeliestRoughness(const std::vector<std::vector<TracedSample>>& stretches,
                             const HeightOptions& options);

// From which heights are measured: normal outwards, unit.
struct Plane {
  Vec3 normal = Vec3::UnitZ(), point = Vec3::Zero();
};

// Samples of a stretch of a fused path, `scan.whole`, which was made of these poses; compliance
// [m/N].
std::vector<TracedSample> traced(const FilteredScan& scan, const Stretch& stretch,
                                 const std::vector<CameraPose>& poses, const ProbeModel& probe,
                                 const Vec3& gravity, const Plane& plane, double compliance);

// On places `step` apart [m]; the mean of the points about each place, by their sigmas. Where the
// probe stood there are many points and one place.
std::vector<ProfilePoint> resampled(const std::vector<ProfilePoint>& points, double step);

} // namespace patina
