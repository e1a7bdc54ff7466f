// The brush: turns samples of a stroke into new paint of the objects (K15-K20).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "authoring/brush/paint_surface.h"
#include "field/store/field_grid.h"
#include "scene/stroke.h"

namespace patina {

// Positions and radii of a stroke's dabs (K19).
struct PathStep {
  Vec3 position = Vec3::Zero(); // [m], world; near the surface
  double radius = 0;            // [m]
  bool connected = false;       // to the step before
  std::optional<Vec3> tip{};    // [m], world; absent unless both samples have one
};

class StrokePath {
 public:
  StrokePath(const Brush& brush, const FieldGrid& grid) : brush_(brush), grid_(grid) {}

  // Returns the dabs from the last sample to this one, spaced by a quarter of the radius but by no
  // less than 1/64 voxel. Ends at this sample unless it lies outside the field. The radius follows
  // the force through a 50 ms low-pass in sample time. Ignores samples that are not finite or
  // absurdly far away.
  std::vector<PathStep> advanceTo(const StrokeSample& sample);
  bool reached() const { return reached_; } // the last step is at the last sample

 private:
  Brush brush_;
  FieldGrid grid_;
  std::optional<StrokeSample> last_;
  double radius_ = 0; // at the last sample
  bool reached_ = false;
};

struct PaintReport {
  std::size_t dabs = 0, faces = 0, texels = 0, nodes = 0; // sums over dabs
  std::size_t missed = 0; // samples without surface within the brush

  PaintReport& operator+=(const PaintReport& other);
};

// Parts of one object to refresh after some dabs.
struct PaintChange {
  std::size_t object = 0;
  bool images = false; // colour or relief has changed
  std::vector<MaterialMap::Index> material_blocks;
};

// begin() and end() enclose one stroke. The result depends only on the scene, the brush and the
// samples, not on their timing: replaying a stroke gives the same bits.
class Painter {
 public:
  // `scene` must be that of the surface, with any paint.
  Painter(std::shared_ptr<const PaintSurface> surface, const Scene& scene);
  ~Painter();

  // Throws Error if the brush is invalid or would paint relief of zero height; invalid_argument if
  // it paints images and the surface has none.
  void begin(const Brush& brush);
  // Paints from the last sample to this one with dabs at most a quarter of the radius apart. A
  // non-finite sample counts as missed, so that a brief dropout of a device does not end the
  // stroke. All modes but build_up and smooth, and the eraser too, use each point's largest weight
  // along the path, which leaves no ripples and makes the result independent of the sample rate.
  PaintReport dab(const StrokeSample& sample);
  void end();

  // Returns the current paint, in scene order. Earlier results do not change.
  const std::vector<std::shared_ptr<const ObjectPaint>>& paint() const;
  std::vector<PaintChange> takeChanges(); // since the last call

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns `scene` after the whole stroke.
Scene painted(std::shared_ptr<const PaintSurface> surface, const Scene& scene, const Stroke& stroke,
              PaintReport* report = nullptr);

// Returns w of K17 for d >= 0; 0 for d >= r.
double brushWeight(const Brush& brush, double distance, double radius);
double brushRadius(const Brush& brush, double force); // K19

} // namespace patina
