// Haptic data of a scene's paint: material and relief in the form that the servo reads.
#pragma once

#include <memory>
#include <vector>

#include "authoring/brush/painter.h"
#include "authoring/relief/relief_bake.h"
#include "authoring/relief/relief_limits.h"
#include "authoring/relief/relief_smoothing.h"
#include "haptics/law/interaction_range.h"
#include "scene/paint/grey_relief.h"
#include "scene/scene.h"

namespace patina {

struct CompiledScene;

// Relief of one object, with the parts that the next version can reuse.
struct HapticRelief {
  GreyImage grey;                                 // only if the relief is the colour's grey value
  std::shared_ptr<const TiledImage> source, felt; // the same image unless it is smoothed
  std::shared_ptr<const ImageRange> source_range, haptic_range;
  std::shared_ptr<const ReliefSmoother> smoother;    // null: not smoothed
  std::shared_ptr<const CurvatureMap> curvature_map; // null: the curvature is not needed
  std::vector<float> max_curvatures;                 // max |h''| of `felt` per tile [1/m]
};

// Empty if nothing is painted. Immutable; versions share unchanged parts.
struct HapticPaint {
  std::vector<HapticObject> objects;      // in the scene's order; empty = no haptic paint
  std::shared_ptr<const ReliefBake> bake; // only if relief is baked
  std::vector<HapticRelief> relief;       // per object, only if a relief is rendered
  // The rendered field: compiled.built.field, or that field with the relief baked in.
  std::shared_ptr<const SurfaceField> field;

  std::size_t bytes() const; // without the scene's own images and maps
};

// Only tiles that differ from those of `before` are examined. `before` may be null.
InteractionRange interactionRange(const Scene& scene, const CompiledScene* before = nullptr);
// Returns the range after a stroke with this brush, for any samples.
InteractionRange reachAfter(const CompiledScene& compiled, const Brush& brush);

// `compiled` has objects, mesh and field. Its scene may differ from that of `before` in paint and
// values only; null: nothing is reused.
HapticPaint hapticPaint(const CompiledScene& compiled, const CompiledScene* before,
                        Progress& progress);

// Inputs of a baking engine; a source has no image if there is no relief.
std::vector<ReliefInput> reliefSources(const CompiledScene& compiled);

// Tiles that differ between two paints of the same objects, without regions.
std::vector<PaintChange> paintChanges(const Scene& before, const Scene& after);

} // namespace patina
