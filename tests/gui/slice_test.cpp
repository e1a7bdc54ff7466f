// The slice at any place, and what is read from it, by real events.
#include <cmath>

#include "app/gui/toolkit/plot.h"
#include "core/csv.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"
#include "support/painted_objects.h"
#include "visualization/values/camera.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

constexpr double kBallRadius = 0.03;

class SliceWindowTest : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(body()));
    show(Layer::tip, false);
    clickAction("desk_analyse");
    if (!find<QToolButton>("slice_handle")->isVisible()) clickRow("slice");
    wait(200);
  }
  virtual std::filesystem::path body() { return saved(icosphere(kBallRadius, 24), "ball.obj"); }
  ClipPlane plane() { return view().view().slicePlane().value(); }
  void typeOver(QWidget& field, const QString& text) {
    click(field);
    type('a', kControl);
    type(text);
    type(kEnter);
    wait(100);
  }
  QPoint screenOf(const Vec3& point) {
    double x = point.x(), y = point.y(), z = point.z();
    view().view().renderer().WorldToView(x, y, z);
    return view().mapToGlobal(
        QPoint(qRound((x + 1) / 2 * view().width()), qRound((1 - y) / 2 * view().height())));
  }
  void keepScreen(const QString& name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->screen()->grabWindow(0).save(QString::fromUtf8(folder) + '/' + name + ".png");
  }
  // Saves the table of a plot's window: one click and a name.
  CsvTable savedTable(const char* name, const std::vector<std::string>& columns) {
    auto* window = find<QWidget>(name);
    EXPECT_TRUE(window != nullptr && window->isVisible()) << name;
    if (window == nullptr) return {};
    wait(300);
    const auto path = folder_ / (std::string(name) + ".csv");
    answerWithPath(path);
    click(*window->findChild<QPushButton*>("save_table"));
    EXPECT_TRUE(waitUntil([&] { return std::filesystem::exists(path); }, 5000));
    return readCsv(path, columns);
  }
};

TEST_F(SliceWindowTest, StandsAt12MillimetresAndAHalfAtAnAngleByNumbers) {
  if (IsSkipped()) return;
  typeOver(*find<QLineEdit>("slice_direction"), QStringLiteral("0,1,1"));
  typeOver(*find<ValueRow>("slice_position")->findChild<QDoubleSpinBox*>(), QStringLiteral("12.5"));
  const Vec3 normal = Vec3(0, 1, 1).normalized();
  EXPECT_NEAR((plane().normal - normal).norm(), 0, 1e-9);
  EXPECT_NEAR(plane().origin.dot(normal), 0.0125, 1e-9);
  wait(300);
  keepScreen("slice_angle");
  EXPECT_TRUE(test::misfits(*find<DisplayPanel>()).isEmpty());
  typeOver(*find<QLineEdit>("slice_direction"), QStringLiteral("nonsense"));
  EXPECT_NEAR((plane().normal - normal).norm(), 0, 1e-9);
  EXPECT_EQ(find<QLineEdit>("slice_direction")->text(), QStringLiteral("0, 0.7071, 0.7071"));
  clickOn("slice_x");
  EXPECT_EQ(plane().normal, Vec3::UnitX());
  EXPECT_NEAR(plane().origin.x(), 0, 1e-3) << "in the middle";
}

TEST_F(SliceWindowTest, IsMovedByItsHandle) {
  if (IsSkipped()) return;
  clickOn("slice_handle");
  pointAt(inView({0, 200}));
  wait(200);
  keepScreen("slice_handle");
  const ClipPlane before = plane();
  drag(screenOf(before.origin), screenOf(before.origin + 0.01 * before.normal));
  EXPECT_NEAR(plane().origin.dot(before.normal) - before.origin.dot(before.normal), 0.01, 0.002);
  EXPECT_NEAR(find<ValueRow>("slice_position")->value(), 1000 * plane().origin.dot(before.normal),
              0.01);
  const ClipPlane shifted = plane();
  const double length = view().view().handleLength(true);
  drag(screenOf(shifted.origin + length * shifted.normal),
       screenOf(shifted.origin + length * Vec3::UnitX()));
  EXPECT_GT((plane().normal - shifted.normal).norm(), 0.3) << "tilted by the head";
}

