#include "demo/demo_object.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "core/decompose.h"
#include "core/error.h"
#include "field/surface/models.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kSpeed = 0.06; // of a stroke, on the mean [m/s]

Vec2 along(const DemoMaterial& material) {
  return (material.to - material.from).normalized();
}

// Rounded ridges across the stroke.
DemoMaterial ribs(const DemoWay& way) {
  DemoMaterial ribs{"ribs", {}, 3000, way.from, way.to, 5e-3, 120e-6, {0.83, 0.42, 0.27}};
  ribs.height = [middle = ribs.from, heading = along(ribs)](const Vec2& place) {
    const double x = kTwoPi * heading.dot(place - middle) / 5e-3;
    return 120e-6 * std::cos(x) + 40e-6 * std::cos(2 * x + 1);
  };
  return ribs;
}

// Threads along and across.
DemoMaterial weave(const DemoWay& way) {
  DemoMaterial weave{"weave", {}, 2000, way.from, way.to, 3e-3, 80e-6, {0.36, 0.56, 0.71}};
  weave.height = [middle = weave.from, heading = along(weave)](const Vec2& place) {
    const Vec2 at = place - middle;
    const double x = heading.dot(at), y = heading.x() * at.y() - heading.y() * at.x();
    return 80e-6 * std::cos(kTwoPi * x / 3e-3) + 30e-6 * std::cos(kTwoPi * y / 3e-3) +
           30e-6 * std::cos(kTwoPi * x / 2e-3 + 2);
  };
  return weave;
}

// Waves of many lengths, more or less across the stroke.
DemoMaterial grain(const DemoWay& way) {
  DemoMaterial grain{"grain", {}, 2500, way.from, way.to, 4e-3, 80e-6, {0.55, 0.62, 0.34}};
  grain.height = [middle = grain.from, heading = along(grain)](const Vec2& place) {
    struct Wave {
      double length, turned, height, phase;
    };
    constexpr Wave kWaves[] = {{4e-3, 0, 80e-6, 0},       {3.1e-3, 0.3, 45e-6, 1},
                               {2.3e-3, -0.25, 32e-6, 4}, {5.7e-3, 0.15, 30e-6, 2.5},
                               {1.7e-3, 0.1, 20e-6, 5},   {2.7e-3, -0.4, 25e-6, 3}};
    const Vec2 at = place - middle;
    double height = 0;
    for (const Wave& wave : kWaves) {
      const Vec2 across = Eigen::Rotation2Dd(wave.turned) * heading;
      height += wave.height * std::cos(kTwoPi * across.dot(at) / wave.length + wave.phase);
    }
    return height;
  };
  return grain;
}

// A toy is smooth between the corners of its mesh: heights of the mesh on a grid, through a cubic
// B-spline, which moves them by some micrometres.
class SmoothHeights {
 public:
  explicit SmoothHeights(const TriangleMesh& mesh) : box_(bounds(mesh)) {
    const TriangleTree tree(mesh);
    const double top = box_.max().z() + 1e-3, deep = box_.sizes().z() + 2e-3;
    for (int k = 0; k < 2; ++k) size_[k] = static_cast<int>(box_.sizes()[k] / kGrid) + 4;
    for (int j = 0; j < size_[1]; ++j)
      for (int i = 0; i < size_[0]; ++i) {
        const Vec2 place = box_.min().head<2>() + kGrid * Vec2(i - 1, j - 1);
        const auto hit = tree.firstHit({place.x(), place.y(), top}, -Vec3::UnitZ(), deep);
        heights_.push_back(hit ? top - hit->t : std::numeric_limits<double>::quiet_NaN());
      }
  }

  double at(const Vec2& place) const {
    const Vec2 cell = (place - box_.min().head<2>()) / kGrid + Vec2::Ones();
    const int i = static_cast<int>(cell.x()), j = static_cast<int>(cell.y());
    if (!(cell.minCoeff() >= 1 && i + 2 < size_[0] && j + 2 < size_[1]))
      throw Error("a stroke leaves the surface");
    const std::array<double, 4> x = weights(cell.x() - i), y = weights(cell.y() - j);
    double height = 0;
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a < 4; ++a)
        height += x[index(a)] * y[index(b)] * heights_[index((j + b - 1) * size_[0] + i + a - 1)];
    if (!std::isfinite(height)) throw Error("a stroke leaves the surface");
    return height;
  }

 private:
  static constexpr double kGrid = 0.75e-3; // [m]

  static std::array<double, 4> weights(double u) {
    const double v = 1 - u;
    return {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
            u * u * u / 6};
  }

  Box3 box_;
  int size_[2] = {};
  std::vector<double> heights_;
};

constexpr double kLook = 0.5e-3; // the faces' edges [m]

