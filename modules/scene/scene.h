// Everything a person authored or recorded, as plain values. An absent feature is an absent value.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "field/field_grid.h"
#include "field/field_sampler.h"
#include "geometry/triangle_mesh.h"

namespace patina {

struct SceneObject {
  std::string name;                         // unique in the scene; letters, digits, '-', '_'
  std::shared_ptr<const TriangleMesh> mesh; // [m], object frame
  Pose world_from_object = Pose::Identity();
};

struct Friction {
  double static_coefficient = 0;  // mu_s >= mu_d
  double dynamic_coefficient = 0; // mu_d >= 0
  double depth_gain = 0;          // gamma of K10 (ii): mu (1 + gamma d / d_ref), d_ref = 1 mm
  // K09 moves the VCP towards the tip's candidate; `displacement` opposes the motion over the
  // tangent plane, which on a curved path is nearer to Coulomb's law (docs/papers.md).
  enum class SlipDirection { paper, displacement } slip = SlipDirection::paper;
};

struct HapticProperties {
  double stiffness = 500;        // K [N/m]
  std::optional<double> damping; // B [N s/m]
  std::optional<Friction> friction;
  std::optional<double> tip_radius; // [m]: the tip's centre feels the iso-surface at this value
  double force_limit = 3.3;         // [N], the magnitude; never left out
};

struct Scene {
  std::vector<SceneObject> objects;
  FieldSpec field;
  Sampler sampler = Sampler::high;
  HapticProperties haptics;
  std::string device = "mouse"; // "mouse", "simulated"
};

// Throws Error in one line, naming the key and the allowed range, if a value makes no sense.
void validate(const Scene& scene);

// "friction.static", "0.5" and so on; the keys of DESIGN section 7. "none" makes a value absent.
// Throws Error for an unknown key (listing those known) or a bad value; the scene is then
// unchanged. Lengths take a unit ("0.5mm"). Of resolution and voxel the last one set holds. A first
// friction coefficient is both, so that the two may be set in either order; "none" for either
// takes friction away.
void setValue(Scene& scene, const std::string& key, const std::string& value);
// Several at once, judged together at the end, so that their order does not matter.
void setValues(Scene& scene, const std::vector<std::pair<std::string, std::string>>& list);
// Keys and present values, in the order of the documentation.
std::vector<std::pair<std::string, std::string>> values(const Scene& scene);

} // namespace patina
