// A path is placed on a mesh by pointer and keys, and by typed numbers.
#include <cmath>
#include <fstream>

#include <QLineEdit>

#include <vtkCamera.h>

#include "acquisition/files/scan_tables.h"
#include "app/gui/aligning/align_desk.h"
#include "app/gui/control/desk_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/places.h"

namespace patina {
namespace {

// A plate z = 0 of 100 mm; its triangles are small beside it.
TriangleMesh plate() {
  TriangleMesh mesh;
  constexpr int kCells = 10;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x)
      mesh.positions.emplace_back(0.01 * x - 0.05, 0.01 * y - 0.05, 0);
  for (int y = 0; y < kCells; ++y)
    for (int x = 0; x < kCells; ++x) {
      const int a = y * (kCells + 1) + x, b = a + kCells + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

std::vector<PathSample> circle(double radius, const Pose& pose, double x = 1, double y = 1) {
  std::vector<PathSample> path;
  for (int i = 0; i < 200; ++i) {
    const double angle = 2 * M_PI * i / 200;
    PathSample sample;
    sample.t = 0.01 * i;
    sample.position = pose * Vec3(x * radius * std::cos(angle), y * radius * std::sin(angle), 0);
    sample.sigma = 1e-5;
    path.push_back(sample);
  }
  return path;
}

TEST(Alignment, ErrorAndCostProfileMatchThoseOfAPlate) {
  Alignment alignment;
  EXPECT_FALSE(alignment.isReady());
  alignment.setMesh(std::make_shared<const TriangleMesh>(plate()));
  alignment.setPath(circle(0.02, Pose(Eigen::Translation3d(0.3, 0.1, -0.2))));
  ASSERT_TRUE(alignment.isReady());
  EXPECT_LT(alignment.centroid().norm(), 1e-9); // centre on centre
  Pose pose = alignment.pose();
  pose.translation().z() += 0.003;
  Residuals off = residualsOf(*alignment.target(), alignment.points(), pose);
  EXPECT_NEAR(off.mean, 0.003, 1e-12);
  EXPECT_NEAR(off.rms, 0.003, 1e-12);
  EXPECT_NEAR(off.worst, 0.003, 1e-12);
  Progress quiet;
  const CostProfile basin =
      costProfileAround(*alignment.target(), alignment.points(), alignment.pose(), quiet);
  const auto steps = static_cast<double>(basin.along[2].size());
  for (std::size_t i = 0; i < basin.along[2].size(); ++i) {
    const double part = 2 * static_cast<double>(i) / (steps - 1) - 1;
    EXPECT_NEAR(basin.along[0][i], 0, 1e-9); // slides along it
    EXPECT_NEAR(basin.along[5][i], 0, 1e-9); // turns on it
    EXPECT_NEAR(basin.along[2][i], std::abs(part) * basin.shift, 1e-9);
    // z = r sin(a) sin(turn) over the circle: its rms is r |sin(turn)| / sqrt(2).
    EXPECT_NEAR(basin.along[3][i], 0.02 * std::sin(std::abs(part) * basin.turn) / std::sqrt(2.),
                1e-6);
  }
  ASSERT_EQ(basin.map.size(), static_cast<std::size_t>(basin.side * basin.side));
  for (const double rms : basin.map) EXPECT_NEAR(rms, 0, 1e-9);
}

TEST(Alignment, UndoesStepByStepAndDropsUndoneStepsOnANewOne) {
  Alignment alignment;
  alignment.setMesh(std::make_shared<const TriangleMesh>(plate()));
  alignment.setPath(circle(0.02, Pose::Identity()));
  const Pose first = alignment.pose();
  const auto moveBy = [&](double x) {
    alignment.setPose(Pose(Eigen::Translation3d(x, 0, 0)) * alignment.pose());
    alignment.commit();
  };
  alignment.commit(); // nothing to commit
  EXPECT_EQ(alignment.done(), 0U);
  moveBy(0.01);
  const Pose second = alignment.pose();
  moveBy(0.01);
  EXPECT_EQ(alignment.done(), 2U);
  EXPECT_TRUE(alignment.undo());
  EXPECT_TRUE(alignment.pose().isApprox(second));
  EXPECT_TRUE(alignment.undo());
  EXPECT_TRUE(alignment.pose().isApprox(first));
  EXPECT_FALSE(alignment.undo());
  EXPECT_TRUE(alignment.redo());
  moveBy(0.02);
  EXPECT_EQ(alignment.undone(), 0U);
  EXPECT_FALSE(alignment.redo());
}

class AlignDeskTest : public DrivenWindow {
 protected:
  // An ellipsoid with a knob, so that a path over it fits at one pose only.
  static TriangleMesh body() {
    TriangleMesh mesh = icosphere(1, 24);
    for (Vec3& p : mesh.positions) {
      const double knob = 0.35 * std::exp(-8 * (p - Vec3(0.5, 0.4, 0.77)).squaredNorm());
      p = (1 + knob) * Vec3(0.04 * p.x(), 0.028 * p.y(), 0.018 * p.z());
    }
    return mesh;
  }
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    mesh_ = body();
    ASSERT_TRUE(open(saved(mesh_, "body.ply")));
    // Vertices of the upper side along a spiral; the registration is not involved.
    for (int i = 0; i < 1500; ++i) {
      const double along = i / 1500., angle = 2 * M_PI * 6 * along;
      const Vec3 wanted(0.038 * along * std::cos(angle), 0.026 * along * std::sin(angle), 0);
      const Vec3* best = nullptr;
      for (const Vec3& p : mesh_.positions)
        if (p.z() > 0.002 &&
            (best == nullptr || (p - wanted).head<2>().norm() < (*best - wanted).head<2>().norm()))
          best = &p;
      if (upper_.empty() || upper_.back() != *best) upper_.push_back(*best);
    }
    camera_from_mesh_.linear() =
        Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    camera_from_mesh_.translation() = Vec3(0.1, -0.05, 0.4);
    std::vector<PathSample> path;
    for (std::size_t i = 0; i < upper_.size(); ++i) {
      PathSample sample;
      sample.t = 0.01 * static_cast<double>(i);
      sample.position = camera_from_mesh_ * upper_[i];
      sample.sigma = 2e-5;
      path.push_back(sample);
    }
    writePath(folder_ / "path.csv", path);
    clickAction("desk_align");
    EXPECT_TRUE(find<QLabel>("align_path")->text().contains(QStringLiteral("No path")));
    answerWithPath(folder_ / "path.csv");
    clickOn("align_open");
    ASSERT_TRUE(waitUntil([&] { return desk().alignment().isReady(); }, 10000));
    wait(1500); // four views and cards need time
  }
  AlignDesk& desk() { return *window_->findChild<AlignDesk*>(); }
  const Pose& pose() { return desk().alignment().pose(); }
  AlignView& cell(const QString& name) { return *find<AlignView>(name); }
  vtkCamera& camera(const QString& name) {
    return *cell(name).picture().renderer().GetActiveCamera();
  }
  double metresPerPixel(const QString& name) {
    return 2 * camera(name).GetParallelScale() / cell(name).height();
  }
  // Returns a point of the mesh's frame on the screen.
  QPoint screen(const QString& name, const Vec3& p) {
    vtkCamera& eye = camera(name);
    const Vec3 back = (Vec3(eye.GetPosition()) - Vec3(eye.GetFocalPoint())).normalized();
    const Vec3 right = Vec3(eye.GetViewUp()).cross(back).normalized(), up = back.cross(right);
    const Vec3 from = (p - Vec3(eye.GetFocalPoint())) / metresPerPixel(name);
    return cell(name).mapToGlobal(cell(name).rect().center() +
                                  QPoint(qRound(from.dot(right)), qRound(-from.dot(up))));
  }
  double radius(const QString& name) { return cell(name).picture().handle().view()->radius; }
  // Returns the largest distance of the path's samples from their true positions.
  double farthest() {
    double most = 0;
    for (const Vec3& p : upper_)
      most = std::max(most, (pose() * (camera_from_mesh_ * p) - p).norm());
    return most;
  }
  void keepPicture(const QString& name) {
    wait(900);
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }

  TriangleMesh mesh_;
  std::vector<Vec3> upper_;
  Pose camera_from_mesh_ = Pose::Identity();
};

TEST_F(AlignDeskTest, ReadsResidualsUnderThePointerAndColoursThem) {
  const auto picked = [&] { return find<QLabel>("picked")->text(); };
  const std::vector<Vec3>& points = desk().alignment().points();
  pointAt(screen("align_top", pose() * points[points.size() / 2]));
  ASSERT_TRUE(waitUntil([&] { return picked().startsWith("Path"); }, 3000))
      << picked().toStdString();
  const Residuals off = residualsOf(*desk().alignment().target(), points, pose());
  const double shown = picked().section("residual ", 1).section(' ', 0, 0).toDouble();
  EXPECT_GT(std::abs(shown), 0);
  EXPECT_LE(std::abs(shown), 1e3 * off.worst + 1e-3);
  pointAt(cell("align_top").mapToGlobal(QPoint(3, 3)));
  EXPECT_TRUE(waitUntil([&] { return picked().isEmpty(); }, 3000));

  openTab("show");
  wait(100);
  EXPECT_EQ(find<ColorPanel>()->title(), QStringLiteral("Colours: error map"));
  constexpr std::uint32_t kDown = 0xff54;
  click(*find<QComboBox>("color_map"));
  wait(200);
  type(kDown);
  type(kEnter);
  ASSERT_TRUE(waitUntil(
      [&] { return scaleOf(edits().scene()->scene.colors, "error").map == ColorMap::viridis; },
      5000));
  keepPicture("align_viridis");
}

TEST_F(AlignDeskTest, ArrowsAndRingsMoveThePathAndUpdateTheError) {
  keepPicture("align_begin");
  for (const char* name : {"align_top", "align_bottom", "align_front", "align_back"})
    EXPECT_TRUE(cell(name).isVisible()) << name;
  const Pose before = pose();
  const Vec3 middle = desk().alignment().centroid();
  const QString error = find<QLabel>("align_error")->text();
  const QPoint held = screen("align_top", middle + 0.8 * radius("align_top") * Vec3::UnitX());
  pointAt(held);
  press();
  for (int i = 1; i <= 10; ++i) pointAt(held + QPoint(4 * i, i));
  // The pose follows while the button is down.
  EXPECT_NE(find<QLabel>("align_error")->text(), error);
  EXPECT_EQ(desk().alignment().done(), 0U);
  release();
  const Vec3 shift = pose().translation() - before.translation();
  EXPECT_TRUE(pose().linear().isApprox(before.linear(), 1e-9));
  EXPECT_NEAR(shift.x(), 40 * metresPerPixel("align_top"), 1.5 * metresPerPixel("align_top"));
  EXPECT_NEAR(shift.y(), 0, 1e-12);
  EXPECT_NEAR(shift.z(), 0, 1e-12);
  EXPECT_NEAR(find<ValueRow>("align_x")->value(), 1e3 * pose().translation().x(), 0.006);
  EXPECT_EQ(desk().alignment().done(), 1U);

  // The drag covers a sixteenth of the ring about y, which the front view shows in full.
  const Pose shifted = pose();
  const Vec3 now = desk().alignment().centroid();
  const double r = radius("align_front");
  const auto onRing = [&](double degrees) {
    const double a = degrees * M_PI / 180;
    return screen("align_front", now + r * Vec3(std::cos(a), 0, std::sin(a)));
  };
  pointAt(onRing(25));
  press();
  for (int i = 1; i <= 10; ++i) pointAt(onRing(25 + 3 * i));
  keepPicture("align");
  release();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose().linear() * shifted.linear().transpose()));
  EXPECT_NEAR(turn.angle() * 180 / M_PI, 30, 2);
  EXPECT_NEAR(std::abs(turn.axis().y()), 1, 1e-9);
  EXPECT_LT((desk().alignment().centroid() - now).norm(), 1e-9);

