// Parametric meshes for tests, studies and the data that ships with the program. In metres; closed
// and outward-facing unless stated.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// All throw std::invalid_argument for a size that is not positive or a count too small for the
// shape.

// Icosahedron whose faces are split at `frequency` (20 f^2 triangles), vertices on the sphere.
TriangleMesh icosphere(double radius, int frequency);
// Torus about the z axis; 2 * around * across triangles.
TriangleMesh torus(double major_radius, double minor_radius, int around, int across);
// Centred box; `cells` quads along each side of each face. A thin plate is box(Vec3(w, d, t), n).
TriangleMesh box(const Vec3& size, int cells = 1);
// Vase on z = 0: a profile of revolution about z, `wall` thick, closed; 4 * around * along
// triangles. The defaults give the paper's pottery (K25) of 4,800 triangles.
TriangleMesh vase(double height = 0.12, double wall = 0.004, int around = 48, int along = 25);
// Open rectangular sheet z = 0 of n x n quads, facing +z.
TriangleMesh sheet(double width, double depth, int cells);
// Ship of thin sheets (hull, deck, keel, masts, sails), deliberately open and non-manifold: the
// paper's galleon (K25) of 8,794 triangles. `length` is the extent along x with bowsprit; z is up.
TriangleMesh galleon(double length);

// Shrinks every triangle towards its centroid by `fraction` (0 .. 1), with vertices of its own.
TriangleMesh withShrunkenTriangles(const TriangleMesh& mesh, double fraction);

} // namespace patina
