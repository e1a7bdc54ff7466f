// Haptic properties of a surface as set by the user. An absent feature is an absent value.
#pragma once

#include <optional>

namespace patina {

struct Friction {
  double static_coefficient = 0;  // mu_s >= mu_d
  double dynamic_coefficient = 0; // mu_d >= 0
  double depth_gain = 0;          // gamma of K10 (ii): mu (1 + gamma d / d_ref), d_ref = 1 mm
  // K09 moves the contact point towards the tip's candidate; `displacement` opposes the motion in
  // the tangent plane, which is closer to Coulomb's law on a curved path (docs/papers.md).
  enum class SlipDirection { paper, displacement } slip = SlipDirection::paper;
  bool operator==(const Friction&) const = default;
};

// K13: for 0 < phi < range the tip is attracted to the surface, F = -strength phi n.
struct Magnet {
  double range = 0;    // w [m]
  double strength = 0; // k_m [N/m]
  // Reduces the force to zero over the last quarter of the range, which makes it continuous at its
  // end; in the paper it drops there by strength * range.
  bool fades = false;
  bool operator==(const Magnet&) const = default;
};

struct HapticProperties {
  double stiffness = 500;               // K [N/m]
  std::optional<double> damping;        // B [N s/m]
  std::optional<double> damping_cutoff; // [Hz], of the velocity filter for damping; absent = none
  std::optional<Friction> friction;
  std::optional<double> tip_radius; // [m]: in contact the tip's centre lies at this phi
  std::optional<double> offset;     // delta [m], K12; not together with a magnet
  std::optional<Magnet> magnet;
  // k_t (A22): Fourier textures are a layer this many times as stiff as the surface, compressed in
  // series with it; absent: they are part of the rigid shape, as stiff as their compliance gives.
  std::optional<double> texture_gain;
  // proxy: nearest point that the tip's proxy reaches over the surface (Zilles & Salisbury 1995),
  // P01. ray: as in the paper, along the interpolated gradient from the tip alone (K05, K06): the
  // force reverses beyond the middle of a part.
  enum class Contact { proxy, ray } contact = Contact::proxy;
  double force_limit = 3.3; // [N], magnitude; always present
  bool operator==(const HapticProperties&) const = default;
};

} // namespace patina
