// The guide shows the progress from a scan to a touched texture, leads to the next desk, and can be
// closed.
#include <cmath>
#include <cstdlib>

#include "acquisition/files/scan_tables.h"
#include "app/gui/aligning/align_desk.h"
#include "app/gui/control/desk_controller.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#include "core/file.h"
#include "core/json.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/pose_values.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/places.h"

namespace patina {
namespace {

class GuideStripTest : public DrivenWindow {
 protected:
  QString step(int i) { return find<QToolButton>(QStringLiteral("guide_%1").arg(i))->text(); }
  Desk desk() { return window_->controllers().desks.desk(); }
  QWidget& strip() { return *find<QWidget>("guide_strip"); }
  void keepPicture(const QString& name) {
    wait(600);
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }
};

TEST(GuideSteps, ShowOneFigureEachWhenDone) {
  for (const GuideStep& open : guideSteps({})) {
    EXPECT_FALSE(open.done);
    EXPECT_TRUE(open.figure.isEmpty());
  }
  const auto steps = guideSteps({244, 244, 1203, 70e-6, 617, 0.8});
  const QString figures[] = {QStringLiteral("244 frames"), QStringLiteral("1,203 samples"),
                             QStringLiteral("0.07\u00a0mm off"), QStringLiteral("617 faces"),
                             QStringLiteral("0.80 N")};
  ASSERT_EQ(steps.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(steps[i].done);
    EXPECT_EQ(steps[i].figure, figures[i]) << steps[i].figure.toStdString();
  }
  // A fit with an equally good alternative does not count as done.
  const QString why = QStringLiteral("Not unique: another place fits as well");
  const GuideStep doubtful = guideSteps({0, 0, 1203, 70e-6, 0, 0, why})[2];
  EXPECT_FALSE(doubtful.done);
  EXPECT_EQ(doubtful.tip, why);
  EXPECT_EQ(doubtful.figure, QStringLiteral("0.07\u00a0mm off, uncertain"));
  // A force on a surface without a texture does not complete the guide.
  EXPECT_FALSE(guideSteps({0, 0, 0, {}, 0, 0.8})[4].done);
}

TEST_F(GuideStripTest, LeadsByClicksAndClosesAndOpensAgain) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  EXPECT_FALSE(strip().isVisible()); // Feel is no desk of the guide
  clickAction("desk_scan");
  EXPECT_TRUE(strip().isVisible());
  EXPECT_TRUE(step(0).startsWith(QStringLiteral("○")));
  clickOn("guide_2");
  EXPECT_EQ(desk(), Desk::align);
  clickOn("guide_3");
  EXPECT_EQ(desk(), Desk::texture);
  clickOn("guide_close");
  EXPECT_FALSE(strip().isVisible());
  clickAction("desk_scan");
  EXPECT_FALSE(strip().isVisible());
  EXPECT_FALSE(GuideStrip().isOpen()); // at the next start, too
  trigger("guide");
  EXPECT_TRUE(strip().isVisible());
  EXPECT_TRUE(GuideStrip().isOpen());
}

// A user's own scan, from its folder to a texture on the mesh.
TEST_F(GuideStripTest, LeadsAUsersScanToATexture) {
  TriangleMesh body = icosphere(1, 24);
  for (Vec3& p : body.positions) {
    const double knob = 0.35 * std::exp(-8 * (p - Vec3(0.5, 0.4, 0.77)).squaredNorm());
    // The surface has lumps all over: without them a part would fit at several poses and be
    // reported as ambiguous.
    const double lumps =
        0.12 * std::sin(6 * p.x() + 1) * std::cos(5 * p.y() - 0.4) * std::cos(4 * p.z() + 0.7);
    p = 1000 * (1 + knob + lumps) * Vec3(0.06 * p.x(), 0.042 * p.y(), 0.027 * p.z()); // mm
  }
  const auto mesh = saved(body, "body.obj");
  const auto scan = folder_ / "scan";
  const std::string command = "'" + (test::programFolder() / "patina").string() +
                              "' simulate-scan '" + mesh.string() + "' --seconds 16 -o '" +
                              scan.string() + "' > /dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  ASSERT_TRUE(open(mesh, MeshUnit::mm));
  documents().open(requestFor(scan));
  auto& align = *window_->findChild<AlignDesk*>();
  ASSERT_TRUE(waitUntil([&] { return align.alignment().isReady(); }, 60000));
  wait(500);
  EXPECT_EQ(desk(), Desk::scan);
  EXPECT_TRUE(step(0).startsWith(QStringLiteral("✓"))) << step(0).toStdString();
  EXPECT_TRUE(step(1).startsWith(QStringLiteral("✓"))) << step(1).toStdString();
  EXPECT_TRUE(step(2).startsWith(QStringLiteral("○"))) << step(2).toStdString();
  clickOn("guide_2");
  clickOn("align_begin");
  wait(500);
  EXPECT_TRUE(step(2).startsWith(QStringLiteral("○"))) << step(2).toStdString();
  // Six values bring the path near its pose; the fit does the rest.
  const Pose belongs = readPoseAt(scan / "truth.json", "mesh_from_camera");
  const PoseValues values = valuesOf(belongs);
  constexpr const char* kRows[] = {"align_x", "align_y", "align_z",
                                   "align_a", "align_b", "align_c"};
  for (int i = 0; i < 6; ++i)
    setRow(QString::fromUtf8(kRows[i]),
           i < 3 ? values.position_mm[i] + 2 : values.angles_deg[i - 3] + 2);
  wait(600);
  clickOn("align_fit");
  ASSERT_TRUE(waitUntil([&] { return !align.work(); }, 60000));
  const Vec3 middle = align.alignment().centroid();
  EXPECT_LT((belongs * align.alignment().pose().inverse() * middle - middle).norm(), 1.5e-3);
  EXPECT_TRUE(step(2).startsWith(QStringLiteral("✓")))
      << step(2).toStdString() << ": " << find<QLabel>("align_found")->text().toStdString();
  wait(200); // the strip resizes to the new words
  clickOn("guide_3");
  ASSERT_EQ(desk(), Desk::texture);
  clickOn("tab_library");
  clickOn("texture_scan");
  const auto& library = window_->findChild<TextureDesk*>()->library();
  ASSERT_TRUE(waitUntil([&] { return !library.work(); }, 120000));
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 20000))
      << find<QLabel>("texture_hint")->text().toStdString();
  keepPicture("guide");
  EXPECT_TRUE(step(3).startsWith(QStringLiteral("✓"))) << step(3).toStdString();
  EXPECT_TRUE(find<QListWidget>("textures")->item(0)->text().contains(QStringLiteral("scan, on")));
}

} // namespace
} // namespace patina
