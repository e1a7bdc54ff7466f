#include "session/compile/compile_scene.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <mutex>
#include <unordered_set>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/error.h"
#include "core/numbers.h"
#include "field/merge/redistance.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/sides/inner_faces.h"
#include "haptics/catalog/device_catalog.h"

namespace patina {
namespace {

constexpr double kMaxBand = 64; // voxels, max of the scene's field.band

using Objects = std::vector<std::shared_ptr<const CompiledObject>>;
using Unbuilt = std::vector<std::shared_ptr<CompiledObject>>;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  double cpuSeconds() const { return processSeconds() - cpu_; }

 private:
  static double processSeconds() {
    std::timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = processSeconds();
};

bool same(const SceneObject& a, const SceneObject& b) {
  return a.mesh == b.mesh && a.world_from_object.matrix() == b.world_from_object.matrix();
}

bool same(const FieldSpec& a, const FieldSpec& b) {
  return a.resolution == b.resolution && a.voxel == b.voxel && a.band == b.band &&
         a.sides == b.sides;
}

bool readsFaces(const Scene& scene) {
  return (scene.redistance && scene.objects.size() > 1) ||
         std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const SceneObject& o) { return o.paint != nullptr; });
}

bool hasFaces(const std::shared_ptr<const SurfaceField>& field) {
  return field && field->face.size() == field->blockCount();
}

std::shared_ptr<const CompiledObject> withoutFaces(const CompiledObject& object) {
  auto bare = std::make_shared<CompiledObject>(object);
  auto field = std::make_shared<SurfaceField>(*object.built.field);
  field->face = {};
  bare->built.report.bytes = field->bytes();
  bare->built.field = std::move(field);
  return bare;
}

// Returns true if a lattice's voxel is still within a factor of two of `spec`.
bool isVoxelSuitable(double voxel, const FieldSpec& spec, const Box3& box) {
  if (spec.voxel) return true;
  const double cells = box.sizes().maxCoeff() / voxel + 2 * spec.band;
  return cells <= 2 * spec.resolution && cells >= 0.5 * spec.resolution;
}

class SharedProgress {
 public:
  SharedProgress(Progress& whole, std::size_t count) : whole_(whole), fraction_(count) {}
  Progress::Listener listener(std::size_t part) {
    return [this, part](double fraction, std::string_view what) {
      const std::lock_guard lock(mutex_);
      sum_ += fraction - std::exchange(fraction_[part], fraction);
      whole_.report(0.9 * sum_ / static_cast<double>(fraction_.size()), what);
    };
  }

 private:
  Progress& whole_;
  std::mutex mutex_;
  std::vector<double> fraction_;
  double sum_ = 0;
};

std::shared_ptr<CompiledObject> prepared(const SceneObject& object) {
  auto result = std::make_shared<CompiledObject>();
  result->object = object;
  result->mesh = std::make_shared<const TriangleMesh>(worldMesh(object));
  result->mesh_report = inspect(*result->mesh);
  return result;
}

// Groups consecutive closed objects that do not touch, to build them together: built alone, each
// small object would compute a band that it shares with its neighbours. Consecutive keeps their
// faces in order; closed, so that none changes another's inside.
Unbuilt groupsOf(const Unbuilt& objects) {
  Unbuilt groups;
  std::shared_ptr<CompiledObject> group;
  TriangleMesh mesh;
  std::vector<Box3> boxes;
  const auto close = [&] {
    if (group && boxes.size() > 1) group->mesh = std::make_shared<const TriangleMesh>(mesh);
    mesh = {};
    boxes.clear();
  };
  for (const auto& object : objects) {
    const Box3 box = fieldBounds(*object->mesh);
    const bool joins = group && group->mesh_report.watertight && object->mesh_report.watertight &&
                       std::none_of(boxes.begin(), boxes.end(),
                                    [&](const Box3& other) { return other.intersects(box); });
    if (!joins) {
      close();
      groups.push_back(group = std::make_shared<CompiledObject>(*object));
    }
    append(mesh, *object->mesh);
    boxes.push_back(box);
  }
  close();
  return groups;
}

