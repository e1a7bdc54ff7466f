// One dab of the brush, image or material, on a small mesh and on a large one (K15, K18, K22): its
// cost depends on the area of the brush, not on the mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "authoring/brush/painter.h"
#include "geometry/mesh/shapes.h"
#include "session/compile/compile_scene.h"
#include "support/least_time.h"
#include "support/one_thread.h"

namespace patina {
namespace {

constexpr double kRadius = 0.05;              // radius of the sphere [m]
constexpr double kBrush = 0.05 * 2 * kRadius; // 5 % of the object
constexpr int kDabs = 400, kRounds = 6;

struct Prepared {
  Scene scene;
  std::shared_ptr<const PaintSurface> surface;
};

Prepared prepared(int frequency) {
  Prepared result;
  SceneObject object;
  object.name = "sphere";
  object.mesh = std::make_shared<const TriangleMesh>(icosphere(kRadius, frequency));
  result.scene.objects.push_back(object);
  Progress progress;
  const auto compiled = compile(result.scene, progress);
  const auto start = std::chrono::steady_clock::now();
  const auto bare = paintSurface(result.scene, compiled->mesh, compiled->built.field, progress);
  const auto middle = std::chrono::steady_clock::now();
  result.surface = withImages(*bare, result.scene, progress);
  const auto end = std::chrono::steady_clock::now();
  const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
  std::printf("%zu triangles: neighbours %.3f s, charts and texels %.3f s, %.1f MB\n",
              object.mesh->triangles.size(), seconds(start, middle), seconds(middle, end),
              1e-6 * static_cast<double>(result.surface->bytes()));
  return result;
}

// The stroke is a spiral over the sphere, one brush width in ten dabs, with paint handed out after
// each dab, as in the editor.
std::vector<double> secondsOfDabs(const Prepared& on, const Brush& brush, PaintReport& sum) {
  Painter painter(on.surface, on.scene);
  painter.begin(brush);
  std::vector<double> seconds;
  for (int k = 0; k < kDabs; ++k) {
    const double turn = 0.2 * kBrush / kRadius * k, height = 0.9 * (2.0 * k / kDabs - 1);
    const double across = std::sqrt(1 - height * height);
    const Vec3 p = kRadius * Vec3(across * std::cos(turn), across * std::sin(turn), height);
    const double begin = test::threadSeconds();
    const PaintReport one = painter.dab({k / 60.0, p, 0});
    (void)painter.paint();
    (void)painter.takeChanges();
    seconds.push_back(test::threadSeconds() - begin);
    sum += one;
  }
  return seconds;
}

struct Row {
  const char* name;
  Tool tool;
  StrokeMode mode;
  // Limits on p99 in reference bakes, on the small mesh and on the large one: 2 to 3 times the
  // measured values.
  double value, small, large;
};

PATINA_TIMED_TEST(PaintTiming, DabCostDependsOnlyOnTheBrushOnAnyMesh) {
  const test::OneThread alone;
  test::Reference kernel;
  for (const int frequency : {7, 224}) { // 980 and 1,003,520 triangles
    const Prepared on = prepared(frequency);
    const double reference = test::minSeconds({[&] { kernel.bake(); }})[0];
    for (const Row& row : {Row{"color", Tool::color, StrokeMode::max, 0, 0.055, 0.2},
                           Row{"relief", Tool::relief, StrokeMode::build_up, 1e-3, 0.045, 0.2},
                           Row{"relief smooth", Tool::relief, StrokeMode::smooth, 1e-3, 0.35, 0.35},
                           Row{"stiffness", Tool::material(MaterialChannel::stiffness),
                               StrokeMode::max, 1000, 0.25, 0.25},
                           Row{"stiffness smooth", Tool::material(MaterialChannel::stiffness),
                               StrokeMode::smooth, 1000, 0.2, 0.2}}) {
      Brush brush;
      brush.tool = row.tool;
      brush.mode = row.mode;
      brush.value = row.value;
      brush.radius = kBrush;
      std::vector<double> least(kDabs, 1); // a stroke is the same each time
      PaintReport sum;
      for (int round = 0; round < test::longer(kRounds); ++round) {
        sum = {};
        const std::vector<double> seconds = secondsOfDabs(on, brush, sum);
        for (std::size_t k = 0; k < least.size(); ++k) least[k] = std::min(least[k], seconds[k]);
      }
      const auto each = [&](std::size_t n) { return n / std::max<std::size_t>(1, sum.dabs); };
      std::printf("  %s: a dab %zu faces, %zu texels, %zu nodes; %zu dabs\n", row.name,
                  each(sum.faces), each(sum.texels), each(sum.nodes), sum.dabs);
      EXPECT_EQ(sum.missed, 0u);
      EXPECT_GT(sum.texels + sum.nodes, 100u * kDabs);
      EXPECT_TRUE(test::within("  p99", percentiles(least).p99, reference,
                               frequency == 7 ? row.small : row.large));
    }
  }
}

} // namespace
} // namespace patina
