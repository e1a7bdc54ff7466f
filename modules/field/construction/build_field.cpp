#include "field/construction/build_field.h"

#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>

#include <tbb/parallel_for.h>

#include "core/error.h"
#include "field/construction/distance_blocks.h"
#include "field/construction/thickened_sheet.h"
#include "field/signs/signs.h"
#include "geometry/mesh/orientation.h"
#include "geometry/sides/inner_faces.h"
#include "geometry/sides/open_parts.h"
#include "geometry/tree/triangle_tree.h"
#include "geometry/winding/winding_number.h"

namespace patina {
namespace {

constexpr double kPastBack = 1.5; // [voxel], required by sheetCaps()

double cpuSeconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Returns the valid triangles of a mesh, in order. Moves vertices of dropped triangles only, which
// may be NaN, to the origin.
TriangleMesh onlyFaces(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  TriangleMesh sound;
  sound.positions = mesh.positions;
  for (Vec3& p : sound.positions)
    if (!p.allFinite()) p.setZero();
  sound.triangles.reserve(faces.size());
  for (const std::int32_t f : faces)
    sound.triangles.push_back(mesh.triangles[static_cast<std::size_t>(f)]);
  return sound;
}

// Returns `faces` without the entries at the indices `dropped`, which ascend.
template <class Face>
std::vector<Face> without(const std::vector<Face>& faces,
                          const std::vector<std::int32_t>& dropped) {
  std::vector<Face> left;
  left.reserve(faces.size() - dropped.size());
  auto next = dropped.begin();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (next != dropped.end() && index(*next) == i)
      ++next;
    else
      left.push_back(faces[i]);
  }
  return left;
}

std::vector<std::int32_t> someUsable(const TriangleMesh& mesh) {
  std::vector<std::int32_t> usable = usableTriangles(mesh);
  if (usable.empty()) throw Error("field: the mesh has no triangle with an area");
  return usable;
}

TriangleMesh closedPart(const TriangleMesh& mesh, const OpenParts& open) {
  std::vector<std::int32_t> faces;
  for (std::size_t f = 0; f < open.open.size(); ++f)
    if (!open.open[f]) faces.push_back(static_cast<std::int32_t>(f));
  return onlyFaces(mesh, faces);
}

// Signs nodes inside the thickened sheets, then replaces the front's distances by those to the
// whole sheets. The faces of `builder` then refer to `mesh`. Returns the caps.
SheetCaps thickenSheets(FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                        const OpenParts& open, double band, Progress& progress) {
  SheetCaps caps = sheetCaps(builder, mesh, tree, open, band, progress);
  const auto own = static_cast<std::int32_t>(mesh.triangles.size());
  const TriangleMesh plates = joined(mesh, caps.mesh);
  FieldBuilder whole =
      distanceBlocks(plates, TriangleTree(plates), builder.field.grid, band, progress, 0.7, 1);
  copySigns(whole, builder);
  tbb::parallel_for(std::size_t{0}, whole.face.size(), [&](std::size_t slot) {
    whole.face[slot] = renumbered(*whole.face[slot], [&](std::int32_t face) {
      return face < own ? face : caps.face[static_cast<std::size_t>(face - own)];
    });
  });
  builder = std::move(whole);
  return caps;
}

void renumberFaces(FieldBuilder& builder, SheetCaps& caps,
                   const std::vector<std::int32_t>& face_of) {
  for (std::int32_t& face : caps.face) face = face_of[static_cast<std::size_t>(face)];
  tbb::parallel_for(std::size_t{0}, builder.face.size(), [&](std::size_t slot) {
    builder.face[slot] = renumbered(*builder.face[slot], [&](std::int32_t face) {
      return face_of[static_cast<std::size_t>(face)];
    });
  });
}

// grid_for(box of the valid triangles) chooses the grid.
template <class GridFor>
BuiltField build(const TriangleMesh& mesh, const GridFor& grid_for, double band, OpenSides sides,
                 Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = cpuSeconds();
  progress.throwIfCancelled();
  progress.report(0, "triangles");

  std::vector<std::int32_t> usable = someUsable(mesh);
  FieldReport report;
  report.dropped_triangles = mesh.triangles.size() - usable.size();
  std::optional<TriangleMesh> reduced;
  if (report.dropped_triangles > 0) reduced = onlyFaces(mesh, usable);
  std::vector<Triangle> welded = weldedTriangles(reduced ? *reduced : mesh);
  if (const auto inner = innerFaces(reduced ? *reduced : mesh, welded); !inner.empty()) {
    report.inner_triangles = inner.size();
    usable = without(usable, inner);
    welded = without(welded, inner);
    reduced = onlyFaces(mesh, usable);
  }
  const TriangleMesh& sound = reduced ? *reduced : mesh;

  FieldGrid grid = grid_for(bounds(sound));
  std::optional<TriangleMesh> turned;
  if (const auto wrong = misorientedTriangles(sound, welded); !wrong.empty()) {
    turned = sound;
    for (const std::int32_t f : wrong)
      for (auto* triangles : {&turned->triangles, &welded})
        std::swap((*triangles)[index(f)][1], (*triangles)[index(f)][2]);
  }
  const TriangleMesh& oriented = turned ? *turned : sound;
  WindingNumber winding(oriented);
  OpenParts open = openParts(oriented, welded, winding, sides, grid.voxel);
  welded = {};
  if (open.any()) winding = WindingNumber(closedPart(oriented, open));
  report.open_parts = open.parts;
  report.open_triangles = open.triangles;
  report.parts = open.decided;
  report.holes = std::move(open.holes);

  const bool plates = open.any() && !haveTwoSides(sides);
  if (plates) grid = paddedForSheets(grid, band);
  const TriangleTree tree(sound);
  progress.throwIfCancelled();
  progress.report(0.1, "distances");
  FieldBuilder builder =
      distanceBlocks(sound, tree, grid, plates ? band + kPastBack : band, progress, 0.1, 0.7);
  progress.report(0.7, "signs");
  report.ambiguous_signs =
      assignSigns(builder, oriented, tree, winding, open, plates ? band : 0, progress);
  SheetCaps caps;
  if (plates) caps = thickenSheets(builder, oriented, tree, open, band, progress);
  report.ambiguous_signs += caps.doubtful;
  signCoarse(builder);
  progress.throwIfCancelled();
  if (reduced) renumberFaces(builder, caps, usable);

  auto field = std::make_shared<const SurfaceField>(finish(std::move(builder)));
  report.blocks = field->blockCount();
  report.bytes = field->bytes();
  report.dense_bytes = grid.nodeCount() * (sizeof(float) + sizeof(std::int32_t));
  report.cpu_seconds = cpuSeconds() - cpu_start;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.report(1, "field");
  return {std::move(field), report,
          plates ? std::make_shared<const SheetCaps>(std::move(caps)) : nullptr};
}

} // namespace

FieldGrid paddedForSheets(FieldGrid grid, double band) {
  const int nodes = kBlockSide * static_cast<int>(std::ceil(band / kBlockSide));
  grid.origin -= Vec3::Constant(nodes * grid.voxel);
  for (int& n : grid.nodes) n += 2 * nodes;
  return grid;
}

BuiltField buildField(const TriangleMesh& mesh, const FieldSpec& spec, Progress& progress) {
  return build(
      mesh, [&](const Box3& box) { return gridAround(box, spec); }, spec.band, spec.sides,
      progress);
}

BuiltField buildField(const TriangleMesh& mesh, const FieldGrid& grid, double band,
                      Progress& progress, OpenSides sides) {
  return build(
      mesh, [&](const Box3&) { return grid; }, band, sides, progress);
}

Box3 fieldBounds(const TriangleMesh& mesh) {
  Box3 box;
  for (const std::int32_t f : someUsable(mesh))
    for (int c = 0; c < 3; ++c) box.extend(mesh.corner(static_cast<std::size_t>(f), c));
  return box;
}

} // namespace patina
