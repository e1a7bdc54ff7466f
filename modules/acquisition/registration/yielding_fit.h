// A surface that yields to the force that a probe presses with, by so much a newton: found together
// with the pose (A30). Each of several scans may have met another material.
#pragma once

#include "acquisition/registration/path_fit.h"

namespace patina {

// What is known of a compliance before a fit: by itself that it is nothing out of the ordinary.
struct ExpectedCompliance {
  double compliance = 0;   // [m/N]
  double deviation = 1e-3; // one standard deviation [m/N]; this one is that of 1000 N/m
};

// The forces of points of one or several scans.
class ScanForces {
 public:
  // `force` [N]: one a point, or empty where none was felt. `scan`: the number of each point's
  // scan, from 0; empty where all are of one.
  // `expected`: one a scan, or empty.
  ScanForces(const std::vector<double>& force, const std::vector<std::size_t>& scan,
             const std::vector<ExpectedCompliance>& expected = {});
  ScanForces() = default;

  std::size_t scans() const { return usual_.size(); }           // 0 where no force was felt
  double usual(std::size_t scan) const { return usual_[scan]; } // rms [N], 0 where it felt none
  std::size_t scanOf(std::size_t point) const { return scan_.empty() ? 0 : scan_[point]; }
  double over(std::size_t point) const; // a point's force over its scan's usual one
  // How deep the usual force is expected to press a scan's surface in, and the deviation of that
  // [m].
  double expectedDepth(std::size_t scan) const { return expected_[scan].compliance * usual_[scan]; }
  double depthDeviation(std::size_t scan) const { return expected_[scan].deviation * usual_[scan]; }
  // How far each point was pressed in [m], by the compliance of each scan [m/N].
  std::vector<double> pressed(const std::vector<double>& compliances) const;

 private:
  std::vector<double> force_, usual_;
  std::vector<std::size_t> scan_;
  std::vector<ExpectedCompliance> expected_;
};

struct YieldingFit {
  PathFit fit;
  std::vector<double> compliances; // one a scan, 0 or more [m/N]
};

// From a fit that took the surface for hard. A fit whose points are worth one in `together` says as
// much of the compliances. Asks for a target with sides.
YieldingFit fitYielding(const SurfaceTarget& target, const std::vector<Vec3>& points,
                        const ScanForces& forces, const PathFit& hard, double together,
                        const FitOptions& options);

} // namespace patina
