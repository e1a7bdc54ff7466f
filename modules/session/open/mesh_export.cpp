#include "session/open/mesh_export.h"

#include <utility>

#include "session/compile/compile_paint.h"

namespace patina {

EmbossedMesh embossedMesh(Scene scene, Progress& progress) {
  scene.relief.mode = ReliefMode::pulled; // baked below, into a separate field
  return embossedMesh(*compile(std::move(scene), progress, FaceLayer::always), progress);
}

EmbossedMesh embossedMesh(const CompiledScene& compiled, Progress& progress) {
  const std::vector<ReliefInput> sources = reliefSources(compiled);
  EmbossedMesh made;
  made.mesh = embossed(compiled.built.field, *compiled.mesh, sources, progress);
  made.deviation = reliefDeviation(*compiled.mesh, sources, made.mesh);
  made.voxel = compiled.built.field->grid.voxel;
  return made;
}

} // namespace patina