void build(CompiledObject& object, const BlockLattice& lattice, double band, OpenSides sides,
           Progress& progress) {
  try {
    const BlockBox blocks = blocksAround(lattice, fieldBounds(*object.mesh), band);
    object.built = buildField(*object.mesh, gridOf(lattice, blocks), band, progress, sides);
    object.first_block = firstBlock(lattice, object.built.field->grid);
  } catch (const Error& error) {
    throw Error("object '" + object.object.name + "': " + error.what());
  }
}

// The voxel is that of the scene without paint. Only the band grows with relief, so that relief
// does not coarsen the grid.
FieldSpec bandFor(const Scene& scene, const Box3& box, const InteractionRange& reach) {
  const InteractionRange bare = interactionRange(scene.haptics);
  FieldSpec spec = bare.widened(scene.field, box);
  if (!(reach.length() > bare.length())) return spec;
  spec.voxel = gridAround(box, spec).voxel;
  spec = reach.widened(spec, box);
  if (spec.band > kMaxBand)
    throw Error("relief that reaches " + formatLength(reach.length() - bare.length()) + " needs " +
                formatNumber(spec.band) + " voxels of " + formatLength(*spec.voxel) +
                " on each side of the surface; the most is " + formatNumber(kMaxBand) +
                ": make it lower, or choose a larger voxel");
  return spec;
}

// Returns the pieces to merge: the built objects of compiled.scene on compiled.lattice, reused from
// `old` if possible, or groups of them if they need not stay apart. Sets objects, lattice and band.
Objects builtPieces(const CompiledScene* old, CompiledScene& compiled,
                    const InteractionRange& reserved_range, bool apart, Progress& progress) {
  const Scene& scene = compiled.scene;
  BlockLattice& lattice = compiled.lattice;
  Objects& objects = compiled.objects;
  objects.resize(scene.objects.size());
  Unbuilt fresh(objects.size());
  Box3 box;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (old)
      for (const auto& kept : old->objects)
        if (same(kept->object, scene.objects[i]) && hasFaces(kept->built.field)) objects[i] = kept;
    if (!objects[i]) objects[i] = fresh[i] = prepared(scene.objects[i]);
    box.extend(fieldBounds(*objects[i]->mesh));
    progress.throwIfCancelled();
  }
  InteractionRange reach = interactionRange(scene);
  if (reserved_range.length() > reach.length()) reach = reserved_range;
  const bool keep = old && same(old->scene.field, scene.field) &&
                    isVoxelSuitable(old->lattice.voxel, scene.field, box) &&
                    reach.band(old->lattice.voxel) <= old->band;
  const FieldSpec spec = bandFor(scene, box, reach);
  if (keep) {
    lattice = old->lattice;
    compiled.band = old->band;
  } else {
    const FieldGrid grid = gridAround(box, spec);
    lattice = {grid.origin, grid.voxel};
    compiled.band = spec.band;
    for (std::size_t i = 0; i < objects.size(); ++i)
      if (!fresh[i]) objects[i] = fresh[i] = std::make_shared<CompiledObject>(*objects[i]);
  }
  Unbuilt todo = fresh;
  std::erase(todo, nullptr);
  if (scene.objects.size() == 1 && !todo.empty() && !keep) {
    fresh[0]->built = buildField(*fresh[0]->mesh, spec, progress);
    fresh[0]->first_block = firstBlock(lattice, fresh[0]->built.field->grid);
    return objects;
  }
  if (!apart) todo = groupsOf(todo);
  SharedProgress shared(progress, todo.size());
  tbb::parallel_for(std::size_t{0}, todo.size(), [&](std::size_t i) {
    Progress part(progress, shared.listener(i));
    // Isolated: a thread that waits for one object's loops must not begin another object.
    tbb::this_task_arena::isolate(
        [&] { build(*todo[i], lattice, compiled.band, spec.sides, part); });
  });
  // Names may change while the field is kept.
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i]->object.name == scene.objects[i].name) continue;
    auto renamed = std::make_shared<CompiledObject>(*objects[i]);
    renamed->object.name = scene.objects[i].name;
    objects[i] = std::move(renamed);
  }
  return apart ? objects : Objects(todo.begin(), todo.end());
}

