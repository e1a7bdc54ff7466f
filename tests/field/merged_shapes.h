// Objects on a common lattice, like those of a scene.
#pragma once

#include <memory>
#include <vector>

#include "field/construction/build_field.h"
#include "field/merge/merge_fields.h"
#include "field/merge/redistance.h"
#include "geometry/mesh/shapes.h"

namespace patina::test {

struct MergedShapes {
  BlockLattice lattice;
  std::vector<FieldPart> parts;
  TriangleMesh joint;
  std::shared_ptr<const SurfaceField> field; // merged, with samples
  std::size_t redistanced = 0;
};

// Anchor and voxel are binary fractions unless given: every grid then names a node by the same
// bits.
inline MergedShapes mergedShapes(const std::vector<TriangleMesh>& meshes, double voxel = 0x1p-11,
                                 bool redistance = false, double band = 8) {
  MergedShapes m;
  m.lattice = {Vec3(-0x1p-4, -0x1p-4, -0x1p-4), voxel};
  Progress progress;
  for (const TriangleMesh& mesh : meshes) {
    const BlockBox blocks = blocksAround(m.lattice, fieldBounds(mesh), band);
    const BuiltField built = buildField(mesh, gridOf(m.lattice, blocks), band, progress);
    m.parts.push_back({built.field, firstBlock(m.lattice, built.field->grid),
                       static_cast<std::int32_t>(m.joint.triangles.size()), built.caps});
    m.joint = m.joint.triangles.empty() ? mesh : joined(m.joint, mesh);
  }
  SurfaceField field = mergeFields(m.parts, m.lattice);
  if (redistance) {
    Redistanced exact = redistanced(field, m.parts, m.lattice, m.joint, progress);
    m.redistanced = exact.nodes;
    field = std::move(exact.field);
  }
  m.field = withSamples(std::make_shared<const SurfaceField>(std::move(field)));
  return m;
}

inline TriangleMesh movedBy(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

} // namespace patina::test
