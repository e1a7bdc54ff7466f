#include "authoring/relief/emboss.h"

#include <array>

#include <gtest/gtest.h>

#include "authoring/relief_shapes.h"
#include "core/error.h"
#include "geometry/mesh/mesh_report.h"

namespace patina {
namespace {

using namespace test;

constexpr double kEmbossed = 0.05;

// v runs from pole to pole: an image that depends on v alone has no seam.
std::shared_ptr<const CornerUvs> zones(const TriangleMesh& mesh) {
  return uvsBy(mesh, [](const Vec3& p) { return Vec2(0.5, std::acos(p.z() / p.norm()) / M_PI); });
}

struct Errors {
  double most = 0, mean = 0;
};

// Errors of the vertices against r = R + height(v), the surface displaced along its normals.
Errors errorsOf(const TriangleMesh& mesh, const std::function<double(double)>& height) {
  Errors errors;
  for (const Vec3& p : mesh.positions) {
    const double error =
        std::abs(p.norm() - kEmbossed - height(std::acos(p.z() / p.norm()) / M_PI));
    errors.most = std::max(errors.most, error);
    errors.mean += error / static_cast<double>(mesh.positions.size());
  }
  return errors;
}

TEST(Emboss, RaisedAndEngravedSpheresAreClosedAndSecondOrder) {
  const TriangleMesh mesh = icosphere(kEmbossed, 160);
  const auto uvs = zones(mesh);
  std::array<std::shared_ptr<const SurfaceField>, 2> base;
  for (std::size_t level = 0; level < 2; ++level) {
    FieldSpec spec;
    spec.voxel = level ? 2e-3 : 4e-3;
    base[level] = fieldOf(mesh, spec);
  }
  const double amplitude = 1.5e-3;
  const auto wave = [](double v) { return 0.5 - 0.5 * std::cos(2 * M_PI * 5 * v); };
  const auto white = [](double) { return 1.0; };
  for (const auto& g : std::vector<std::function<double(double)>>{white, wave}) {
    const auto image = reliefImage(1024, [&](double, double v) { return g(v); });
    for (const double height : {amplitude, -amplitude}) {
      const std::vector<ReliefInput> sources{sourceOf(mesh, uvs, image, height)};
      std::array<Errors, 2> errors;
      for (std::size_t level = 0; level < 2; ++level) {
        Progress progress;
        const TriangleMesh surface = embossed(base[level], mesh, sources, progress);
        EXPECT_TRUE(inspect(surface).watertight);
        EXPECT_EQ(inspect(surface).components, 1U);
        EXPECT_GT(volume(surface), 0);
        errors[level] = errorsOf(surface, [&](double v) { return height * g(v); });
      }
      EXPECT_NEAR(std::log2(errors[0].mean / errors[1].mean), 2, 0.25)
          << errors[0].mean << " " << errors[1].mean;
      EXPECT_LT(errors[1].most, 0.03 * amplitude);
    }
  }
}

TEST(Emboss, ReturnsTheModelWithoutRelief) {
  const TriangleMesh mesh = icosphere(kEmbossed, 30);
  FieldSpec spec;
  spec.resolution = 60;
  Progress progress;
  const std::vector<ReliefInput> sources{sourceOf(mesh, zones(mesh), nullptr, 1e-3)};
  const TriangleMesh surface = embossed(fieldOf(mesh, spec), mesh, sources, progress);
  EXPECT_TRUE(inspect(surface).watertight);
  EXPECT_LT(errorsOf(surface, [](double) { return 0.0; }).most, 5e-5);
}

// Cutting through leaves a hole, not a crack.
TEST(Emboss, StaysClosedIfEngravingCutsThroughAThinWall) {
  const TriangleMesh mesh = box(Vec3(0.06, 0.06, 0.006), 12);
  const auto uvs =
      uvsBy(mesh, [](const Vec3& p) { return Vec2(p.x() / 0.06 + 0.5, p.y() / 0.06 + 0.5); });
  const auto disc = reliefImage(
      256, [](double u, double v) { return std::hypot(u - 0.5, v - 0.5) < 0.2 ? 1.0 : 0.0; });
  FieldSpec spec;
  spec.voxel = 1e-3;
  Progress progress;
  const std::vector<ReliefInput> sources{sourceOf(mesh, uvs, disc, -4e-3)};
  const TriangleMesh surface = embossed(fieldOf(mesh, spec), mesh, sources, progress);
  const MeshReport report = inspect(surface);
  EXPECT_TRUE(report.watertight);
  const auto edges = static_cast<long>(surface.triangles.size() * 3 / 2);
  EXPECT_EQ(static_cast<long>(report.vertices) - edges + static_cast<long>(report.triangles), 0)
      << "a ring has Euler number 0";
  EXPECT_THROW(embossed(fieldOf(mesh, spec), mesh,
                        std::vector<ReliefInput>{sourceOf(mesh, uvs, disc, -6e-3)}, progress),
               Error);
}

} // namespace
} // namespace patina
