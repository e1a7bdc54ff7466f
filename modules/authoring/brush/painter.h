// A brush at work: samples of a stroke in, new paint of the objects out (K15-K20).
#pragma once

#include <memory>
#include <vector>

#include "authoring/brush/paint_surface.h"
#include "scene/stroke.h"

namespace patina {

struct PaintReport {
  std::size_t dabs = 0, faces = 0, texels = 0, nodes = 0; // touched, summed over dabs
  std::size_t missed = 0; // samples with no surface within the brush

  PaintReport& operator+=(const PaintReport& other);
};

// What to refresh of one object after some dabs.
struct PaintChange {
  std::size_t object = 0;
  Box3 region; // world, of the surface that was touched
  std::vector<std::size_t> color_tiles, relief_tiles;
  std::vector<MaterialMap::Index> material_blocks;
};

// Between begin() and end() lies one stroke. The result depends on the scene, the brush and the
// samples alone, not on when they come: replaying a stroke gives the same bits.
class Painter {
 public:
  // `scene` must be the one that the surface was made for, with any paint.
  Painter(std::shared_ptr<const PaintSurface> surface, const Scene& scene);
  ~Painter();

  // Throws Error if the brush makes no sense or paints relief of no height; invalid_argument if it
  // paints images and the surface has none.
  void begin(const Brush& brush);
  // Paints from the last sample to this one: dabs no farther apart than a quarter of the radius. A
  // sample that is not finite counts as missed: a device that loses its place for a moment does not
  // end the stroke. Every mode but build_up and smooth gives each place its greatest weight along
  // the path, the eraser too, so that no ripples are left and the rate of samples does not matter.
  PaintReport dab(const StrokeSample& sample);
  void end();

  // Paint as it is now, in the order of the scene's objects. Earlier results stay as they were.
  const std::vector<std::shared_ptr<const ObjectPaint>>& paint() const;
  std::vector<PaintChange> takeChanges(); // since the last call

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// `scene` after the whole stroke.
Scene painted(std::shared_ptr<const PaintSurface> surface, const Scene& scene, const Stroke& stroke,
              PaintReport* report = nullptr);

// w of K17 for d >= 0; 0 from r on.
double brushWeight(const Brush& brush, double distance, double radius);
double brushRadius(const Brush& brush, double force); // K19

} // namespace patina
