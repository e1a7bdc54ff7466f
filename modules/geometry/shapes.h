// Parametric meshes for tests, studies and the data that ships with the program. Metres, closed
// and outward-facing unless said.
#pragma once

#include "geometry/triangle_mesh.h"

namespace patina {

// Icosahedron whose faces are split at `frequency` (20 f^2 triangles), vertices on the sphere.
TriangleMesh icosphere(double radius, int frequency);
TriangleMesh torus(double major_radius, double minor_radius, int around, int across);
// Centred box; `cells` quads along each side of each face.
TriangleMesh box(const Vec3& size, int cells = 1);
// A thin plate is box(Vec3(w, d, t), n).
// A vase: outer and inner profile of revolution, thin wall, closed (a bowl with thickness).
TriangleMesh vase(double height, double wall, int around, int along);
// A rectangular sheet z = 0, open, n x n quads.
TriangleMesh sheet(double width, double depth, int cells);
// A ship of thin sheets joined at a hull (open and non-manifold on purpose): the paper's galleon
// case, about 8,800 triangles.
TriangleMesh galleon(double length);

// Defects on purpose, for the tests of the sign rule. All take a fixed seed.
TriangleMesh withShrunkenTriangles(const TriangleMesh& mesh, double fraction); // cracks
TriangleMesh withFlippedFaces(const TriangleMesh& mesh, double fraction, unsigned seed);
TriangleMesh withHoles(const TriangleMesh& mesh, int holes, double radius, unsigned seed);

} // namespace patina
