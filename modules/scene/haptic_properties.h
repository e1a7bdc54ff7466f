// What a surface feels like, as a person set it. An absent feature is an absent value.
#pragma once

#include <optional>

namespace patina {

struct Friction {
  double static_coefficient = 0;  // mu_s >= mu_d
  double dynamic_coefficient = 0; // mu_d >= 0
  double depth_gain = 0;          // gamma of K10 (ii): mu (1 + gamma d / d_ref), d_ref = 1 mm
  // K09 moves the VCP towards the tip's candidate; `displacement` opposes the motion over the
  // tangent plane, which on a curved path is nearer to Coulomb's law (docs/papers.md).
  enum class SlipDirection { paper, displacement } slip = SlipDirection::paper;
  bool operator==(const Friction&) const = default;
};

// K13: in the band 0 < phi < range the tip is pulled to the surface, F = -strength phi n.
struct Magnet {
  double range = 0;    // w [m]
  double strength = 0; // k_m [N/m]
  // Over the last quarter of the range the pull falls to zero, so that the force is continuous
  // where the band ends; as in the paper it steps there by strength * range.
  bool fades = false;
  bool operator==(const Magnet&) const = default;
};

struct HapticProperties {
  double stiffness = 500;               // K [N/m]
  std::optional<double> damping;        // B [N s/m]
  std::optional<double> damping_cutoff; // [Hz], of the velocity that damping sees; absent = none
  std::optional<Friction> friction;
  std::optional<double> tip_radius; // [m]: the tip's centre feels the iso-surface at this value
  std::optional<double> offset;     // delta [m], K12; excludes a magnet
  std::optional<Magnet> magnet;
  // k_t (A22): Fourier textures are a layer this many times as stiff as the surface, pressed beside
  // it; absent: they are the surface's own shape, as stiff as their compliance says.
  std::optional<double> texture_gain;
  // proxy: the nearest point that the tip's proxy can reach over the surface (P01).
  // ray: as in the paper, on the surface along the interpolated gradient, from the tip alone (K05,
  // K06): past the middle of a part the force turns round.
  enum class Contact { proxy, ray } contact = Contact::proxy;
  double force_limit = 3.3; // [N], the magnitude; never left out
  bool operator==(const HapticProperties&) const = default;
};

} // namespace patina
