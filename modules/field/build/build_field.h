// From a mesh to its sampled implicit surface (K01, K02).
#pragma once

#include <memory>

#include "core/progress.h"
#include "field/store/surface_field.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/open_parts.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct FieldReport {
  double seconds = 0;     // wall
  double cpu_seconds = 0; // of all threads
  std::size_t blocks = 0;
  std::size_t bytes = 0;
  std::size_t dense_bytes = 0;       // distance + face for every node of the same grid
  std::size_t dropped_triangles = 0; // non-finite and degenerate
  std::size_t inner_triangles = 0;   // inside a body (innerFaces): left out as well
  std::size_t ambiguous_signs = 0;   // nodes where the sign rules disagree; the majority stands
  std::size_t open_parts = 0, open_triangles = 0; // that have no inside (openParts)
  std::vector<PartSides> parts; // of the mesh; empty if no edge has one face
  std::vector<Hole> holes;      // that are closed over, the largest first
  std::size_t redistanced_nodes = 0;              // of several objects in one: see redistance.h
};

struct PlateCaps;

struct BuiltField {
  std::shared_ptr<const SurfaceField> field; // distance, face and coarse layers
  FieldReport report;
  std::shared_ptr<const PlateCaps> caps{}; // of its plates; null without one-sided open parts
};

// Exact distance and nearest face for every node with |phi| <= band; sign by connected components
// of edges that the surface cannot cross (|d1| + |d2| > length) and one generalised winding number
// for each, cross-checked. A one-sided open part is the front of a plate as thick as the band
// (plate.h); the nearest face to its back and sides is that of the front which they lie behind, and
// the grid gets room for them. Parallel; polls `progress` and throws Cancelled.
// Degenerate, non-finite and inner triangles are dropped and counted. Face indices refer to `mesh` as
// given. Throws Error if no triangle is left or the grid is impossible.
BuiltField buildField(const TriangleMesh& mesh, const FieldSpec& spec, Progress& progress);

// The same on a given grid, which must reach at least `band` voxels past the mesh on each side.
BuiltField buildField(const TriangleMesh& mesh, const FieldGrid& grid, double band,
                      Progress& progress, OpenSides sides = OpenSides::automatic);

// A grid grown by whole blocks on every side: that of a mesh with one-sided open parts.
FieldGrid withRoomForPlates(FieldGrid grid, double band);

// Of the triangles that a field is built from. Throws Error if there is none.
Box3 fieldBounds(const TriangleMesh& mesh);

} // namespace patina