  type('z', kControl);
  EXPECT_TRUE(pose().isApprox(shifted, 1e-12));
  type('z', kControl);
  EXPECT_TRUE(pose().isApprox(before, 1e-12));
  type('y', kControl);
  EXPECT_TRUE(pose().isApprox(shifted, 1e-12));
}

TEST_F(AlignDeskTest, SixValuesShiftAndTurnAboutTheFixedAxes) {
  const auto typeInto = [&](const char* row, const QString& number) {
    auto* line = find<ValueRow>(row)->findChild<QLineEdit*>();
    click(*line);
    type('a', kControl);
    type(number);
    type(kEnter);
    wait(500);
  };
  typeInto("align_a", "20");
  typeInto("align_b", "-30");
  typeInto("align_c", "50");
  typeInto("align_z", "12.5");
  const auto about = [](double degrees, const Vec3& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  };
  const Eigen::Matrix3d expected =
      about(50, Vec3::UnitZ()) * about(-30, Vec3::UnitY()) * about(20, Vec3::UnitX());
  EXPECT_TRUE(pose().linear().isApprox(expected, 1e-4)) << pose().matrix();
  EXPECT_NEAR(pose().translation().z(), 0.0125, 1e-9);
  EXPECT_EQ(desk().alignment().done(), 4U);
}

