// The desk for scans, driven like by a user.
#include "acquisition/tracking/lens.h"
#include "gui/scan_fixture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

TEST_F(ScanDeskTest, OpensAScanFromTheFileMenuAndShowsItsPath) {
  EXPECT_EQ(find<ScanView>("scan_view"), nullptr); // an absent scan costs nothing
  clickAction("desk_scan");
  whenAsked<QFileDialog>([this](QFileDialog&) {
    type(QString::fromStdString(scan_.string()));
    type(kEnter);
  });
  clickOn("open_first_scan");
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }));
  wait(300);
  keepPicture("scan_opened");
  EXPECT_TRUE(find<ScanView>("scan_view")->isVisible());
  EXPECT_FALSE(view().isVisible());
  EXPECT_GT(scan().path()->path.size(), 300U);
  EXPECT_TRUE(window_->windowTitle().contains(QStringLiteral("a scan of a sphere")));
  // The tube is in the picture: its dark pixels have a colour of their own.
  const QImage picture = find<ScanView>("scan_view")->grabFramebuffer();
  int tube = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = picture.width() / 5; x < 4 * picture.width() / 5; ++x) {
      const QColor color = picture.pixelColor(x, y);
      tube += color.blue() > color.red() + 40 && color.blue() > 60;
    }
  EXPECT_GT(tube, 200);
}

TEST_F(ScanDeskTest, EveryFaultShowsItsCauseWhereverItIsClicked) {
  ASSERT_TRUE(openScan());
  // Clicks in the strip.
  auto* strip = find<FrameStrip>("strip");
  scan().cursor().set(0.3);
  wait(100);
  clickIn(*strip->viewport(), strip->placeOf(kUnreadable).center());
  EXPECT_EQ(scan().cursor().frame(), kUnreadable);
  EXPECT_TRUE(why().contains(QStringLiteral("frame 12"))) << why().toStdString();
  EXPECT_TRUE(why().contains(QStringLiteral("000012.png"))) << why().toStdString();
  EXPECT_EQ(scan().qualityOf(kUnreadable), FrameQuality::unreadable);
  keepPicture("scan_unreadable");
  // Clicks in the traces.
  EXPECT_EQ(scan().qualityOf(kWrong), FrameQuality::rejected);
  const Finding* wrong = findingOf(Finding::Kind::outlier);
  ASSERT_NE(wrong, nullptr);
  auto* traces = find<ScanTraces>("traces");
  clickIn(*traces, traces->placeOf(wrong->from));
  EXPECT_EQ(scan().cursor().frame(), kWrong);
  EXPECT_TRUE(why().contains(QStringLiteral("rejected"))) << why().toStdString();
  EXPECT_TRUE(why().contains(QStringLiteral("sigma"))) << why().toStdString();
  EXPECT_TRUE(why().contains(QStringLiteral("\u00A0mm and "))) << why().toStdString();
  keepPicture("scan_rejected");
  // Clicks in the list.
  clickOn("page_findings");
  wait(100);
  const Finding* gap = findingOf(Finding::Kind::gap);
  ASSERT_NE(gap, nullptr);
  auto* list = find<FindingList>("findings");
  const int row = static_cast<int>(gap - scan().path()->findings.data());
  clickIn(*list->viewport(), list->visualItemRect(list->item(row)).center());
  EXPECT_GT(scan().cursor().time(), gap->from);
  EXPECT_LT(scan().cursor().time(), gap->to);
  keepPicture("scan_findings");
  EXPECT_TRUE(list->item(row)->text().contains(QStringLiteral("sigma grows")));
  EXPECT_TRUE(why().contains(QStringLiteral("no marker"))) << why().toStdString();
}

TEST_F(ScanDeskTest, KeysStepFramesWithOneCursorInAllViews) {
  ASSERT_TRUE(openScan());
  auto* strip = find<FrameStrip>("strip");
  clickIn(*strip->viewport(), strip->placeOf(3).center());
  constexpr std::uint32_t kLeft = 0xff51, kRight = 0xff53, kEnd = 0xff57;
  type(kRight), type(kRight), type(kLeft);
  wait(200);
  EXPECT_EQ(scan().cursor().frame(), 4U);
  EXPECT_TRUE(find<QLabel>("frame_title")->text().startsWith(QStringLiteral("Frame 4 of")));
  const auto* traces = find<ScanTraces>("traces");
  const QImage drawn = find<ScanTraces>("traces")->grab().toImage();
  const QPoint at = traces->placeOf(scan().cursor().time());
  EXPECT_GT(drawn.pixelColor(at.x(), traces->height() / 2).blue(),
            drawn.pixelColor(at.x(), traces->height() / 2).red() + 40);
  type(kEnd);
  EXPECT_EQ(scan().cursor().frame(), scan().files()->frames.size() - 1);
  EXPECT_LT(strip->held(), 3U * 20U);
}

