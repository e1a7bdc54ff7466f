// Test shapes for contact methods: about 100 mm long, most of them closed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/sides/open_parts.h"
#include "haptics/law/snapshot.h"

namespace patina {

struct ContactScene {
  std::string name;
  std::vector<TriangleMesh> meshes;           // [m]; several form one solid by min (K14)
  std::vector<double> isos = {0, 1e-3, 2e-3}; // [m]; without 0 if parts have no thickness
  OpenSides sides = OpenSides::automatic;     // for open parts
};

// All scenes, equal at every call.
std::vector<ContactScene> contactScenes();
ContactScene contactScene(const std::string& name); // throws invalid_argument naming the known ones
std::vector<std::string> contactSceneNames();

// Boxes [x0, x1] x [y0, y1] x [z0, z1] of the cells with `filled`, as one closed mesh; it must be a
// manifold.
TriangleMesh cellSolid(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& z,
                       const std::function<bool(int, int, int)>& filled);
// Extrudes a polygon of the x-z plane, counter-clockwise seen from -y, along y from -width / 2 to
// width / 2. It must be star-shaped about its first corner.
TriangleMesh prism(const std::vector<Vec2>& polygon, double width);
// A block with a top z = height(x, y) of cells x cells quads and the bottom z = floor.
TriangleMesh reliefBlock(double side, double floor, int cells,
                         const std::function<double(double, double)>& height);
TriangleMesh plateSolid(double thickness);     // 100 mm x 100 mm, across z
TriangleMesh tilted(const TriangleMesh& mesh); // tilted by 40 degrees about (1, 2, 3)
TriangleMesh lSolid();                         // inner edge along y at x = z = 0
TriangleMesh roomSolid();                      // inner corner at 0, free where x, y, z > 0
TriangleMesh grooveSolid(double opening);      // angle in degrees; its bottom along y at x = z = 0
TriangleMesh roughSolid(unsigned seed);        // like a scan: noise, uneven triangles
// The same with holes of one triangle each, too narrow for a tip of 1 mm radius.
TriangleMesh scanSolid(unsigned seed);

// Differs between scenes and isos, so that no two use the same paths.
unsigned trialSeed(const ContactScene& scene, double iso, unsigned seed);

// Stiffness of all checks [N/m].
inline constexpr double kTestStiffness = 500;

// The program's field with a band wide enough for `iso`.
std::shared_ptr<const SurfaceField> contactField(const ContactScene& scene, double iso,
                                                 int resolution);
// Snapshot of the field: `contact` is the value of the key "contact" (empty: the default); the
// force limit is too high to hide a step. iso is the tip's radius.
std::shared_ptr<const HapticSnapshot> contactSnapshot(std::shared_ptr<const SurfaceField> field,
                                                      double iso, const std::string& contact);

} // namespace patina
