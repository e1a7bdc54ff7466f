// Fixed contact test: a tip slides around a sphere at a known depth, so that force, friction and
// their changes have closed forms. Used by the study and the benchmark.
#pragma once

#include <memory>
#include <vector>

#include "core/progress.h"
#include "haptics/law/snapshot.h"

namespace patina {

inline constexpr double kContactTestPeriod = 1e-3; // [s]
inline constexpr int kContactTestTicks = 20000;
inline constexpr int kContactTestLeadIn = 300;
// Ticks ignored in errors with friction: the contact point sticks until it has been dragged by mu_s
// d.
inline constexpr int kContactTestSettle = 100;

struct ContactTestSpec {
  double radius = 0.05;  // R of the sphere [m], centred at the origin; K = 50 / R
  double tip_radius = 0; // fraction of R
  bool friction = false; // static 0.5, dynamic 0.3
  Friction::SlipDirection slip = Friction::SlipDirection::paper;
  Sampler sampler = Sampler::high;
  HapticProperties::Contact contact = HapticProperties::Contact::proxy;
};

struct ContactTest {
  ContactTestSpec spec;
  std::vector<Vec3> lead_in;   // straight in from 1.3 R
  std::vector<Vec3> tips;      // i = 0 .. kContactTestTicks - 1, t = 0.001 i
  std::vector<Vec3> normals;   // the sphere's, at the tip
  std::vector<Vec3> reference; // force on the hand [N]
};
ContactTest makeContactTest(const ContactTestSpec& spec);
Scene contactTestScene(const ContactTestSpec& spec); // haptic values only

struct ContactTestErrors {
  // [deg], of the force; with friction, of the friction alone: F - (F.n) n against -v_t
  double direction_mean = 0, direction_max = 0;
  double magnitude_mean = 0, magnitude_max = 0; // [%]
  double jump_rms = 0;      // rms of force changes per tick minus the reference's [N]
  double coulomb_ratio = 0; // mean |F_t| / |F_n| about the sphere's normal
  int lost = 0;             // ticks with less than half the normal force
  int faults = 0;
  std::vector<Vec3> force; // every tick [N]
};
ContactTestErrors contactTestErrors(const HapticSnapshot& snapshot, const ContactTest& test);

inline constexpr int kTimingBatch = 50;
struct ContactTestTiming {
  double p50 = 0, p99 = 0; // one tick, clock included [ns]
  double clock = 0;        // reading the clock alone, included above [ns]
  double batch = 0;        // per tick, median over batches of kTimingBatch timed as one [ns]
};
// Minimum over `repeats` passes, because other load can only add time.
ContactTestTiming contactTestTiming(const HapticSnapshot& snapshot, const ContactTest& test,
                                    int repeats);

// Exact distance of the sphere on the grid of the fixed test: 150 cells, band 8 [voxels].
std::shared_ptr<const SurfaceField> analyticSphere(double radius, int resolution = 150,
                                                   double band = 8);
// The same grid around an icosphere of 20 frequency^2 triangles, each shrunk by the fraction
// `crack`.
std::shared_ptr<const SurfaceField> meshSphere(double radius, int frequency, double crack,
                                               Progress& progress);

} // namespace patina
