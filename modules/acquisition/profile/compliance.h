// Estimates a surface's compliance from presses (A08).
#pragma once

#include <optional>
#include <vector>

namespace patina {

struct PressSample {
  double t = 0;            // [s]
  double displacement = 0; // into the surface, from any origin [m]
  double force = 0;        // [N]
  double sigma = 0;        // displacement error common to a press [m]; 0: unknown
};

struct ComplianceEstimate {
  double compliance = 0, standard_deviation = 0; // value and its standard deviation [m/N]
  // The deviations to report are as wide as the standard deviation of many presses and wider for
  // few: the value +- two of them holds the truth in 95 %.
  double compliance_deviation = 0;               // [m/N]
  double stiffness = 0, stiffness_deviation = 0; // [N/m]
  double displacement_noise = 0;                 // standard deviation of the residuals [m]
  std::size_t samples = 0, loadings = 0;

  bool isSignificant() const { return compliance > 2 * compliance_deviation; }
};

// Estimates the slope of displacement against force over the loading parts of presses, each with
// its own zero; unloading would include hysteresis. Both variables have errors: `force_sigma` [N],
// and the scatter of the displacement. Regression of force on displacement would be biased by the
// displacement's noise, by 42 % at 3000 N/m with 0.3 mm.
// The standard deviation accounts for the autocorrelation of the residuals. With
// `correlated_within_press` it is at least the scatter between presses, averaged with what the
// samples' own `sigma` lets expect. Pauses of more than 0.05 s separate presses. Returns nullopt
// without a loading of at least `min_force_rise` [N].
std::optional<ComplianceEstimate> estimateCompliance(const std::vector<PressSample>& samples,
                                                     double force_sigma,
                                                     bool correlated_within_press = false,
                                                     double min_force_rise = 0.3);

} // namespace patina
