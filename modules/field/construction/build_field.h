// Builds the sampled implicit surface of a mesh (K01, K02).
#pragma once

#include <memory>

#include "core/progress.h"
#include "field/store/surface_field.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/sides/open_parts.h"

namespace patina {

struct FieldReport {
  double seconds = 0;     // wall-clock time
  double cpu_seconds = 0; // CPU time of all threads
  std::size_t blocks = 0;
  std::size_t bytes = 0;
  std::size_t dense_bytes = 0;                    // distance + face for every node of the same grid
  std::size_t dropped_triangles = 0;              // non-finite and degenerate
  std::size_t inner_triangles = 0;                // left out because inside a body (innerFaces)
  std::size_t ambiguous_signs = 0;                // nodes signed by majority
  std::size_t open_parts = 0, open_triangles = 0; // parts without an inside (openParts)
  std::vector<PartSides> parts;                   // parts of the mesh; empty without boundary edges
  std::vector<Hole> holes;                        // closed holes, the largest first
  std::size_t redistanced_nodes = 0; // nodes changed by redistance.h, if objects were merged
};

struct SheetCaps;

struct BuiltField {
  std::shared_ptr<const SurfaceField> field; // distance, face and coarse layers
  FieldReport report;
  std::shared_ptr<const SheetCaps> caps{}; // caps of sheets; null without one-sided open parts
};

// Computes the exact distance and nearest face of every node with |phi| <= band. Signs come from
// components of grid edges that the surface cannot cross (|d1| + |d2| > length), with votes by the
// generalised winding number, cross-checked. A one-sided open part is the front of a sheet as thick
// as the band (thickened_sheet.h); the nearest face to its back and sides is the front face before
// them, and the grid is padded for them. Parallel; polls `progress` and throws Cancelled.
// Degenerate, non-finite and inner triangles are dropped and counted. Face indices refer to `mesh`
// as given. Throws Error if no triangle is left or the grid is impossible.
BuiltField buildField(const TriangleMesh& mesh, const FieldSpec& spec, Progress& progress);

// The same on a given grid, which must extend at least `band` voxels beyond the mesh on each side.
BuiltField buildField(const TriangleMesh& mesh, const FieldGrid& grid, double band,
                      Progress& progress, OpenSides sides = OpenSides::automatic);

// Returns the grid grown by whole blocks on every side, for a mesh with one-sided open parts.
FieldGrid paddedForSheets(FieldGrid grid, double band);

// Returns the bounds of the triangles of a field. Throws Error if there is none.
Box3 fieldBounds(const TriangleMesh& mesh);

} // namespace patina
