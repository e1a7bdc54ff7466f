// The shapes on which every contact method is judged: about 100 mm long, most of them closed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh/open_parts.h"
#include "geometry/mesh/triangle_mesh.h"
#include "haptics/servo/snapshot.h"

namespace patina {

struct ContactScene {
  std::string name;
  std::vector<TriangleMesh> meshes;           // [m]; several are one solid by min (K14)
  std::vector<double> isos = {0, 1e-3, 2e-3}; // [m]; without 0 where parts have no thickness
  OpenSides sides = OpenSides::automatic;     // of parts with a rim
};

// All of them. The same at every call.
std::vector<ContactScene> contactScenes();
ContactScene contactScene(const std::string& name); // throws invalid_argument naming those known
std::vector<std::string> contactSceneNames();

// The boxes [x0, x1] x [y0, y1] x [z0, z1] of the cells for which `filled` holds, as one closed
// mesh; it must be a manifold.
TriangleMesh cellSolid(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& z,
                       const std::function<bool(int, int, int)>& filled);
// A polygon of the x-z plane, counter-clockwise seen from -y, drawn along y from -width / 2 to
// width / 2. All of it must be seen from its first corner.
TriangleMesh prism(const std::vector<Vec2>& polygon, double width);
// A block of cells x cells quads whose upper face is z = height(x, y); its lower one is z = floor.
TriangleMesh reliefBlock(double side, double floor, int cells,
                         const std::function<double(double, double)>& height);
TriangleMesh plateSolid(double thickness);     // 100 mm x 100 mm, across z
TriangleMesh tilted(const TriangleMesh& mesh); // by 40 degrees about (1, 2, 3)
TriangleMesh lSolid();                         // inner edge along y at x = z = 0
TriangleMesh roomSolid();                      // inner corner at 0, free where x, y, z > 0
TriangleMesh grooveSolid(double opening);      // in degrees; its bottom along y at x = z = 0
TriangleMesh roughSolid(unsigned seed);        // as a scan leaves it: noise, uneven triangles
// The same with holes of one triangle each, all too narrow for a tip of 1 mm radius.
TriangleMesh scanSolid(unsigned seed);

// Differs from scene to scene and iso to iso, so that no two of them walk the same paths.
unsigned courseSeed(const ContactScene& scene, double iso, unsigned seed);

// Stiffness of all judgements [N/m].
inline constexpr double kJudgeStiffness = 500;

// The field as the program builds it, its band wide enough for `iso`.
std::shared_ptr<const SurfaceField> contactField(const ContactScene& scene, double iso,
                                                 int resolution);
// What is felt on it: `contact` is the value of the key "contact" (empty: the program's own
// choice); the limit on the force is too high to hide a step. iso is the radius of the tip.
std::shared_ptr<const HapticSnapshot> contactSnapshot(std::shared_ptr<const SurfaceField> field,
                                                      double iso, const std::string& contact);

} // namespace patina
