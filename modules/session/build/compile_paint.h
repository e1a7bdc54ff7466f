// What of a scene's paint is felt: material and relief, as the servo reads them.
#pragma once

#include <memory>
#include <vector>

#include "authoring/brush/painter.h"
#include "authoring/relief/relief_bake.h"
#include "authoring/relief/relief_limits.h"
#include "authoring/relief/relief_smoothing.h"
#include "haptics/servo/felt_reach.h"
#include "scene/paint/grey_relief.h"
#include "scene/scene.h"

namespace patina {

struct CompiledScene;

// One object's relief, with what the next version may make use of.
struct FeltRelief {
  GreyImage grey;                                 // where relief is the colour's
  std::shared_ptr<const TiledImage> source, felt; // the same unless it is smoothed
  std::shared_ptr<const ImageRange> source_range, felt_range;
  std::shared_ptr<const ReliefSmoother> smoother; // absent: not smoothed
  std::shared_ptr<const BendMap> bend_map;        // absent: nothing asks how steady it is
  std::vector<float> bends;                       // of `felt`, by tile
};

// Absent wherever nothing is painted. Immutable; versions share what did not change.
struct FeltPaint {
  std::vector<FeltObject> objects;        // in the scene's order; empty = nothing painted is felt
  std::shared_ptr<const ReliefBake> bake; // only where relief is baked
  std::vector<FeltRelief> relief;         // by object, only where relief is felt
  // What is felt: compiled.built.field, or that with relief in it.
  std::shared_ptr<const SurfaceField> field;

  std::size_t bytes() const; // beyond the scene's own images and maps
};

// `before` may be null: only tiles that differ from its are looked at.
FeltReach feltReach(const Scene& scene, const CompiledScene* before = nullptr);
// The same once a stroke with this brush has been painted, whatever its samples.
FeltReach reachAfter(const CompiledScene& compiled, const Brush& brush);

// `compiled` has objects, mesh and field; its scene may have changed in paint and values since
// `before` (null: nothing is kept).
FeltPaint feltPaint(const CompiledScene& compiled, const CompiledScene* before, Progress& progress);

// What of it an engine that bakes reads; without relief no source has an image.
std::vector<ReliefSource> reliefSources(const CompiledScene& compiled);

// What differs between two paints of the same objects, tile by tile; no regions.
std::vector<PaintChange> paintChanges(const Scene& before, const Scene& after);

} // namespace patina
