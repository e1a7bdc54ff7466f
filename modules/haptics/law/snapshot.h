// Immutable data that the servo reads, compiled from a scene.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "haptics/law/contact_memory.h"
#include "haptics/law/interaction_range.h"
#include "haptics/law/stabilisers.h"
#include "scene/scene.h"

namespace patina {

struct StageInfo {
  std::string name;      // "contact", "damping", "friction", "limit"
  std::string why;       // "friction.static = 0.5"
  std::size_t bytes = 0; // memory of this stage beyond the object itself
};

struct HapticSnapshot {
  std::shared_ptr<const SurfaceField> field; // with sample layer; world frame
  std::vector<HapticObject> objects;
  std::vector<std::unique_ptr<const ForceStage>> stages;
  std::vector<StageInfo> why; // one entry per stage
  StabiliserPlan stabilisers; // their stages are in `stages`; coupling->stiffness is k_c
  Material base;              // material where nothing is painted

  void add(const char* name, std::unique_ptr<const ForceStage> stage, std::string reason,
           std::size_t bytes = 0);
};

// Creates only the stages that the scene needs; the force limit is always present. Throws Error if
// the field's band is smaller than InteractionRange requires. `field`: the scene's objects in the
// world frame, with baked relief; `objects`: in the scene's order, empty = nothing painted.
std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const HapticObject> objects = {});

// Returns planStabilisers() of the scene with its painted range.
StabiliserPlan planOf(const Scene& scene, std::span<const HapticObject> objects = {});

// compileStages() with a plan other than planOf().
std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const HapticObject> objects,
                                                    const StabiliserPlan& plan);

// State of a tick before its first stage.
Contact beginTick(const HapticSnapshot& snapshot, const ContactMemory& memory, const Vec3& tip,
                  double dt) noexcept;

// One servo tick, a pure function without a clock. A NaN or infinite tip: no contact, no force.
Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept;

} // namespace patina