// Pixel of the canvas nearest to a place that has the outlines' colour.
double awayFromOutline(const QImage& drawn, const QPointF& place) {
  double nearest = 1e9;
  for (int y = -8; y <= 8; ++y)
    for (int x = -8; x <= 8; ++x) {
      const QPoint at = place.toPoint() + QPoint(x, y);
      if (!drawn.valid(at)) continue;
      const QColor color = drawn.pixelColor(at);
      if (color.red() > 120 || color.green() < 190 || color.blue() < 215) continue;
      const QPointF way = QPointF(at) + QPointF(0.5, 0.5) - place;
      nearest = std::min(nearest, std::hypot(way.x(), way.y()));
    }
  return nearest;
}

TEST_F(ScanDeskTest, OutlinesLieOnTheRig) {
  ASSERT_TRUE(openScan());
  scan().cursor().set(scan().files()->frames[40].t);
  wait(300);
  auto* canvas = find<PictureView>("frame");
  const QImage drawn = canvas->grab().toImage();
  keepPicture("scan_outlines");
  // The reference is the tip's true pose at that time, from the simulation.
  const std::vector<PathSample> truth = readPath(scan_ / "truth.csv");
  const double t = scan().files()->frames[40].t;
  const auto at =
      std::min_element(truth.begin(), truth.end(), [t](const PathSample& a, const PathSample& b) {
        return std::abs(a.t - t) < std::abs(b.t - t);
      });
  Pose pose = Pose::Identity();
  pose.linear() = at->orientation.toRotationMatrix();
  pose.translation() = at->position - at->orientation * scan().files()->tip();
  const SeenFrame& seen = scan().seen()[40];
  ASSERT_GT(seen.markers, 0U);
  int corners = 0;
  double worst = 0;
  for (const RigMarker& marker : scan().files()->markers) {
    const Vec3 middle = pose * marker.probe_from_marker.translation();
    const Vec3 normal = (pose * marker.probe_from_marker).linear().col(2);
    if (normal.dot(-middle.normalized()) < 0.35) continue; // oblique or from behind
    for (const Vec3& corner : marker.corners()) {
      ++corners;
      const Vec2 pixel = pixelOf(*scan().files()->camera, pose * corner);
      const QPointF place = canvas->placeOf({pixel.x(), pixel.y()});
      worst = std::max(worst, awayFromOutline(drawn, place));
    }
  }
  EXPECT_GE(corners, 4);
  EXPECT_LT(worst, 1.8) << "pixels of the window";
  RecordProperty("worst_px", std::to_string(worst));
}

TEST_F(ScanDeskTest, KeepsPosesAndPathForTheNextTime) {
  ASSERT_TRUE(openScan());
  const std::size_t samples = scan().path()->path.size(), poses = scan().path()->poses.size();
  clickOn("keep_path");
  ASSERT_TRUE(waitUntil([&] { return fs::exists(scan_ / "path.csv"); }, 10000));
  EXPECT_EQ(readPath(scan_ / "path.csv").size(), samples);
  EXPECT_EQ(readPoses(scan_ / "poses.tum").values.size(), poses);
  ASSERT_TRUE(waitUntil([&] { return !desk().work(); }));
  clickOn("close_scan");
  EXPECT_EQ(scan().files(), nullptr);
  documents().open(requestFor(scan_));
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr; }));
  EXPECT_EQ(scan().path()->path.size(), samples);
  EXPECT_FALSE(scan().seen().back().looked); // the path is there before the frames are analysed
}

TEST_F(ScanDeskTest, KeepsTheOpenScanIfAFolderIsUnreadable) {
  ASSERT_TRUE(openScan());
  const fs::path broken = folder_ / "broken";
  fs::create_directories(broken);
  std::ofstream(broken / "poses.tum") << "0 1 2\n";
  bool asked = false;
  whenAsked<QDialog>([&](QDialog& dialog) {
    asked = true;
    EXPECT_TRUE(dialog.findChildren<QLabel*>().size() > 0);
    dialog.close();
  });
  documents().open(requestFor(broken));
  ASSERT_TRUE(waitUntil([&] { return asked; }, 10000));
  EXPECT_EQ(scan().files()->folder, scan_);
}

} // namespace
} // namespace patina
