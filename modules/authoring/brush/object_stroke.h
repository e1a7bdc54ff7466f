// All that one stroke does to one object.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "authoring/brush/dab_image.h"
#include "authoring/brush/dab_material.h"
#include "authoring/brush/painter.h"

namespace patina {

// What a stroke has in common for all objects.
struct StrokeTask {
  Brush brush;
  Material base;            // what is felt without paint
  double relief_height = 0; // [m] of g = 1
};

bool erases(const Brush& brush, Tool tool);
// Whether the brush changes images of an object that has this paint (null = none).
bool changesImages(const Brush& brush, const ObjectPaint* paint);

class ObjectStroke {
 public:
  // start: null = nothing painted yet.
  ObjectStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
               std::shared_ptr<const ObjectPaint> start, const StrokeTask& task);

  // Faces of the joint mesh, this object's. Adds texels and nodes to the report.
  void paint(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report);
  // As it is now; null if nothing is painted. The same value until something changes.
  std::shared_ptr<const ObjectPaint> paint();
  void finish();                     // drops what the eraser has emptied
  void collect(PaintChange& change); // adds what was written since the last call

 private:
  std::shared_ptr<const PaintSurface> surface_;
  std::size_t object_;
  Brush brush_;
  std::shared_ptr<const ObjectPaint> paint_;
  std::optional<ImageStroke> color_, relief_;
  std::optional<MaterialStroke> material_;
};

} // namespace patina
