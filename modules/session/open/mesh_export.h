// The surface of a scene as a mesh for other programs.
#pragma once

#include "authoring/relief/emboss.h"
#include "core/progress.h"
#include "session/compile/compile_scene.h"

namespace patina {

struct EmbossedMesh {
  TriangleMesh mesh; // one for all objects
  ReliefDeviation deviation;
  double voxel = 0; // [m]
};

// Compiles the scene and makes its painted relief part of the surface. Throws Error, Cancelled.
EmbossedMesh embossedMesh(Scene scene, Progress& progress);
// The same from a scene that was compiled with pulled relief and FaceLayer::always.
EmbossedMesh embossedMesh(const CompiledScene& compiled, Progress& progress);

} // namespace patina
