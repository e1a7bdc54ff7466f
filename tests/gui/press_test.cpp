// The press tool applies the set force at any stiffness of the surface.
#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>

#include "app/gui/state/contact_offset.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "scene/surface_pick.h"
#include "session/edit/editor.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

constexpr double kThick = 0.01; // [m]

class Press : public DrivenWindow {
 protected:
  static Scene plate() {
    Scene scene;
    SceneObject& object = scene.objects.emplace_back();
    object.name = "plate";
    object.mesh = std::make_shared<const TriangleMesh>(box({0.06, 0.06, kThick}, 12));
    scene.field.resolution = 100;
    return scene;
  }
  static Stroke stiff(double value, double radius) {
    Stroke stroke;
    stroke.brush.tool = Tool::material(MaterialChannel::stiffness);
    stroke.brush.value = value;
    stroke.brush.radius = radius;
    stroke.brush.falloff = 16;
    stroke.samples.push_back({0, Vec3(0, 0, 0.5 * kThick), 0.5});
    return stroke;
  }
  // Ribs along x on a base of this compliance, on all of its top.
  static Scene ribbed(Scene scene, double amplitude, double compliance) {
    FourierTexture ribs;
    ribs.name = "ribs";
    ribs.omega = 2 * M_PI / 4e-3;
    ribs.series.a = {amplitude};
    ribs.series.b = {0};
    ribs.low = minHeight(ribs);
    ribs.compliance = compliance;
    TextureMappings laid;
    laid.library[1] = hapticTexture(ribs);
    const TriangleMesh& mesh = *scene.objects[0].mesh;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      TexturedFace face{static_cast<std::int32_t>(f), 1, {}};
      bool top = true;
      for (int k = 0; k < 3; ++k) {
        const Vec3 corner = mesh.corner(f, k);
        top = top && corner.z() > 0.49 * kThick;
        face.coords[static_cast<std::size_t>(k)] = corner.head<2>();
      }
      if (top) laid.faces.push_back(face);
    }
    ObjectPaint paint;
    paint.textures = std::make_shared<const TextureMappings>(std::move(laid));
    scene.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
    return scene;
  }
  void show(const Scene& scene, const std::vector<Stroke>& strokes) {
    Progress progress;
    Editor editor(scene, progress);
    for (const Stroke& stroke : strokes) editor.apply(stroke, progress);
    editor.saveAs(folder_ / "plate.patina");
    ASSERT_TRUE(open(folder_ / "plate.patina"));
    trigger("view_+z");
    wait(1000);
    type(QStringLiteral("q"));
  }
  // Offset of a position of the drag to the right of the centre [m].
  double along(int x) {
    const double high = view().height();
    const QPoint pixel = middle() + QPoint(x, 0);
    const Ray ray =
        rayThrough(*view().view().renderer().GetActiveCamera(),
                   (pixel.x() - 0.5 * view().width()) / high, (0.5 * high - pixel.y()) / high);
    return firstSurfaceAlong(*edits().scene()->built.field, ray.origin, ray.direction).value().x();
  }
  // Returns the ticks in contact on a drag through the middle. The drag rests at `rests`.
  std::vector<ToolSample> strokeAt(double newtons, int half, int rests = INT_MAX) {
    auto* force = find<ValueRow>("press_force")->findChild<QDoubleSpinBox*>();
    force->setValue(newtons);
    pointAt(inView({-half, 0}));
    wait(500);
    press();
    EXPECT_TRUE(waitUntil([&] { return feel().sample().contact; }));
    wait(400);
    startLog();
    for (int x = -half; x <= half; x += 3) {
      pointAt(inView({x, 0}));
      if (x == rests) wait(500);
    }
    const std::vector<ToolSample> all = logged();
    release();
    EXPECT_GT(all.size(), 500U);
    EXPECT_TRUE(std::all_of(all.begin(), all.end(), [](const auto& s) { return s.contact; }));
    return all;
  }
  struct Felt {
    double mean = 0, spread = 0, most = 0;
  };
  static Felt of(const std::vector<ToolSample>& samples) {
    Felt felt;
    double square = 0;
    for (const ToolSample& sample : samples) {
      const double force = sample.force.norm();
      felt.mean += force / static_cast<double>(samples.size());
      square += force * force / static_cast<double>(samples.size());
      felt.most = std::max(felt.most, force);
    }
    felt.spread = std::sqrt(std::max(0.0, square - felt.mean * felt.mean));
    std::printf("%zu ticks: %.3f N, spread %.3f N, at most %.3f N\n", samples.size(), felt.mean,
                felt.spread, felt.most);
    return felt;
  }
};

