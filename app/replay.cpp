#include "app/replay.h"

#include <stdexcept>
#include <utility>

namespace patina {

std::shared_ptr<const PaintSurface> paintSurfaceOf(const CompiledScene& compiled,
                                                   std::shared_ptr<const PaintSurface> earlier,
                                                   bool with_images, Progress& progress) {
  const bool fits = earlier && earlier->mesh == compiled.mesh;
  std::shared_ptr<const PaintSurface> surface =
      fits ? std::move(earlier)
           : paintSurface(compiled.scene, compiled.mesh, compiled.built.field, progress);
  if (with_images && !hasImages(*surface)) surface = withImages(*surface, compiled.scene, progress);
  return surface;
}

bool needsImages(const Brush& brush) {
  if (brush.tool != Tool::erase) return !channelOf(brush.tool);
  return brush.erases.empty() || brush.erases == "color" || brush.erases == "relief";
}

Replayer::Replayer() : known_(std::make_shared<Known>()) {}

void Replayer::lend(std::shared_ptr<const CompiledScene> compiled,
                    std::shared_ptr<const PaintSurface> surface) {
  *known_ = {std::move(compiled), std::move(surface)};
}

Scene Replayer::operator()(const Scene& before, const Edit& edit) const {
  if (const auto* values = std::get_if<ValueEdit>(&edit)) {
    Scene after = before;
    setValues(after, values->values);
    return after;
  }
  const auto* stroke = std::get_if<Stroke>(&edit);
  if (!stroke) throw std::invalid_argument("Replayer: the scene of a SceneEdit was not kept");
  Progress progress;
  if (!known_->compiled || !canRetune(*known_->compiled, before))
    *known_ = {compile(before, progress), nullptr};
  known_->surface = paintSurfaceOf(*known_->compiled, std::move(known_->surface),
                                   needsImages(stroke->brush), progress);
  return painted(known_->surface, before, *stroke);
}

} // namespace patina