TEST_F(SliceWindowTest, GivesTheProfileAlongALineThatIsDragged) {
  if (IsSkipped()) return;
  clickOn("line_profile");
  drag(screenOf(plane().origin + Vec3(0.022, 0, 0)),
       screenOf(plane().origin + Vec3(0.036, 0, 0.01)));
  wait(300);
  keepScreen("line_profile");
  const CsvTable table =
      savedTable("line_profile_window", {"s [m]", "x [m]", "y [m]", "z [m]", "phi [m]"});
  ASSERT_GT(table.rows.size(), 100U);
  EXPECT_NEAR(table.rows.back()[0], std::hypot(0.014, 0.01), 5e-4);
  std::size_t known = 0;
  for (const auto& row : table.rows) {
    EXPECT_NEAR(row[2], plane().origin.y(), 1e-9) << "on the slice";
    if (!std::isfinite(row[4])) continue;
    ++known;
    EXPECT_NEAR(row[4], Vec3(row[1], row[2], row[3]).norm() - kBallRadius, 1e-4);
  }
  EXPECT_GT(known, 100U);
}

TEST_F(SliceWindowTest, GivesTheHistogramOfItsDistances) {
  if (IsSkipped()) return;
  clickOn("slice_histogram");
  wait(300);
  keepScreen("histogram");
  const CsvTable table =
      savedTable("histogram_window", {"phi from [m]", "phi to [m]", "area [m^2]"});
  ASSERT_EQ(table.rows.size(), 50U);
  const Vec3 to_plane = plane().origin.y() * Vec3::UnitY();
  const double radius = std::sqrt(kBallRadius * kBallRadius - to_plane.squaredNorm());
  // Rings of equal width about the circle: area 2 pi r dr, within a few points of the raster.
  for (const auto& row : table.rows) {
    const double ring =
        M_PI * ((radius + row[1]) * (radius + row[1]) - (radius + row[0]) * (radius + row[0]));
    if (std::abs(row[0]) > 0.002) continue; // The band is complete near the surface.
    EXPECT_NEAR(row[2], ring, 0.15 * ring) << row[0];
  }
}

TEST_F(SliceWindowTest, ShowsThreeAtOnceWhichUndoTakesBackAndTheWorkspaceKeeps) {
  if (IsSkipped()) return;
  typeOver(*find<ValueRow>("slice_position")->findChild<QDoubleSpinBox*>(), QStringLiteral("5"));
  clickRow("slice2");
  typeOver(*find<ValueRow>("slice_position")->findChild<QDoubleSpinBox*>(), QStringLiteral("-7.5"));
  clickRow("slice3");
  typeOver(*find<QLineEdit>("slice_direction"), QStringLiteral("0,1,1"));
  typeOver(*find<ValueRow>("slice_position")->findChild<QDoubleSpinBox*>(), QStringLiteral("12.5"));
  const Slices wanted = {SlicePosition{Vec3::UnitY(), 0.005}, SlicePosition{Vec3::UnitX(), -0.0075},
                         SlicePosition{Vec3(0, 1, 1).normalized(), 0.0125}};
  const auto slices = [&] { return edits().scene()->scene.slices; };
  keepScreen("slices_three");
  ASSERT_TRUE(waitUntil([&] { return slices() == wanted; }, 5000))
      << format(slices()[0].value()) << ' ' << format(slices()[1].value()) << ' '
      << format(slices()[2].value());
  EXPECT_NEAR(plane().origin.dot(wanted[2]->normal), 0.0125, 1e-9) << "the selected one";
  EXPECT_EQ(find<ColorPanel>()->title(), QStringLiteral("Colours: slice"));
  wait(300);
  keepScreen("slices_three");
  EXPECT_TRUE(test::misfits(*find<DisplayPanel>()).isEmpty());
  find<ToolBar>()->choose({InteractionMode::navigate, {}}); // A click selects what it hits.
  for (std::size_t i = 0; i < kMaxSlices; ++i) {
    std::optional<QPoint> hit;
    for (int at = 0; at < 4800 && !hit; ++at) {
      const QPoint from_middle(10 * (at % 80 - 40), 10 * (at / 80 - 30));
      if (!view().rect().adjusted(90, 20, -20, -90).contains(middle() + from_middle)) continue;
      const auto front = view().frontAt(middle() + from_middle);
      if (front && front->layer == Layer::slice && front->slice == i) hit = from_middle;
    }
    ASSERT_TRUE(hit) << "slice " << i + 1 << " is in sight";
    pointAt(inView(*hit));
    press(), release();
    wait(50);
    EXPECT_NEAR(plane().origin.dot(wanted[i]->normal), *wanted[i]->position, 1e-9);
    EXPECT_NEAR(find<ValueRow>("slice_position")->value(), 1000 * *wanted[i]->position, 1e-9);
  }
  saving().saveTo(QString::fromStdString((folder_ / "cut").string()));
  EXPECT_EQ(loadWorkspace(folder_ / "cut").slices, wanted);
  wait(800); // The values become one step.
  clickRow("slice2");
  ASSERT_TRUE(waitUntil([&] { return !slices()[1]; }, 5000));
  wait(800);
  view().setFocus();
  type('z', kControl);
  ASSERT_TRUE(waitUntil([&] { return slices() == wanted; }, 5000)) << "undo brings it back";
  EXPECT_TRUE(isShown("slice2"));
}

