// Height profile along the probe's path from acceleration (A07). The smoother runs in arc length,
// so that a stationary or slow tip adds little information and nothing is divided by speed.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "acquisition/filtering/contact.h"
#include "acquisition/filtering/filtered_scan.h"

namespace patina {

// Roughness along a path as a Matern process of order 7/2 in state-space form (Hartikainen & Sarkka
// 2010). Its spectrum is flat at long wavelengths and falls with the eighth power.

// Height and its first three derivatives by arc length, scaled by the wave number: all [m].
using MaternState = Eigen::Matrix<double, 4, 1>;
using RoughSquare = Eigen::Matrix<double, 4, 4>;

struct MaternStep {
  RoughSquare A, Q; // Q for roughness of rms 1
};

// Stationary covariance for an rms of 1, independent of the wave number.
RoughSquare roughCovariance();

// Transition over `distance` times the wave number, not negative.
MaternStep maternTransition(double distance);

// Transition at a change of direction, given the cosine between old and new direction. At -1 the
// path reverses and odd derivatives change their sign; at 0 only the height is kept.
MaternStep reversalMatrix(double cosine);

// Slower tips are stationary: they show tremor and indentation, not height [m/s].
inline constexpr double kStationarySpeed = 5e-3;

// A sample of the tip in contact.
struct TracedSample {
  double t = 0;                        // [s]
  double arc_length = 0;               // arc length, not decreasing [m]
  double speed = 0;                    // along the path, 0 or more [m/s]
  double tangential_acceleration = 0;  // tangential acceleration [m/s^2]
  double direction_cosine = 1;         // cosine between the path's direction before and here
  double acceleration = 0;             // along the surface normal, without gravity [m/s^2]
  bool is_stationary = false;          // stationary: gives no height and gets that of its place
  double indentation = 0;              // indentation: compliance times force [m]
  double indentation_acceleration = 0; // second time derivative of the indentation [m/s^2]
  // Tip height from the camera at a frame, and its standard deviation [m].
  std::optional<double> height;
  double height_sigma = 0;
};

struct HeightOptions {
  double acceleration_variance = 0.0022; // white noise of each sample (ProbeModel) [m^2/s^4]
  double bias = 0.02;                    // standard deviation of the acceleration's bias [m/s^2]
  double bias_change = 0.005;            // random walk of the bias [m/s^2/s^.5]
  // Rms [m] and correlation length [m] of the roughness; if absent, maximum likelihood.
  std::optional<double> rms, length;
};

struct ProfilePoint {
  double arc_length = 0;         // [m]
  double height = 0;             // along the surface normal [m]
  double sigma = 0;              // standard deviation [m]
  std::optional<double> speed{}; // stroking speed [m/s]; absent if unknown
};

struct HeightProfile {
  std::vector<ProfilePoint> points; // one per sample
  double rms = 0, length = 0;       // assumed or estimated roughness [m]
};

// Estimates the profile of one contact interval. Without camera heights its mean and slope are
// arbitrary; they are chosen such that the roughness has none.
HeightProfile estimateProfile(const std::vector<TracedSample>& samples,
                              const HeightOptions& options);

// Roughness of maximum likelihood over the accelerations of all intervals. Only frequencies below a
// sixth of the sampling rate count unless the tip moves fast: double integration suppresses the
// others, and sensors distort them.
struct Roughness {
  double rms, length; // [m]
};
Roughness fitRoughness(const std::vector<std::vector<TracedSample>>& stretches,
                       const HeightOptions& options);

// Reference plane of the heights; the normal points outwards, unit.
struct Plane {
  Vec3 normal = Vec3::UnitZ(), point = Vec3::Zero();
};

// Returns the samples of an interval of `scan.whole`, made of these poses; compliance [m/N].
std::vector<TracedSample> profileSamples(const FilteredScan& scan, const ContactInterval& stretch,
                                         const std::vector<CameraPose>& poses,
                                         const ProbeModel& probe, const Vec3& gravity,
                                         const Plane& plane, double compliance);

} // namespace patina
