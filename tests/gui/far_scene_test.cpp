// Objects far from the origin, such as geo-referenced scans, are picked, painted and touched like
// objects at the origin: by the same pointer, in the same picture.
#include <cstdio>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

constexpr double kCube = 0.05;

class FarScene : public DrivenWindow {
 protected:
  struct Done {
    Vec3 haptic_at = Vec3::Zero(), force = Vec3::Zero(); // relative to the cube's centre
    std::vector<Vec3> stroke;
    QImage before, after;
  };
  static Vec3 meanForce(const std::vector<ToolSample>& samples) {
    Vec3 sum = Vec3::Zero();
    for (const ToolSample& sample : samples) sum += sample.force;
    return sum / static_cast<double>(samples.size());
  }
  void pressAt(const QPoint& place) {
    pointAt(inView(place));
    wait(500);
    press();
    EXPECT_TRUE(waitUntil([&] { return feel().sample().contact; }, 10000));
    wait(600);
  }
  Done doneAt(const Vec3& middle_of_cube, const std::string& name) {
    Done done;
    TriangleMesh cube = box(Vec3::Constant(kCube), 8);
    for (Vec3& p : cube.positions) p += middle_of_cube;
    EXPECT_TRUE(open(saved(cube, name + ".ply")));
    trigger("view_+z");
    show(Layer::tip, false);
    wait(1000);

    type(QStringLiteral("p")); // opens its panel once, so that both views have the same size
    wait(800);
    type(QStringLiteral("q")); // press
    wait(800);
    find<ValueRow>("press_force")->findChild<QDoubleSpinBox*>()->setValue(1);
    pressAt({60, -40});
    startLog();
    wait(300);
    const std::vector<ToolSample> samples = logged();
    release();
    EXPECT_FALSE(samples.empty());
    if (samples.empty()) return done;
    done.haptic_at = samples.back().surface - middle_of_cube;
    done.force = meanForce(samples);

    type(QStringLiteral("p")); // colour
    EXPECT_TRUE(waitUntil([&] { return !edits().thread().busy(); }));
    pointAt(inView({400, 0})); // next to the cube
    wait(800);
    done.before = view().grab().toImage();
    drag(inView({-60, 20}), inView({60, 20}), 1, 30);
    EXPECT_TRUE(waitUntil([&] { return edits().status().edits.size() == 1; }, 20000));
    pointAt(inView({400, 0}));
    wait(800);
    done.after = view().grab().toImage();
    const auto folder = folder_ / (name + ".patina");
    saving().saveTo(QString::fromStdString(folder.string()));
    const OpenedWorkspace kept = openWorkspace(folder);
    EXPECT_EQ(kept.journal.size(), 1u);
    if (kept.journal.empty()) return done;
    for (const StrokeSample& sample : std::get<Stroke>(kept.journal.front()).samples)
      done.stroke.push_back(sample.position - middle_of_cube);
    return done;
  }
  // Returns the share of the pixels that differ by more than 12 of 255.
  static double apart(const QImage& a, const QImage& b) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x) {
        const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
        count += std::abs(p.red() - q.red()) > 12 || std::abs(p.green() - q.green()) > 12 ||
                 std::abs(p.blue() - q.blue()) > 12;
      }
    return static_cast<double>(count) / (a.width() * a.height());
  }
};

TEST_F(FarScene, IsPickedPaintedAndTouchedAsAtTheOrigin) {
  const Done near = doneAt(Vec3::Zero(), "near");
  const Done far = doneAt(Vec3(4.5e6, 5.2e6, 300), "far");
  std::printf("felt at %.3f mm from there, force %.4f N and %.4f N; pictures differ in %.3f %% and "
              "%.3f %% of their pixels; %zu and %zu samples of the stroke\n",
              1000 * (near.haptic_at - far.haptic_at).norm(), near.force.norm(), far.force.norm(),
              100 * apart(near.before, far.before), 100 * apart(near.after, far.after),
              near.stroke.size(), far.stroke.size());
  ASSERT_EQ(near.before.size(), far.before.size());
  EXPECT_GT(near.force.norm(), 0.7);
  EXPECT_LT((near.force - far.force).norm(), 0.01);
  EXPECT_LT((near.haptic_at - far.haptic_at).norm(), 2e-5);
  EXPECT_LT(apart(near.before, far.before), 0.002);
  EXPECT_LT(apart(near.after, far.after), 0.004);
  EXPECT_GT(apart(near.before, near.after), 0.005);
  ASSERT_FALSE(near.stroke.empty() || far.stroke.empty());
  for (const auto& [a, b] : {std::pair(near.stroke.front(), far.stroke.front()),
                             std::pair(near.stroke.back(), far.stroke.back())})
    EXPECT_LT((a - b).norm(), 2e-5);
}

} // namespace
} // namespace patina