std::function<Vec3(const Vec2&)> normalOf(const std::function<double(const Vec2&)>& ground) {
  return [ground](const Vec2& place) -> Vec3 {
    const auto slope = [&](const Vec2& aside) {
      return (ground(place + aside) - ground(place - aside)) / (2 * kLook);
    };
    return Vec3(-slope({kLook, 0}), -slope({0, kLook}), 1).normalized();
  };
}

void press(SimulatedHand& hand, const Vec2& place) {
  for (int i = 0; i < 8; ++i) {
    hand.moves.push_back({place, 0.7, 0, 5.0, 0});
    hand.moves.push_back({place, 0.3, 0, 0.6, 0});
  }
}

} // namespace

DemoObject demoObject() {
  TriangleMesh mesh = dinosaur();
  for (Vec3& p : mesh.positions) p *= 2;
  const Pose side(turnFromTo(-Vec3::UnitY(), Vec3::UnitZ()));
  DemoWays ways; // [m]
  ways.ribs = {{-0.078, -0.037}, {-0.030, -0.022}};
  ways.weave = {{0.036, -0.049}, {0.039, 0.002}};
  ways.grain = {{0.051, 0.011}, {0.075, 0.047}};
  ways.grip = {{-0.006, -0.010}, {0.020, -0.006}};
  ways.survey = {{-0.005, -0.046}, {-0.004, -0.008}, {0.008, 0.003},  {0.012, -0.015},
                 {0.032, -0.006},  {0.038, -0.040},  {0.040, -0.006}, {0.050, 0.010},
                 {0.064, 0.038},   {0.086, 0.043},   {0.070, 0.047}};
  return demoObjectOf("dinosaur", std::move(mesh), side, ways);
}

DemoObject demoObjectOf(const std::string& name, TriangleMesh mesh, const Pose& plane_from_object,
                        const DemoWays& ways) {
  if (ways.survey.empty()) throw std::invalid_argument("demoObjectOf: no survey");
  DemoObject object;
  object.name = name;
  object.mesh = std::move(mesh);
  object.plane_from_object = plane_from_object;
  object.materials = {ribs(ways.ribs), weave(ways.weave), grain(ways.grain)};
  object.survey = ways.survey;
  const TriangleMesh turned =
      transformed(object.mesh, Eigen::Affine3d(object.plane_from_object.matrix()));
  object.ground = [heights = std::make_shared<const SmoothHeights>(turned)](const Vec2& place) {
    return heights->at(place);
  };
  for (const auto& way : {ways.ribs, ways.weave, ways.grain, ways.grip})
    for (const Vec2& end : {way.from, way.to}) object.ground(end);
  for (const Vec2& place : ways.survey) object.ground(place);
  object.normal = normalOf(object.ground);
  object.grip = [ground = object.ground, way = ways.grip](double part) {
    const Vec2 place = (1 - part) * way.from + part * way.to;
    return Vec3(place.x(), place.y(), ground(place));
  };
  return object;
}

SimulatedHand handOver(const DemoObject& object, const DemoMaterial& material, std::uint32_t seed) {
  SimulatedHand hand;
  hand.seed = seed;
  hand.from = material.from;
  const auto& ground = object.ground;
  hand.relief = [ground, height = material.height](const Vec2& place) {
    return ground(place) + height(place);
  };
  hand.normal = object.normal;
  hand.air = ground(material.from) + 10e-3;
  hand.compliance = 1 / material.stiffness;
  const Vec2 &from = material.from, &to = material.to;
  hand.moves.push_back({from, 0.5, 0, 0, 0});
  press(hand, from);
  hand.moves.push_back({from, 0.3, 0, 1.0, 0});
  hand.moves.push_back({to, (to - from).norm() / kSpeed, 0, 1.0, 0});
  hand.moves.push_back({to, 0.2, 0, 0, 0});
  hand.moves.push_back({to, 0.4, 0, 0, 1});
  return hand;
}

SimulatedHand surveyOf(const DemoObject& object, std::uint32_t seed) {
  SimulatedHand hand;
  hand.seed = seed;
  hand.relief = object.ground;
  hand.normal = object.normal;
  hand.from = object.survey.at(0);
  hand.air = hand.relief(hand.from) + 10e-3;
  hand.compliance = 1. / 5000;
  hand.moves.push_back({hand.from, 0.5, 0, 0, 0});
  Vec2 place = hand.from;
  for (const Vec2& to : object.survey) {
    hand.moves.push_back({to, 0.2 + (to - place).norm() / kSpeed, 0, 1.0, 0});
    place = to;
  }
  press(hand, place);
  hand.moves.push_back({place, 0.2, 0, 0, 0});
  hand.moves.push_back({place, 0.4, 0, 0, 1});
  return hand;
}

} // namespace patina