std::vector<FieldPart> partsOf(const Objects& pieces) {
  std::vector<FieldPart> parts;
  std::int32_t first_face = 0;
  for (const auto& piece : pieces) {
    parts.push_back({piece->built.field, piece->first_block, first_face, piece->built.caps});
    first_face += static_cast<std::int32_t>(piece->mesh->triangles.size());
  }
  return parts;
}

BuiltField mergedField(const Objects& pieces, const CompiledScene& compiled, Progress& progress) {
  const std::vector<FieldPart>& parts = compiled.parts;
  BuiltField built;
  progress.report(0.9, "merging");
  SurfaceField field = mergeFields(parts, compiled.lattice);
  for (const auto& piece : pieces) {
    const FieldReport& own = piece->built.report;
    built.report.dropped_triangles += own.dropped_triangles;
    built.report.ambiguous_signs += own.ambiguous_signs;
    built.report.inner_triangles += own.inner_triangles;
    built.report.open_parts += own.open_parts;
    built.report.open_triangles += own.open_triangles;
    built.report.parts.insert(built.report.parts.end(), own.parts.begin(), own.parts.end());
    built.report.holes.insert(built.report.holes.end(), own.holes.begin(), own.holes.end());
  }
  progress.throwIfCancelled();
  if (compiled.scene.redistance) {
    progress.report(0.92, "depths");
    Redistanced exact = redistanced(field, parts, compiled.lattice, *compiled.mesh, progress);
    field = std::move(exact.field);
    built.report.redistanced_nodes = exact.nodes;
  }
  built.field = std::make_shared<const SurfaceField>(std::move(field));
  built.report.blocks = built.field->blockCount();
  built.report.bytes = built.field->bytes();
  built.report.dense_bytes = built.field->grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
  progress.report(1, "field");
  return built;
}

std::shared_ptr<const CompiledScene> compileFrom(const CompiledScene* old, Scene scene,
                                                 const InteractionRange& reserved_range,
                                                 FaceLayer faces, Progress& progress) {
  validate(scene);
  (void)deviceNamed(scene.device);
  if (scene.objects.empty()) throw Error("the scene has no object: add a mesh to it");
  progress.throwIfCancelled();
  const Stopwatch watch;
  auto compiled = std::make_shared<CompiledScene>();
  compiled->scene = std::move(scene);
  const bool only_felt = faces == FaceLayer::on_demand && !readsFaces(compiled->scene);
  Objects pieces = builtPieces(old, *compiled, reserved_range, !only_felt, progress);
  if (only_felt)
    for (auto& piece : pieces) piece = withoutFaces(*piece);
  if (compiled->objects.size() == 1) compiled->objects = pieces;
  compiled->parts = partsOf(pieces);
  progress.throwIfCancelled();
  std::vector<MeshReport> reports;
  for (const auto& object : compiled->objects) reports.push_back(object->mesh_report);
  compiled->mesh_report = sumOf(reports);
  if (pieces.size() == 1) {
    compiled->mesh = pieces[0]->mesh;
    compiled->built = pieces[0]->built;
  } else {
    compiled->mesh = std::make_shared<const TriangleMesh>(worldMesh(compiled->scene));
    compiled->built = mergedField(pieces, *compiled, progress);
    compiled->built.report.seconds = watch.seconds();
    compiled->built.report.cpu_seconds = watch.cpuSeconds();
  }
  progress.throwIfCancelled();
  compiled->built.field = withSamples(std::move(compiled->built.field));
  compiled->paint = hapticPaint(*compiled, nullptr, progress);
  compiled->snapshot =
      compileStages(compiled->scene, compiled->paint.field, compiled->paint.objects);
  progress.throwIfCancelled();
  return compiled;
}

} // namespace

TriangleMesh worldMesh(const SceneObject& object) {
  if (object.world_from_object.matrix().isIdentity(0.0)) return *object.mesh;
  return transformed(*object.mesh, Eigen::Affine3d(object.world_from_object));
}

TriangleMesh worldMesh(const Scene& scene) {
  TriangleMesh world;
  for (const SceneObject& object : scene.objects) append(world, worldMesh(object));
  return world;
}

