// Compiles a scene into one field of all its objects (K14) and the stages of the servo.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "field/construction/build_field.h"
#include "field/merge/merge_fields.h"
#include "field/merge/union_surface.h"
#include "geometry/mesh/mesh_report.h"
#include "haptics/law/snapshot.h"
#include "scene/scene.h"
#include "session/compile/compile_paint.h"

namespace patina {

// Returns an object's mesh in the world frame; an identity pose leaves it bit for bit.
TriangleMesh worldMesh(const SceneObject& object);
// Returns the scene's objects as one mesh in the world frame, one after another.
TriangleMesh worldMesh(const Scene& scene);
// Adds the counts of meshes that share nothing.
MeshReport sumOf(const std::vector<MeshReport>& reports);

// One compiled object. It is reused while its mesh and pose stay the same, so that an edit of
// another object needs no rebuild. Immutable.
struct CompiledObject {
  SceneObject object;
  std::shared_ptr<const TriangleMesh> mesh; // world frame
  MeshReport mesh_report;
  BuiltField built; // no samples; no field if it was built together with others
  std::array<int, 3> first_block{};
};

// Result of compiling a scene. Immutable.
struct CompiledScene {
  Scene scene;
  // world frame; shared by versions that differ only in haptic values
  std::shared_ptr<const TriangleMesh> mesh;
  MeshReport mesh_report;
  BuiltField built;  // with the sample layer, without relief
  HapticPaint paint; // haptic data of the paint, and the field with its relief
  std::shared_ptr<const HapticSnapshot> snapshot;
  BlockLattice lattice;
  double band = 0; // voxels: scene.field.band, or more if an offset or a magnet needs it
  std::vector<std::shared_ptr<const CompiledObject>> objects; // in the scene's order
  std::vector<FieldPart> parts; // one per object or per group; first_face is an index in `mesh`
};

// Whether the field stores the nearest face of each node, which painting, brushes and
// merge.redistance need. always: every object keeps its own field. on_demand: only if something in
// the scene reads them; closed objects that do not touch are then built together, which is faster
// for small ones.
enum class FaceLayer : std::uint8_t { always, on_demand };

// Slow; polls progress, throws Cancelled. Safe on a background thread. A single object gets a grid
// that fits it; several objects share a lattice around all of them.
std::shared_ptr<const CompiledScene> compile(Scene scene, Progress& progress,
                                             FaceLayer faces = FaceLayer::always);
// Recompiles after any change. Fields of objects with the same mesh and pose are reused (if they
// have nearest faces), so that only the others are built and the union is computed again. Lattice
// and voxel stay until field values change or the scene needs more than twice or less than half of
// the cells given by `resolution`; then everything is built as by compile(). `reserved_range`: min
// interaction range that the band must cover, for paint that follows.
std::shared_ptr<const CompiledScene> recompile(const CompiledScene& old, Scene scene,
                                               Progress& progress,
                                               const InteractionRange& reserved_range = {});
// Returns true if this interaction range lies inside the band.
bool fits(const CompiledScene& compiled, const InteractionRange& reach);
// Returns true if withNewParameters() can make `scene` from `old`: same objects, poses and field
// values, the interaction range fits the band, and nearest faces are present if needed.
bool canReuseField(const CompiledScene& old, const Scene& scene);
// Recompiles after changes of haptic or device values, names or paint. The field stays; throws
// Error if the interaction range no longer fits it. Quick: only changed parts are computed.
std::shared_ptr<const CompiledScene> withNewParameters(const CompiledScene& old, Scene scene);

// Returns the triangles of the union's surface: no unusable or inner ones, and of several objects
// only those that no other object hides. Faces are numbered as in compiled.mesh.
UnionSurface hapticTriangles(const CompiledScene& compiled, const Progress& progress);
// Memory kept for later edits, without what the field itself shares; 0 for one object.
std::size_t mergeBytes(const CompiledScene& compiled);

} // namespace patina
