// Parametric meshes for tests, studies and the data that ships with the program. Metres, closed
// and outward-facing unless said.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// All throw std::invalid_argument for a size that is not positive or counts too small for the
// shape.

// Icosahedron whose faces are split at `frequency` (20 f^2 triangles), vertices on the sphere.
TriangleMesh icosphere(double radius, int frequency);
// About the z axis; 2 * around * across triangles.
TriangleMesh torus(double major_radius, double minor_radius, int around, int across);
// Centred box; `cells` quads along each side of each face. A thin plate is box(Vec3(w, d, t), n).
TriangleMesh box(const Vec3& size, int cells = 1);
// A vase on z = 0: outer and inner profile of revolution about z, `wall` thick, closed. Has
// 4 * around * along triangles; the defaults are the pottery of the paper (K25): 4,800.
TriangleMesh vase(double height = 0.12, double wall = 0.004, int around = 48, int along = 25);
// A rectangular sheet z = 0, open, n x n quads, facing +z.
TriangleMesh sheet(double width, double depth, int cells);
// A ship of thin sheets (hull, deck, keel, masts, sails), open and non-manifold on purpose: the
// paper's galleon case (K25), 8,794 triangles. `length` is the whole extent along x, bowsprit
// included; z is up.
TriangleMesh galleon(double length);

// Defects on purpose, for the tests of the sign rule. The same seed gives the same mesh.

// Cracks: every triangle shrunk towards its centroid by `fraction` (0 .. 1), with its own vertices.
TriangleMesh withShrunkenTriangles(const TriangleMesh& mesh, double fraction);
// Each face is turned round with probability `fraction`.
TriangleMesh withFlippedFaces(const TriangleMesh& mesh, double fraction, unsigned seed);
// Removes the faces with a corner within `radius` of one of `holes` random vertices.
TriangleMesh withHoles(const TriangleMesh& mesh, int holes, double radius, unsigned seed);

} // namespace patina