constexpr double kRelief = 1e-3;

// The ball is raised by a baked relief of constant height.
class SliceOfReliefTest : public SliceWindowTest {
  std::filesystem::path body() override {
    Scene scene;
    scene.objects.push_back(objectOf(icosphere(kBallRadius, 24)));
    scene.field.resolution = 100;
    scene.relief = {.mode = ReliefMode::baked, .height = kRelief};
    const TriangleMesh& mesh = *scene.objects.front().mesh;
    ObjectPaint paint;
    paint.layout = textureLayout(mesh, 256);
    paint.relief = imageOf(mesh, *paint.layout.uvs, 256, 1, [](const Vec3&, float* v) { *v = 1; });
    setPaint(scene.objects.front(), paint);
    saveWorkspace(scene, folder_ / "raised");
    return folder_ / "raised";
  }
};

TEST_F(SliceOfReliefTest, ReadsOneFieldInTheStatusLineThePlotsAndThePicture) {
  if (IsSkipped()) return;
  const double raised = kBallRadius + kRelief;
  clickOn("line_profile");
  drag(screenOf(plane().origin + Vec3(0.029, 0, 0)), screenOf(plane().origin + Vec3(0.033, 0, 0)));
  wait(300);
  const CsvTable table =
      savedTable("line_profile_window", {"s [m]", "x [m]", "y [m]", "z [m]", "phi [m]"});
  std::size_t known = 0;
  for (const auto& row : table.rows) {
    if (!std::isfinite(row[4])) continue;
    ++known;
    EXPECT_NEAR(row[4], Vec3(row[1], row[2], row[3]).norm() - raised, 1e-4);
  }
  EXPECT_GT(known, 100U);
  find<QWidget>("line_profile_window")->close();
  clickOn("line_profile");

  view().setFocus();
  type('3'); // from +y, across the slice
  wait(300);
  pointAt(screenOf(plane().origin + Vec3(0.0305, 0, 0)));
  auto* picked = find<QLabel>("picked");
  ASSERT_TRUE(waitUntil([&] { return picked->text().startsWith("Slice"); }, 3000));
  const auto front = view().frontUnderPointer();
  ASSERT_TRUE(front);
  EXPECT_NEAR(picked->text().section("distance ", 1).section(' ', 0, 0).toDouble(),
              1e3 * (front->point.norm() - raised), 0.1);
  // The line at distance 0 is drawn at the same place.
  const auto darkest = [&](double radius) {
    const QImage image = view().grabFramebuffer();
    const QPoint at = view().mapFromGlobal(screenOf(plane().origin + Vec3(0, 0, radius)));
    int least = 255;
    for (int y = -2; y <= 2; ++y) least = std::min(least, qGray(image.pixel(at + QPoint(0, y))));
    return least;
  };
  EXPECT_LT(darkest(raised), 90);
  EXPECT_GT(darkest(kBallRadius), 110);
}

} // namespace
} // namespace patina
