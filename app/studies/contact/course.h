// The course on which a contact method is judged: random presses, slides and closed loops on a
// scene, every tick compared with the proxy on the exact distance (T-P2 .. T-P4).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "app/studies/contact/oracle.h"
#include "geometry/winding/winding_number.h"
#include "haptics/servo/snapshot.h"

namespace patina {

inline constexpr double kOwnSpeed = 0.1; // v_s of P04 [m/s]: how fast c may run by itself
inline constexpr double kTick = 1e-3;    // [s]

struct CourseReport {
  long ticks = 0;
  long contacts = 0;                 // ticks in contact by the oracle
  long lost = 0;                     // of these, without force
  long pulls = 0;                    // of these, force towards the inside
  long faults = 0;                   // ticks with contact.fault or a force that is not finite
  long snaps = 0;                    // ticks in contact that announce a step of their own
  long unjudged = 0;                 // no free place near the candidate: the oracle has no answer
  double worst_excess = 0;           // [N], of |dF| beyond 2 K |dx| + K v_s dt, snaps too
  long excesses = 0;                 // ticks with more than 0.05 N of it
  std::vector<double> error;         // [N], |F - K (c - x)| with c continued from the method's own
  std::vector<Vec3> error_at;        // [m], that c, one an error
  std::vector<double> snap_error;    // the same where either of the two ran as far as it may
  std::vector<double> free_error;    // [N], with c continued from the oracle's own
  std::vector<double> samples;       // of the field, a tick that began in contact
  std::vector<double> entry_samples; // one that did not and ended in it, or looked about for it
  std::vector<double> ns;            // of tick(), wall, a contact tick

  void add(const CourseReport& other);
};

// What is judged. `forget`: as at the beginning, the next tip has no way from the last.
struct ContactMethod {
  std::function<Contact(const Vec3& tip, double dt)> tick;
  std::function<void()> forget;
  double voxel = 0; // [m], in which what counts as contact is told
};
ContactMethod methodOf(const HapticSnapshot& snapshot); // keeps a reference
// The oracle itself, which nothing can be held against. Keeps a reference.
ContactMethod exactProxy(const ExactSurface& surface, double iso, double voxel);

// Feels tips one after another and judges each. Keeps a reference to the surface.
//
// c is continued from the method's last candidate where that is one (no more than a voxel inside),
// from its last tip where it was free, and else from the oracle's own last c. In contact: the tip
// is more than 0.5 voxel from c, or more than 0.75 voxel deep, whatever came before.
class ContactJudge {
 public:
  ContactJudge(ContactMethod method, const ExactSurface& surface, double iso);
  void restart(); // forgets what was
  Contact feel(const Vec3& tip, CourseReport& report, double dt = kTick);
  // [m], from the tip to c, the longer of the two that the errors are told by.
  double depth() const { return depth_; }

 private:
  ContactMethod method_;
  const ExactSurface& surface_;
  double iso_, voxel_;
  bool has_last_ = false;
  Contact last_;
  Vec3 own_ = Vec3::Zero(); // the oracle's
  double depth_ = 0;
};

// Tip paths of one touch after another, from the exact distance alone. The same seed, the same
// paths.
class TouchPaths {
 public:
  TouchPaths(const ExactSurface& surface, double iso, unsigned seed);

  struct Touch {
    std::vector<Vec3> tips; // one a tick
    bool fresh = true;      // does not begin where the last ended
  };
  // Down from 3 mm above a random place, pressed by up to 6 mm (3 N) and slid at 10 .. 500 mm/s
  // while the depth varies, up and on to the next place where the way there is free.
  Touch touch();
  // The next touch begins afresh.
  void forget() { has_last_ = false; }

  struct Place {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero(); // on the triangles
  };
  // Uniform over the area.
  Place place();
  // Within 2 mm of an edge whose faces differ by more than 20 degrees, or of where two meshes meet;
  // place() without such.
  Place placeByACrease();
  // Free from 3 mm above the place down to it.
  bool reachable(const Place& place) const;
  // A random closed polygon of 0.3 .. 3 mm about a point 0.5 .. 5 mm below the place, from 3 mm
  // above it and back there the same way, twice round in steps of 10 um.
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
  // Where sheets shut a room in, a field counts it as solid: no path begins there. Absent if all
  // meshes are closed.
  std::shared_ptr<const WindingNumber> sheets_;
  bool has_last_ = false;
  Vec3 last_ = Vec3::Zero();
};

// Touches until the oracle has seen `contacts` ticks in contact, or four times as many in all. A
// touch ends early where the tip gets more than 8 mm (4 N) from its contact point, and the next one
// begins afresh where the tip has not come back to the side where it entered: no hand gets there.
CourseReport runCourse(const ContactMethod& method, const ExactSurface& surface, double iso,
                       long contacts, unsigned seed);
// One path from free to free, judged.
CourseReport runPath(const ContactMethod& method, const ExactSurface& surface, double iso,
                     const std::vector<Vec3>& tips);

struct LoopReport {
  int loops = 0;
  double created = 0; // [J], the most that one loop gave to the hand, free to free
};
// Half of them by a crease. Work by the trapezium rule.
LoopReport runLoops(const ContactMethod& method, const ExactSurface& surface, double iso, int loops,
                    unsigned seed);

} // namespace patina
