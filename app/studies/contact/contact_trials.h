// Randomised trials of a contact method: presses, slides and closed loops on a scene, with every
// tick compared with the proxy on the exact distance (T-P2 .. T-P4).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "app/studies/contact/oracle.h"
#include "geometry/winding/winding_number.h"
#include "haptics/law/snapshot.h"

namespace patina {

inline constexpr double kOwnSpeed = 0.1; // v_s of P04 [m/s]: max speed of c by itself
inline constexpr double kTick = 1e-3;    // [s]

struct TrialReport {
  long ticks = 0;
  long contacts = 0;          // ticks in contact by the oracle
  long lost = 0;              // contact ticks without force
  long pulls = 0;             // contact ticks with a force towards the inside
  long faults = 0;            // ticks with contact.fault or a force that is not finite
  long relocations = 0;       // contact ticks with a reported relocation
  long unverified = 0;        // no free point near the candidate: the oracle has no answer
  double worst_excess = 0;    // [N], of |dF| beyond 2 K |dx| + K v_s dt, relocations included
  long excesses = 0;          // ticks with an excess above 0.05 N
  std::vector<double> error;  // [N], |F - K (c - x)| with c continued from the method's own
  std::vector<Vec3> error_at; // contact point c of each error [m]
  std::vector<double>
      relocation_error;           // the same in ticks in which either point reached its speed limit
  std::vector<double> free_error; // [N], with c continued from the oracle's own
  std::vector<double> samples;    // field samples per tick that began in contact
  std::vector<double> entry_samples; // per other tick that ended in contact or searched for it
  std::vector<double> ns;            // wall time of tick() per contact tick

  void add(const TrialReport& other);
};

// Contact method under test. `forget` resets it: the next tip has no path from the last.
struct ContactMethod {
  std::function<Contact(const Vec3& tip, double dt)> tick;
  std::function<void()> forget;
  double voxel = 0; // unit of the contact thresholds [m]
};
ContactMethod methodOf(const HapticSnapshot& snapshot); // keeps a reference
// The oracle itself as a method, for which no reference exists. Keeps a reference.
ContactMethod exactProxy(const ExactSurface& surface, double iso, double voxel);

// Moves a method through tips and checks each result. Keeps a reference to the surface.
// c is continued from the method's last candidate if it is valid (at most a voxel inside), from its
// last tip if that was free, and otherwise from the oracle's last c. A tick is in contact if the
// tip is more than 0.5 voxel from c or more than 0.75 voxel deep.
class ContactChecker {
 public:
  ContactChecker(ContactMethod method, const ExactSurface& surface, double iso);
  void restart(); // resets the state
  Contact feel(const Vec3& tip, TrialReport& report, double dt = kTick);
  // Distance from the tip to c [m], the longer of the two references.
  double depth() const { return depth_; }

 private:
  ContactMethod method_;
  const ExactSurface& surface_;
  double iso_, voxel_;
  bool has_last_ = false;
  Contact last_;
  Vec3 own_ = Vec3::Zero(); // the oracle's c
  double depth_ = 0;
};

// Random tip paths of successive touches, from the exact distance alone. Deterministic by seed.
class TouchPaths {
 public:
  TouchPaths(const ExactSurface& surface, double iso, unsigned seed);

  struct Touch {
    std::vector<Vec3> tips; // one per tick
    bool fresh = true;      // does not continue the last touch
  };
  // Goes down from 3 mm above a random point, presses by up to 6 mm (3 N), slides at 10 .. 500 mm/s
  // with varying depth, rises, and moves to the next point if the path there is free.
  Touch touch();
  // The next touch starts anywhere.
  void forget() { has_last_ = false; }

  struct Place {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero(); // on the triangles
  };
  Place place();
  // Place within 2 mm of an edge whose normals differ by more than 20 degrees, or of the junction
  // of two meshes; place() if there is none.
  Place placeByACrease();
  // Returns true if the path from 3 mm above the point down to it is free.
  bool reachable(const Place& place) const;
  // A random closed polygon of 0.3 .. 3 mm about a point 0.5 .. 5 mm below the place, twice round
  // in steps of 10 um, from 3 mm above it and back the same way.
  std::vector<Vec3> loop(const Place& place);

 private:
  double uniform(double low, double high);
  Vec3 direction();
  void findMeetings();
  bool isFree(const Vec3& from, const Vec3& to, double room) const;

  struct Crease {
    Vec3 a, b, left, right; // ends, normals of its faces
  };
  const ExactSurface& surface_;
  double iso_;
  std::mt19937 random_;
  std::vector<std::pair<double, Place>> faces_; // cumulative area; normal of the face
  std::vector<std::array<Vec3, 3>> corners_;
  std::vector<Crease> creases_;
  // A field counts a room enclosed by sheets as solid, so no path begins there. Absent if all
  // meshes are closed.
  std::shared_ptr<const WindingNumber> sheets_;
  bool has_last_ = false;
  Vec3 last_ = Vec3::Zero();
};

// Runs touches until the oracle has counted `contacts` contact ticks, or four times as many ticks
// in all. A touch ends early if the tip is more than 8 mm (4 N) from its contact point. The next
// one starts elsewhere if the tip did not return to the side where it entered, which no hand could
// reach.
TrialReport runTrials(const ContactMethod& method, const ExactSurface& surface, double iso,
                      long contacts, unsigned seed);
// Checks one path from free space to free space.
TrialReport runPath(const ContactMethod& method, const ExactSurface& surface, double iso,
                    const std::vector<Vec3>& tips);

struct LoopReport {
  int loops = 0;
  double generated_energy = 0; // [J], max over loops, from free space to free space
};
// Half of the loops are at a crease. Work by the trapezoidal rule.
LoopReport runLoops(const ContactMethod& method, const ExactSurface& surface, double iso, int loops,
                    unsigned seed);

} // namespace patina
