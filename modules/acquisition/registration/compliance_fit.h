// Estimates the compliance of a surface, for each scan, together with the pose (A30).
#pragma once

#include "acquisition/registration/path_fit.h"

namespace patina {

// Prior of a compliance; the default is weak.
struct ExpectedCompliance {
  double compliance = 0;   // [m/N]
  double deviation = 1e-3; // standard deviation [m/N]; the default is that of 1000 N/m
};

// Forces at the points of one or several scans.
class ScanForces {
 public:
  // `force` [N] has one value per point, or is empty if not measured. `scan` is each point's scan
  // number from 0; empty: a single scan. `expected` has one value per scan, or is empty.
  ScanForces(const std::vector<double>& force, const std::vector<std::size_t>& scan,
             const std::vector<ExpectedCompliance>& expected = {});
  ScanForces() = default;

  std::size_t scans() const { return rms_force_.size(); }              // 0 without forces
  double rmsForce(std::size_t scan) const { return rms_force_[scan]; } // rms [N], 0 without forces
  std::size_t scanOf(std::size_t point) const { return scan_.empty() ? 0 : scan_[point]; }
  double over(std::size_t point) const; // a point's force over its scan's rms force
  // Prior mean and deviation of a scan's indentation at its rms force [m].
  double expectedDepth(std::size_t scan) const {
    return expected_[scan].compliance * rms_force_[scan];
  }
  double depthDeviation(std::size_t scan) const {
    return expected_[scan].deviation * rms_force_[scan];
  }
  // Returns each point's indentation [m] for the scans' compliances [m/N].
  std::vector<double> indentations(const std::vector<double>& compliances) const;

 private:
  std::vector<double> force_, rms_force_;
  std::vector<std::size_t> scan_;
  std::vector<ExpectedCompliance> expected_;
};

struct ComplianceFit {
  PathFit fit;
  std::vector<double> compliances; // one per scan, 0 or more [m/N]
};

// Starts from a rigid fit. `correlation_length` consecutive points carry the information of one, as
// in the noise model. The target must have sides.
ComplianceFit fitPoseAndCompliance(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                   const ScanForces& forces, const PathFit& rigid_fit,
                                   double correlation_length, const FitOptions& options);

} // namespace patina
