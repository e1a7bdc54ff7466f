// What the servo reads: compiled from a scene, immutable.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "haptics/contact/contact_memory.h"
#include "haptics/servo/felt_reach.h"
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

  void add(const char* name, std::unique_ptr<const ForceStage> stage, std::string reason,
           std::size_t bytes = 0);
};

// Only the stages that the scene needs: absent value -> absent stage. The magnitude limit is never
// left out. Throws Error where the field's band is less than FeltReach asks for. `field` is the
// field of the scene's objects in the world frame, with relief in it where it is baked. `objects`:
// in the scene's order; empty = nothing is painted on any.
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