TEST_F(AlignDeskTest, ThreePointsAndAFitFindThePose) {
  ASSERT_GT(farthest(), 0.005);
  clickOn("align_pick");
  ASSERT_TRUE(waitUntil([&] { return find<QLabel>("align_hint")->isVisible(); }, 3000));
  // Three distant points of the mesh, and those of the path that the camera looks at.
  const std::vector<Vec3>& looked = desk().alignment().points();
  const auto& top = QStringLiteral("align_top");
  for (const double angle : {0.3, 2.4, 4.5}) {
    const Vec3 wanted(0.02 * std::cos(angle), 0.014 * std::sin(angle), 0.015);
    Vec3 best = looked[0];
    const Pose mesh_from_camera = camera_from_mesh_.inverse();
    for (const Vec3& p : looked)
      if ((mesh_from_camera * p - wanted).norm() < (mesh_from_camera * best - wanted).norm())
        best = p;
    pointAt(screen(top, pose() * best));
    press(), release();
    wait(50);
    pointAt(screen(top, mesh_from_camera * best));
    press(), release();
    wait(50);
  }
  EXPECT_FALSE(find<QLabel>("align_hint")->isVisible());
  EXPECT_EQ(desk().alignment().done(), 1U);
  EXPECT_LT(farthest(), 0.02) << find<QLabel>("align_error")->text().toStdString();
  keepPicture("align_points");
  clickOn("align_fit");
  ASSERT_TRUE(waitUntil([&] { return !desk().work(); }, 60000));
  EXPECT_LT(farthest(), 2e-6);
  EXPECT_TRUE(find<QLabel>("align_found")->text().contains(QStringLiteral("Fitted")));
  keepPicture("align_fitted");
  // The command starts from the kept path.
  answerWithPath(folder_ / "kept.csv");
  clickOn("align_keep");
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(folder_ / "kept.txt"); }, 10000));
  const auto quoted = [&](const char* name) { return "'" + (folder_ / name).string() + "'"; };
  const std::string command = "'" + (test::programFolder() / "patina").string() +
                              "' register --unit m --no-search " + quoted("body.ply") + " " +
                              quoted("path.csv") + " -o " + quoted("again.csv") + " --initial " +
                              quoted("kept.txt") + " > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

