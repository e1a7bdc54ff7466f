// What the servo reads: compiled from a scene, immutable (DESIGN section 3).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "haptics/contact/contact_memory.h"
#include "haptics/servo/felt_object.h"
#include "haptics/stability/stabilisers.h"
#include "scene/scene.h"

namespace patina {

struct StageInfo {
  std::string name;      // "contact", "damping", "friction", "limit"
  std::string why;       // "friction.static = 0.5"
  std::size_t bytes = 0; // held for this stage beyond the stage itself
};

struct HapticSnapshot {
  std::shared_ptr<const SurfaceField> field; // with its sample layer; world frame
  std::vector<FeltObject> objects;
  std::vector<std::unique_ptr<const ForceStage>> stages;
  std::vector<StageInfo> why; // one entry a stage
  StabiliserPlan stabilisers; // what of it is present is a stage; coupling->stiffness is k_c
  Material base;              // what a contact is made of where nothing is painted

  void add(std::unique_ptr<const ForceStage> stage, std::string reason, std::size_t bytes = 0);
};

// How far from the surface its properties are felt: tip radius plus offset or magnetic range, and
// the highest |height| of relief that is pulled, roughness included [m] (raisedBy()). The field's
// band must be kBandBeyondReach voxels more; compileStages throws Error otherwise.
inline constexpr double kBandBeyondReach = 3;
double reachOf(const HapticProperties& haptics, double relief = 0);
// [m], of the surface that is felt over the one in the field: kRoughnessPeak times the roughest
// paint and the highest pulled relief.
double raisedBy(std::span<const FeltObject> objects);

// Only the stages that the scene needs: absent value -> absent stage. The magnitude limit is never
// left out. `field` is the field of the scene's objects in the world frame, with relief in it where
// it is baked. `objects`: in the scene's order; empty = nothing is painted on any.
std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects = {});

// What planStabilisers() gives a scene with what is painted on it.
StabiliserPlan planOf(const Scene& scene, std::span<const FeltObject> objects = {});

// compileStages() with stabilisers of another plan than planOf().
std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects,
                                                    const StabiliserPlan& plan);

// A tick before its first stage.
Contact beginTick(const HapticSnapshot& snapshot, const ContactMemory& memory, const Vec3& tip,
                  double dt) noexcept;

// One servo tick as a pure function of its arguments: dt is passed in, no clock is read.
// A NaN or infinite tip: no contact, zero force.
Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept;

} // namespace patina
