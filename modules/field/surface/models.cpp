#include "field/surface/models.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "field/store/field_grid.h"
#include "field/store/surface_field.h"
#include "field/surface/iso_surface.h"

namespace patina {
namespace {

constexpr double kMillimetre = 1e-3; // unit of the drawing below
constexpr double kLength = 0.1;      // length of the model [m]

// Two balls and the cone tangent to both; in millimetres, x forward, z up.
struct Limb {
  Vec3 a;
  double radius_a;
  Vec3 b;
  double radius_b;
  double blend;  // width of the smooth joint to the previous limbs [mm]
  bool mirrored; // second copy at -y
};

double distanceTo(const Limb& limb, const Vec3& p) {
  const Vec3 axis = limb.b - limb.a;
  const double length = axis.norm(), shrink = limb.radius_a - limb.radius_b;
  const Vec3 along = axis / length;
  const double x = along.dot(p - limb.a);
  const double y = (p - limb.a - x * along).norm();
  // The cone's side leans by this slope, along which the foot point of p shifts.
  const double slope = shrink / std::sqrt(length * length - shrink * shrink);
  const double foot = x - y * slope;
  if (foot <= 0) return (p - limb.a).norm() - limb.radius_a;
  if (foot >= length) return (p - limb.b).norm() - limb.radius_b;
  const double sine = shrink / length;
  return y * std::sqrt(1 - sine * sine) + x * sine - limb.radius_a;
}

// Minimum with a rounded joint. Its derivatives are positive and add up to one, so that it stays
// 1-Lipschitz.
double smoothMin(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4 * width);
}

const std::initializer_list<Limb> kDinosaur = {
    // body, tail
    {{-13, 0, 30}, 14.5, {11, 0, 32}, 13, 1, false},
    {{-20, 0, 29}, 11, {-38, 0, 21}, 6.4, 8, false},
    {{-38, 0, 21}, 6.4, {-54, 0, 14.5}, 3.7, 0.8, false},
    {{-54, 0, 14.5}, 3.7, {-66, 0, 13}, 2.3, 0.6, false},
    {{-66, 0, 13}, 2.3, {-72, 0, 14.5}, 1.7, 0.5, false},
    {{-72, 0, 14.5}, 1.7, {-77, 0, 18.5}, 1.2, 0.4, false},
    // neck, head, snout, jaw
    {{17, 0, 38}, 9, {27, 0, 49}, 6.6, 9, false},
    {{27, 0, 49}, 6.6, {32, 0, 58}, 5.4, 1.2, false},
    {{32, 0, 58}, 5.4, {35, 0, 65}, 5.2, 1, false},
    {{35.5, 0, 67.5}, 6.8, {40, 0, 68}, 6, 3, false},
    {{41, 0, 66.6}, 5, {50, 0, 65}, 4.4, 3, false},
    {{39, 0, 63.6}, 3.8, {48.5, 0, 61.8}, 3, 1.2, false},
    // eyes, nostrils
    {{40.6, 4.7, 70.6}, 2.5, {41, 4.9, 70.7}, 2.4, 0.7, true},
    {{52.2, 2, 68}, 0.9, {52.8, 2.1, 67.9}, 0.9, 1.2, true},
    // legs, feet, toes
    {{11, 8.5, 24}, 6.8, {12.5, 10, 6}, 4.8, 5, true},
    {{12.5, 10, 4.6}, 4.6, {15, 10.2, 4.2}, 4.2, 2, true},
    {{18.2, 7.6, 2.2}, 2, {18.8, 7.6, 2.2}, 1.8, 0.8, true},
    {{19, 10.4, 2.2}, 2, {19.6, 10.5, 2.2}, 1.8, 0.8, true},
    {{17.8, 13.2, 2.2}, 2, {18.3, 13.4, 2.2}, 1.8, 0.8, true},
    {{-15, 9, 24}, 8.6, {-15, 11, 6}, 5.4, 5, true},
    {{-15, 11, 5}, 5, {-12, 11.2, 4.6}, 4.6, 2, true},
    {{-8.5, 8.3, 2.3}, 2.1, {-8, 8.2, 2.3}, 1.9, 0.8, true},
    {{-7.6, 11.4, 2.3}, 2.1, {-7.1, 11.5, 2.3}, 1.9, 0.8, true},
    {{-8.8, 14.4, 2.3}, 2.1, {-8.3, 14.6, 2.3}, 1.9, 0.8, true},
    // crest: a row of blunt spikes from the neck to the tail
    {{30, 0, 65}, 1.8, {27, 0, 69}, 0.9, 1.5, false},
    {{25.5, 0, 57}, 2, {22.5, 0, 61.5}, 0.9, 1.5, false},
    {{19, 0, 49}, 2.4, {16, 0, 55}, 1, 1.5, false},
    {{10, 0, 44}, 3, {7.5, 0, 52}, 1.1, 1.5, false},
    {{0, 0, 44}, 3.4, {-2, 0, 53.5}, 1.2, 1.5, false},
    {{-11, 0, 43.5}, 3.4, {-13.8, 0, 52.8}, 1.2, 1.5, false},
    {{-22, 0, 39}, 2.9, {-25.5, 0, 46.5}, 1.1, 1.5, false},
    {{-32, 0, 30}, 2.4, {-36, 0, 36.5}, 1, 1.5, false},
    {{-42, 0, 24}, 2, {-46, 0, 29}, 0.9, 1.5, false},
    {{-51.5, 0, 18.5}, 1.7, {-55, 0, 22.5}, 0.8, 1.5, false},
    {{-60, 0, 15}, 1.4, {-63, 0, 18}, 0.7, 1.2, false},
};

double dinosaurAt(const Vec3& p) {
  const Vec3 folded(p.x(), std::abs(p.y()), p.z());
  double distance = std::numeric_limits<double>::infinity();
  for (const Limb& limb : kDinosaur) {
    const double d = distanceTo(limb, folded);
    distance = std::isinf(distance) ? d : smoothMin(distance, d, limb.blend);
  }
  return distance;
}

} // namespace

TriangleMesh dinosaur(int resolution) {
  // Only cells that the surface crosses are needed.
  const double band = 2;
  const Box3 drawn(Vec3(-80, -20, -2), Vec3(56, 20, 76));
  const FieldGrid grid =
      gridAround(Box3(drawn.min() * kMillimetre, drawn.max() * kMillimetre),
                 FieldSpec{.resolution = resolution, .voxel = std::nullopt, .band = band});
  const SurfaceField field = sampleFunction(
      [](const Vec3& p) { return dinosaurAt(p / kMillimetre) * kMillimetre; }, grid, band);
  TriangleMesh mesh = isoSurface(field, 0);

  const Box3 box = bounds(mesh);
  const double scale = kLength / box.sizes().maxCoeff();
  for (Vec3& p : mesh.positions) p = (p - box.center()) * scale;
  return mesh;
}

} // namespace patina