// Returns the number of a text such as "rms 1.23 mm" [m].
double lengthAfter(const QString& words, const QString& what) {
  const QString after = words.mid(words.indexOf(what) + what.size());
  const QStringList parts = after.split(QRegularExpression("[\\s\u00a0]"));
  return parts[1].toDouble() * (parts[2].startsWith(QStringLiteral("µm")) ? 1e-6 : 1e-3);
}

TEST_F(AlignDeskTest, ShowsAFitsResidualsAsLinesAndOnTheMesh) {
  // Every sample has a known error: 0.4 mm outwards and inwards in turn.
  std::vector<PathSample> path;
  const Vec3 axes(0.04, 0.028, 0.018);
  for (std::size_t i = 0; i < upper_.size(); ++i) {
    PathSample sample;
    sample.t = 0.01 * static_cast<double>(i);
    const Vec3 out = upper_[i].cwiseQuotient(axes.cwiseProduct(axes)).normalized();
    sample.position = upper_[i] + (i % 2 == 0 ? 4e-4 : -4e-4) * out;
    sample.sigma = 4e-4;
    path.push_back(sample);
  }
  writePath(folder_ / "noisy.csv", path);
  answerWithPath(folder_ / "noisy.csv");
  clickOn("align_open");
  wait(800);
  clickOn("align_fit");
  ASSERT_TRUE(waitUntil([&] { return !desk().work() && desk().alignment().found(); }, 60000));
  const Registration& found = *desk().alignment().found();
  EXPECT_NEAR(found.rms, 4e-4, 0.6e-4);
  EXPECT_NEAR(lengthAfter(find<QLabel>("align_found")->text(), QStringLiteral("rms")), found.rms,
              1e-6);
  const auto picture = [&](const char* name) {
    wait(600);
    keepPicture(QString::fromUtf8(name));
    return cell("align_top").grabFramebuffer().convertToFormat(QImage::Format_RGB32);
  };
  const auto changed = [](const QImage& a, const QImage& b) { // share of the pixels
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x) count += a.pixel(x, y) != b.pixel(x, y);
    return static_cast<double>(count) / (a.width() * a.height());
  };
  const auto scrollTo = [&](const char* name) {
    QScrollArea* area = nullptr;
    for (QScrollArea* each : window_->findChildren<QScrollArea*>())
      if (each->isAncestorOf(find<QCheckBox>(name))) area = each;
    ASSERT_NE(area, nullptr);
    area->ensureWidgetVisible(find<QCheckBox>(name));
    wait(100);
  };
  const QImage plain = picture("align_plain");
  scrollTo("align_lines");
  clickOn("align_lines");
  // The longest fills 6 % of the mesh: 0.4 mm is drawn 1, 2, 5, 10 ... times as long.
  EXPECT_TRUE(find<QCheckBox>("align_lines")->text().contains(QStringLiteral("×")));
  const QImage lines = picture("align_lines");
  EXPECT_GT(changed(plain, lines), 0.01);
  clickOn("align_lines");
  EXPECT_LT(changed(plain, picture("align_plain_again")), 0.001);
  scrollTo("align_map");
  clickOn("align_map");
  const QImage map = picture("align_map");
  EXPECT_GT(changed(plain, map), 0.1);
  clickOn("align_map");
  scrollTo("align_next");
  clickOn("align_next");
  EXPECT_GT(changed(plain, picture("align_next")), 0.1);
  EXPECT_TRUE(find<QLabel>("align_next_words")->text().contains(QStringLiteral("the stroke")));
  clickOn("align_next");
  EXPECT_EQ(find<QLabel>("align_next_words")->text(), QString());
  clickOn("align_map");
  // A move by hand hides the old map at once; the new one is for the present pose.
  type('z', kControl);
  EXPECT_FALSE(desk().alignment().found());
  EXPECT_GT(changed(map, picture("align_map_by_hand")), 0.05);
  // Redo restores the fit's message with the pose.
  EXPECT_EQ(find<QLabel>("align_found")->text(), QString());
  desk().redo();
  EXPECT_TRUE(desk().alignment().found());
  EXPECT_TRUE(find<QLabel>("align_found")->text().contains(QStringLiteral("Fitted")));
}

TEST_F(AlignDeskTest, EscapeEndsPickingAndABadFileKeepsThePath) {
  clickOn("align_pick");
  pointAt(screen("align_top", desk().alignment().centroid()));
  type(kEscape);
  EXPECT_FALSE(find<QLabel>("align_hint")->isVisible());
  std::ofstream(folder_ / "bad.csv") << "t [s],x [m]\n0,1\n";
  const std::size_t before = desk().alignment().path().size();
  whenAsked<QDialog>([](QDialog& dialog) { dialog.reject(); });
  desk().files().openPath(folder_ / "bad.csv");
  wait(600);
  EXPECT_EQ(desk().alignment().path().size(), before);
}

} // namespace
} // namespace patina
