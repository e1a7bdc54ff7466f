// How far a surface yields, from presses (A08).
#pragma once

#include <optional>
#include <vector>

namespace patina {

struct PressSample {
  double t = 0;            // [s]
  double displacement = 0; // into the surface, from anywhere [m]
  double force = 0;        // [N]
  double sigma = 0; // of the displacement's error that lasts as long as a press [m]; 0 = not known
};

struct ComplianceEstimate {
  double compliance = 0, compliance_deviation = 0; // [m/N], and its standard deviation
  double stiffness = 0, stiffness_deviation = 0;   // [N/m]
  double displacement_noise = 0;                   // standard deviation that the samples show [m]
  std::size_t samples = 0, loadings = 0;

  bool isTold() const { return compliance > 2 * compliance_deviation; } // else it may be rigid
};

// Slope of displacement against force over the loading parts of presses, each with a zero of its
// own: unloading would mix in what the material keeps. Both have errors: force that of
// `force_sigma` [N], displacement what the samples show. Plain regression of force on displacement
// takes the noise of the displacement for yielding, and is 42 % too soft at 3000 N/m with 0.3 mm.
// The deviation counts the noise as correlated from sample to sample as the residuals are;
// `alike_in_a_press`: as at least what the presses differ by among themselves, for displacements
// whose errors last as long as one, such as a smoothed path's; with few presses as much wider as
// two of three intervals of one deviation, either way, need to hold the truth; a single press tells
// no difference, and is as uncertain as its samples' `sigma` makes the rise.
// Samples more than 0.05 s apart belong to two presses. nullopt without a loading of at least
// `least_rise` [N].
std::optional<ComplianceEstimate> estimateCompliance(const std::vector<PressSample>& samples,
                                                     double force_sigma,
                                                     bool alike_in_a_press = false,
                                                     double least_rise = 0.3);

} // namespace patina
