// What a scene compiles to: one field of all its objects (K14) and the stages of the servo.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "field/build/build_field.h"
#include "field/merge/merge_fields.h"
#include "field/merge/union_surface.h"
#include "geometry/mesh/mesh_report.h"
#include "haptics/servo/snapshot.h"
#include "scene/scene.h"
#include "session/build/compile_paint.h"

namespace patina {

// An object's mesh in the world frame; an untouched pose leaves it bit for bit.
TriangleMesh worldMesh(const SceneObject& object);
// The scene's objects as one mesh in the world frame, one after another.
TriangleMesh worldMesh(const Scene& scene);
// Counts of several meshes that share nothing.
MeshReport sumOf(const std::vector<MeshReport>& reports);

// One object by itself: kept while neither its mesh nor its pose changes, so that an edit of
// another object costs no rebuild. Immutable.
struct CompiledObject {
  SceneObject object;
  std::shared_ptr<const TriangleMesh> mesh; // world frame
  MeshReport mesh_report;
  BuiltField built; // no samples; no field where it was built together with others
  std::array<int, 3> first_block{};
};

// Everything that a scene compiles to. Immutable.
struct CompiledScene {
  Scene scene;
  std::shared_ptr<const TriangleMesh> mesh; // world frame; shared by versions that differ in feel
  MeshReport mesh_report;
  BuiltField built; // with the sample layer; relief is never in it
  FeltPaint paint;  // what of the scene's paint is felt, and the field with it
  std::shared_ptr<const HapticSnapshot> snapshot;
  BlockLattice lattice;
  double band = 0; // voxels: scene.field.band, or more where an offset or a magnet reaches farther
  std::vector<std::shared_ptr<const CompiledObject>> objects; // in the scene's order
  std::vector<FieldPart> parts; // theirs, one each or of some together; first_face is in `mesh`
};

// Nearest faces by node, a layer of the field: read by what is painted and by merge.redistance, and
// by a brush. kept: whatever is painted next finds them, and each object stays by itself; if_read:
// absent where nothing in the scene reads them, and closed objects that keep clear of each other
// are built as one, the more quickly the smaller they are.
enum class FaceLayer : std::uint8_t { kept, if_read };

// Slow; polls progress, throws Cancelled. Safe on a background thread. One object keeps the grid
// that fits it; several share a lattice about all of them.
std::shared_ptr<const CompiledScene> compile(Scene scene, Progress& progress,
                                             FaceLayer faces = FaceLayer::kept);
// For objects added, moved or removed, and for any other change: fields of objects with the same
// mesh and pose are kept (if they have their faces), so that only the others are built and the
// union is made anew. The lattice and its voxel stay, too, until field values change or the scene
// has outgrown them (more than twice or less than half the cells that `resolution` asks for); then
// all is built as by compile(). `room`: at least so far from the surface shall be felt, for what is
// painted next.
std::shared_ptr<const CompiledScene> recompile(const CompiledScene& old, Scene scene,
                                               Progress& progress, const FeltReach& room = {});
// Whether what is felt so far from the surface lies in the band.
bool fits(const CompiledScene& compiled, const FeltReach& reach);
// Whether retuned() can make `scene` from `old`: the same objects in the same places and the same
// field values, what is felt fits into the band, and faces are there if something reads them.
bool canRetune(const CompiledScene& old, const Scene& scene);
// Only values of touch and device, names or paint changed: keeps the field, whatever reach they ask
// for; throws Error if that does not fit. Quick: only what differs is made anew.
std::shared_ptr<const CompiledScene> retuned(const CompiledScene& old, Scene scene);

// The triangles that can be felt: without unusable ones, and of several objects what none hides, so
// that a distance to them is one to the union. Faces are named as in compiled.mesh.
UnionSurface feltTriangles(const CompiledScene& compiled, const Progress& progress);
// Held for later edits beyond what the field itself shares with it; 0 for one object.
std::size_t mergeBytes(const CompiledScene& compiled);

} // namespace patina
