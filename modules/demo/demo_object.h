// What the demonstration scans: a toy with three materials on it, all of whose heights are known.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "acquisition/simulation/simulated_hand.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Heights are over the plane that faces the camera: x along the toy, y up.
struct DemoMaterial {
  std::string name;
  std::function<double(const Vec2&)> height;   // above the mesh, along the view [m]
  double stiffness = 0;                        // [N/m]
  Vec2 from = Vec2::Zero(), to = Vec2::Zero(); // of the stroke that scans it [m]
  double wavelength = 0, amplitude = 0;        // of its strongest wave along the stroke [m]
  Vec3 color = Vec3::Ones();                   // sRGB, that it is painted with
};

struct DemoObject {
  std::string name;
  TriangleMesh mesh;                         // object frame [m]
  Pose plane_from_object = Pose::Identity(); // the scanned side looks up
  std::vector<DemoMaterial> materials;
  // The true toy without materials, over the plane: smooth between the corners of its mesh. Both
  // throw Error beside it.
  std::function<double(const Vec2&)> ground; // height [m]
  std::function<Vec3(const Vec2&)> normal;   // outwards, unit
  std::function<Vec3(double)> grip;          // a way over a place without material, from 0 to 1 [m]
  std::vector<Vec2> survey;                  // where a hand goes over the bare mesh [m]
};

// Where over the plane its materials are stroked, and what else is gone over [m].
struct DemoWay {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};
struct DemoWays {
  DemoWay ribs, weave, grain, grip;
  std::vector<Vec2> survey;
};

DemoObject demoObject(); // the dinosaur, twice as large
// The three materials on any body [m]. Throws Error where a way leaves it, invalid_argument without
// a survey.
DemoObject demoObjectOf(const std::string& name, TriangleMesh mesh, const Pose& plane_from_object,
                        const DemoWays& ways);

// A hand that presses the material where its stroke begins, eight times, and strokes it once.
SimulatedHand handOver(const DemoObject& object, const DemoMaterial& material, std::uint32_t seed);
// A hand that goes from limb to limb over the bare mesh, so that registration sees it from all
// sides.
SimulatedHand surveyOf(const DemoObject& object, std::uint32_t seed);

} // namespace patina