MeshReport sumOf(const std::vector<MeshReport>& reports) {
  MeshReport sum;
  sum.watertight = !reports.empty();
  for (const MeshReport& report : reports) {
    sum.triangles += report.triangles;
    sum.vertices += report.vertices;
    sum.components += report.components;
    sum.watertight = sum.watertight && report.watertight;
    sum.non_finite += report.non_finite;
    sum.degenerate += report.degenerate;
    sum.duplicate += report.duplicate;
    sum.boundary_edges += report.boundary_edges;
    sum.non_manifold_edges += report.non_manifold_edges;
    sum.misoriented_edges += report.misoriented_edges;
    sum.widest_crack = std::max(sum.widest_crack, report.widest_crack);
  }
  return sum;
}

std::shared_ptr<const CompiledScene> compile(Scene scene, Progress& progress, FaceLayer faces) {
  return compileFrom(nullptr, std::move(scene), {}, faces, progress);
}

std::shared_ptr<const CompiledScene> recompile(const CompiledScene& old, Scene scene,
                                               Progress& progress,
                                               const InteractionRange& reserved_range) {
  return compileFrom(&old, std::move(scene), reserved_range, FaceLayer::always, progress);
}

bool fits(const CompiledScene& compiled, const InteractionRange& reach) {
  return reach.band(compiled.built.field->grid.voxel) <= compiled.band;
}

bool canReuseField(const CompiledScene& old, const Scene& scene) {
  if (scene.objects.size() != old.objects.size()) return false;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (!same(old.objects[i]->object, scene.objects[i])) return false;
  return same(old.scene.field, scene.field) && old.scene.redistance == scene.redistance &&
         fits(old, interactionRange(scene, &old)) &&
         (!readsFaces(scene) || hasFaces(old.built.field));
}

std::shared_ptr<const CompiledScene> withNewParameters(const CompiledScene& old, Scene scene) {
  validate(scene);
  (void)deviceNamed(scene.device);
  auto compiled = std::make_shared<CompiledScene>(old);
  compiled->scene = std::move(scene);
  Progress progress;
  compiled->paint = hapticPaint(*compiled, &old, progress);
  compiled->snapshot =
      compileStages(compiled->scene, compiled->paint.field, compiled->paint.objects);
  return compiled;
}

UnionSurface hapticTriangles(const CompiledScene& compiled, const Progress& progress) {
  UnionSurface surface = unionSurface(compiled.parts, compiled.lattice, *compiled.mesh, progress);
  if (compiled.built.report.inner_triangles == 0) return surface;
  std::vector<std::uint8_t> is_inner(compiled.mesh->triangles.size());
  std::size_t first_face = 0;
  for (const auto& object : compiled.objects) {
    TriangleMesh usable = *object->mesh;
    const std::vector<std::int32_t> faces = usableTriangles(usable);
    usable.triangles.clear();
    for (const std::int32_t f : faces)
      usable.triangles.push_back(object->mesh->triangles[index(f)]);
    for (const std::int32_t i : innerFaces(usable))
      is_inner[first_face + index(faces[index(i)])] = 1;
    first_face += object->mesh->triangles.size();
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surface.face.size(); ++i) {
    if (is_inner[index(surface.face[i])]) continue;
    surface.mesh.triangles[kept] = surface.mesh.triangles[i];
    surface.face[kept++] = surface.face[i];
  }
  surface.mesh.triangles.resize(kept);
  surface.face.resize(kept);
  return surface;
}

std::size_t mergeBytes(const CompiledScene& compiled) {
  if (compiled.objects.size() < 2) return 0;
  std::unordered_set<const void*> shared;
  const SurfaceField& field = *compiled.built.field;
  for (const auto& block : field.distance) shared.insert(block.get());
  for (const auto& block : field.face) shared.insert(block.get());
  std::size_t bytes = 0;
  for (const auto& object : compiled.objects)
    bytes += object->mesh->positions.size() * sizeof(Vec3) +
             object->mesh->triangles.size() * sizeof(Triangle);
  for (const FieldPart& part : compiled.parts) {
    if (part.field == compiled.built.field) continue;
    bytes += part.field->bytes();
    for (const auto& block : part.field->distance)
      if (shared.contains(block.get())) bytes -= block->bytes();
    for (const auto& block : part.field->face)
      if (shared.contains(block.get())) bytes -= block->bytes();
  }
  return bytes;
}

} // namespace patina