TEST_F(Press, AppliesTheSetForceOnPaintedStiffness) {
  show(plate(), {stiff(1300, 0.2)});
  const Felt felt = of(strokeAt(0.8, 60));
  EXPECT_NEAR(felt.mean, 0.8, 0.04);
  EXPECT_LT(felt.most, 0.9);
}

TEST_F(Press, AppliesTheSetMeanForceOnScannedStiffnessAndShowsRibs) {
  show(ribbed(plate(), 0.1e-3, 1.0 / 2500), {});
  const Felt felt = of(strokeAt(1, 60));
  EXPECT_NEAR(felt.mean, 1, 0.08);
  EXPECT_NEAR(felt.spread, 0.25 / std::sqrt(2), 0.05) << "2500 N/m times 0.1 mm";
}

TEST_F(Press, KeepsTheForceWithoutJumpsOverAStiffnessIsland) {
  show(plate(), {stiff(2500, 0.008)});
  const std::vector<ToolSample> all = strokeAt(1, 140);
  const Felt felt = of(all);
  EXPECT_NEAR(felt.mean, 1, 0.1);
  EXPECT_LT(felt.most, 1.5);
  std::vector<ToolSample> middle;
  for (const ToolSample& sample : all)
    if (sample.surface.head<2>().norm() < 0.004) middle.push_back(sample);
  ASSERT_GT(middle.size(), 20U);
  EXPECT_NEAR(of(middle).mean, 1, 0.1);
}

// A long rest on hard ground makes the tip sink no faster on soft ground.
TEST_F(Press, KeepsTheForceWithoutJumpsOffAnIslandAfterARest) {
  show(plate(), {stiff(2500, 0.008)});
  int rim = 0;                         // last position on the island
  for (int x = -140; x <= 140; x += 3) // same steps as the drag
    if (along(x) < 0.0078) rim = x;
  ASSERT_GT(rim, 9);
  const Felt felt = of(strokeAt(1, 140, rim));
  EXPECT_LT(felt.most, 1.5);
}

TEST_F(Press, PenTouchStaysAtTheSurfaceAndPenPressureAddsForce) {
  show(plate(), {stiff(1300, 0.2)});
  const auto pen = [&](QEvent::Type type, double pressure) {
    QTabletEvent event(type, middle(), view().mapToGlobal(middle()), QTabletEvent::Stylus,
                       QTabletEvent::Pen, pressure, 0, 0, 0, 0, 0, Qt::NoModifier, 1,
                       Qt::LeftButton, Qt::LeftButton);
    QApplication::sendEvent(&view(), &event);
    wait(300);
  };
  pen(QEvent::TabletPress, 0);
  ASSERT_TRUE(view().target().allFinite());
  const HapticProperties& haptics = edits().scene()->scene.haptics;
  EXPECT_NEAR(view().target().z(), 0.5 * kThick + contactOffset(haptics), 1e-5);
  EXPECT_NEAR(feel().sample().force.norm(), 0, 0.02);
  pen(QEvent::TabletMove, 0.5);
  const double half = feel().sample().force.norm();
  EXPECT_GT(half, 0.1);
  pen(QEvent::TabletMove, 0);
  EXPECT_TRUE(view().target().allFinite());
  EXPECT_NEAR(feel().sample().force.norm(), 0, 0.02);
  pen(QEvent::TabletMove, 1);
  EXPECT_NEAR(feel().sample().force.norm(), 2 * half, 0.1 * half);
}

// On a steep rim the force along the surface is large; a coupling softens both directions.
TEST_F(Press, DepthMatchesTheForceBehindACoupling) {
  Scene scene = plate();
  scene.stabilisers = Stabilisers{true, false};
  Stroke rim = stiff(2500, 0.008);
  rim.brush.falloff = 2;
  Progress progress;
  Editor editor(scene, progress);
  editor.apply(rim, progress);
  const CompiledScene& compiled = *editor.compiled();
  const double skin = contactOffset(scene.haptics);
  double max_pull = 0;
  for (double x = 0.001; x < 0.008; x += 0.0005) {
    const Vec3 surface(x, 0.0002, 0.5 * kThick);
    const double depth = pressDepth(compiled, surface, 1);
    ContactMemory memory;
    Contact contact;
    for (int i = -20; i < 200; ++i) // down, then at rest
      contact = tick(*compiled.snapshot, memory,
                     surface + (skin - depth * std::min(1.0, 0.05 * i)) * Vec3::UnitZ(), 1e-3);
    ASSERT_TRUE(contact.touching);
    EXPECT_LT(contact.stiffness, 0.9 * contact.material.stiffness) << "the coupling";
    EXPECT_NEAR(contact.force.norm(), 1, 0.02) << x;
    max_pull = std::max(max_pull, contact.force.head<2>().norm());
  }
  EXPECT_GT(max_pull, 0.3);
}

} // namespace
} // namespace patina
