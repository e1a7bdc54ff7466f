#include "authoring/images/emboss.h"

#include "field/surface/iso_surface.h"

namespace patina {

TriangleMesh embossed(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
                      std::span<const ReliefSource> sources, Progress& progress) {
  progress.report(0, "relief");
  const ReliefBake bake(std::move(base), mesh, sources, progress);
  const auto field = bake.baked(sources);
  progress.throwIfCancelled();
  progress.report(0.5, "surface");
  TriangleMesh surface = isoSurface(*field, 0);
  progress.report(1, "surface");
  return surface;
}

} // namespace patina
