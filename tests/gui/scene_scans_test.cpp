// Scans and calibrations of the workspace are added, removed and undone like by a user.
#include <QComboBox>
#include <random>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/registered_file.h"
#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/tracking/lens.h"
#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/align_files.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/textured_obj.h"
#include "gui/scan_fixture.h"
#include "scan/run_scan.h"
#include "support/printed_board.h"
#include "workspace/texture_file.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class SceneScansTest : public ScanDeskTest {
 protected:
  void openWorkspace(const TriangleMesh& mesh) {
    Scene scene;
    scene.field.resolution = 60;
    scene.objects.push_back({"ball", std::make_shared<const TriangleMesh>(mesh)});
    saveWorkspace(scene, folder_ / "workspace");
    ASSERT_TRUE(open(folder_ / "workspace"));
  }
  // The frames show a tip 120 mm below, the rig says 100.
  fs::path turningScan() const {
    const Vec3 tip(0.002, 0.01, -0.12);
    std::vector<CameraPose> poses;
    for (int i = 0; i < 60; ++i) {
      CameraPose pose;
      pose.t = 0.05 * i;
      pose.orientation = Eigen::AngleAxisd(0.8 * i, Vec3::UnitZ()) *
                         Eigen::AngleAxisd(0.1 + 0.012 * i, Vec3::UnitX());
      pose.position = Vec3(0.1, 0, 0.5) - pose.orientation * tip;
      poses.push_back(pose);
    }
    fs::path turning = folder_ / "turning";
    fs::create_directories(turning);
    writePoses(turning / "poses.tum", poses);
    std::ofstream(turning / "rig.json") << "{\"tip\": [0, 0, -0.1], \"mine\": 7}\n";
    return turning;
  }
  const Scene& scene() { return edits().scene()->scene; }
  const EditStatus& status() { return edits().status(); }
  bool waitForEdits(std::size_t done) {
    const bool there = waitUntil([&] { return status().done == done && !desk().work(); }, 20000);
    wait(100);
    return there;
  }
};

TEST_F(SceneScansTest, UndoesEachStepAndReopensTheScanFromTheWorkspace) {
  openWorkspace(icosphere(0.04, 12));
  clickAction("desk_scan");
  EXPECT_FALSE(find<QWidget>("scene_scans")->isVisible()); // absent: no list, no buttons
  EXPECT_FALSE(find<QWidget>("put_scan")->isVisible());
  ASSERT_TRUE(openScan());
  const std::string name = "a-scan-of-a-sphere";
  clickOn("put_scan");
  ASSERT_TRUE(waitForEdits(3));
  EXPECT_EQ(status().edits, (std::vector<std::string>{"attach scan " + name, "track scan " + name,
                                                      "filter scan " + name}));
  auto* list = find<QListWidget>("scene_scans");
  ASSERT_TRUE(list->isVisible());
  EXPECT_TRUE(list->item(0)->text().startsWith(QString::fromStdString(name)));
  keepPicture("scene_scans");
  type('z', kControl);
  ASSERT_TRUE(waitForEdits(2));
  EXPECT_NE(scene().scans.at(0).text("poses.tum"), nullptr);
  EXPECT_EQ(scene().scans.at(0).text("path.csv"), nullptr);
  type('y', kControl);
  ASSERT_TRUE(waitForEdits(3));
  clickOn("remove_scene_scan");
  ASSERT_TRUE(waitForEdits(4));
  EXPECT_FALSE(list->isVisible());
  type('z', kControl);
  ASSERT_TRUE(waitForEdits(3));
  type('s', kControl);
  ASSERT_TRUE(waitUntil([&] { return !edits().unsaved(); }, 10000));
  EXPECT_EQ(loadWorkspace(folder_ / "workspace").scans, scene().scans);

  const std::size_t samples = scan().path()->path.size();
  clickOn("close_scan");
  fs::rename(scan_, folder_ / "elsewhere"); // with its frames
  clickOn("open_scene_scan");
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }, 20000));
  EXPECT_TRUE(scan().files()->of_scene);
  EXPECT_EQ(scan().path()->path.size(), samples);
  EXPECT_NE(scan().files()->problem.find("is gone"), std::string::npos) << scan().files()->problem;

  // The path is placed on the mesh, from the workspace and back into it.
  clickAction("desk_align");
  find<QComboBox>("align_scan")->setFocus();
  type(0xff54), wait(100); // down: its only scan
  auto& align = *window_->findChild<AlignDesk*>();
  ASSERT_TRUE(waitUntil([&] { return align.alignment().isReady(); }, 10000));
  EXPECT_EQ(align.name().toStdString(), name);
  clickOn("align_store");
  ASSERT_TRUE(waitUntil([&] { return status().done == 4; }, 10000));
  EXPECT_EQ(status().edits.back(), "register scan " + name);
  ASSERT_NE(scene().scans.at(0).text("registered.txt"), nullptr);
  EXPECT_NE(scene().scans.at(0).text("registered.txt")->find("mesh_from_scan"), std::string::npos);
}

TEST_F(SceneScansTest, TextureOfAFittedScanHasTheFittedCompliance) {
  openWorkspace(icosphere(0.04, 12));
  clickAction("desk_scan");
  ASSERT_TRUE(openScan());
  clickOn("put_scan");
  ASSERT_TRUE(waitForEdits(3));
  clickAction("desk_align");
  find<QComboBox>("align_scan")->setFocus();
  type(0xff54), wait(100); // down: the only scan
  auto& align = *window_->findChild<AlignDesk*>();
  ASSERT_TRUE(waitUntil([&] { return align.alignment().isReady(); }, 10000));
  clickOn("align_fit");
  ASSERT_TRUE(waitUntil([&] { return align.alignment().found() && !align.work(); }, 60000));
  const double compliance = align.alignment().found()->compliances.at(0);
  ASSERT_GT(compliance, 0);
  clickAction("desk_texture");
  clickOn("tab_library");
  clickOn("texture_scan");
  ASSERT_TRUE(waitUntil([&] { return status().done == 4; }, 60000))
      << find<QLabel>("texture_hint")->text().toStdString();
  const auto& paint = scene().objects.at(0).paint;
  ASSERT_TRUE(paint && paint->textures);
  EXPECT_EQ(paint->textures->library.at(1)->value.compliance, compliance);
  EXPECT_EQ(find<QLabel>("texture_hint")->text(), QString());
}

// The window's result equals the command's for the same folder and mesh to the last bit.
TEST_F(SceneScansTest, ButtonLaysTheSameTextureAsPatinaScan) {
  const TriangleMesh ball = icosphere(0.04, 12);
  fs::create_directories(folder_ / "again");
  fs::copy(scan_, folder_ / "again" / scan_.filename(), fs::copy_options::recursive);
  openWorkspace(ball);
  clickAction("desk_scan");
  ASSERT_TRUE(openScan());
  clickOn("scan_texture");
  ASSERT_TRUE(waitUntil([&] { return status().done == 1; }, 60000));
  const auto& paint = scene().objects.at(0).paint;
  ASSERT_TRUE(paint && paint->textures);
  keepPicture("scan_texture");

  const fs::path again = folder_ / "again" / scan_.filename();
  writeMesh(folder_ / "ball.ply", ball);
  RunScanOptions options;
  options.folders = {again};
  options.mesh = folder_ / "ball.ply";
  options.unit = MeshUnit::m;
  options.workspace = folder_ / "by-command";
  Progress progress;
  ASSERT_TRUE(runScan(options, progress).done);
  writeTexture(folder_ / "texture.json", paint->textures->library.at(1)->value);
  EXPECT_EQ(readFile(folder_ / "texture.json"), readFile(again / "texture.json"));
  const Alignment& laid = window_->findChild<AlignDesk*>()->alignment();
  EXPECT_EQ(registeredText(laid.path(), laid.registration()), readFile(again / "registered.csv"));
  const std::vector<TexturedFace> faces = readTexturedObj(again / "textured.obj").textured;
  ASSERT_EQ(faces.size(), paint->textures->faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    EXPECT_EQ(faces[i].face, paint->textures->faces[i].face);
    EXPECT_EQ(faces[i].coords, paint->textures->faces[i].coords);
  }
}

// The second is requested before the first is done.
TEST_F(SceneScansTest, StoredPoseSurvivesAScanAddedAtOnce) {
  const TriangleMesh ball = icosphere(0.04, 12);
  std::vector<PathSample> path(60);
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i].t = 0.01 * static_cast<double>(i);
    path[i].position = ball.positions[7 * i % ball.positions.size()];
    path[i].sigma = 1e-4;
  }
  const fs::path stroke = folder_ / "stroke";
  fs::create_directories(stroke);
  writePath(stroke / "path.csv", path);
  std::ofstream(stroke / "rig.json") << "{\"tip\": [0, 0, -0.1]}\n";
  openWorkspace(ball);
  documents().open(requestFor(stroke));
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }, 10000));
  auto& align = *window_->findChild<AlignDesk*>();
  ASSERT_TRUE(waitUntil([&] { return align.alignment().isReady(); }, 10000));
  find<QPushButton>("align_store")->click();
  find<QPushButton>("put_scan")->click();
  ASSERT_TRUE(waitForEdits(2));
  ASSERT_EQ(scene().scans.size(), 1u);
  for (const char* file : {"rig.json", "path.csv", "registered.csv", "registered.txt"})
    EXPECT_NE(scene().scans[0].text(file), nullptr) << file;
  // Another path under the same name has no registration.
  for (PathSample& sample : path) sample.position.z() += 0.01;
  align.setPath(QStringLiteral("stroke"), {path, {}});
  const SceneScan before = scene().scans[0];
  EXPECT_THROW((void)withAlignment(&before, alignedScan("stroke", align.alignment())), Error);
  // A refused alignment leaves the path unchanged.
  const Pose place = align.alignment().pose();
  path.resize(2);
  align.setPath(QStringLiteral("touch"), {path, Pose(Eigen::Translation3d(1, 2, 3))});
  EXPECT_EQ(align.alignment().pose().matrix(), place.matrix());
  EXPECT_EQ(align.alignment().path().size(), 60u);
}

// A chessboard of black squares on white, in eight attitudes.
TEST_F(SceneScansTest, PicturesOfABoardCalibrateACameraThatIsKept) {
  const Camera known{640, 480, 610, 606, 325, 236, {-0.1, 0.04, 0, 0, 0}};
  std::vector<PrintedMarker> printed;
  for (int y = 0; y < 7; ++y)
    for (int x = y % 2; x < 10; x += 2) {
      PrintedMarker one{{"4x4_50", 0, 0.025, Pose::Identity()}, 4, 0, 0};
      one.place.probe_from_marker.translation() = 0.025 * Vec3(x + 0.5, -(y + 0.5), 0);
      printed.push_back(one);
    }
  const FrameRenderer renderer(known, printed);
  FrameLook look;
  look.ground = look.white;
  look.waves = 0;
  const fs::path pictures = folder_ / "board";
  fs::create_directories(pictures);
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = (Eigen::AngleAxisd(M_PI, Vec3::UnitX()) *
                     Eigen::AngleAxisd(0.45 * std::sin(2.1 * i), Vec3::UnitY()) *
                     Eigen::AngleAxisd(0.45 * std::cos(1.7 * i), Vec3::UnitX()))
                        .toRotationMatrix();
    pose.translation() = Vec3(0, 0, 0.4 + 0.02 * (i % 3)) - pose.linear() * Vec3(0.125, -0.0875, 0);
    poses.push_back(pose);
    writeGrey(pictures / ("view" + std::to_string(i) + ".png"), renderer.render({pose}, look, 1));
  }
  clickAction("desk_scan");
  answerWithPath(pictures);
  clickOn("calibrate_pictures");
  ASSERT_TRUE(waitUntil([&] { return scan().files() != nullptr && !desk().work(); }, 10000));
  wait(300);
  clickOn("calibrate_camera");
  const auto* found = find<QLabel>("calibrate_found");
  ASSERT_TRUE(waitUntil([&] { return !found->text().isEmpty() && !desk().work(); }, 30000));
  wait(400); // the column scrolls to the result
  EXPECT_TRUE(found->text().contains(QStringLiteral("in 8 of 8"))) << found->text().toStdString();
  EXPECT_TRUE(found->text().contains(QStringLiteral("fx 6"))) << found->text().toStdString();
  EXPECT_TRUE(found->text().contains(QStringLiteral("±")));
  keepPicture("calibrated");
  // The corners lie on the board.
  auto* canvas = find<PictureView>("frame");
  const QImage drawn = canvas->grab().toImage();
  int bright = 0;
  for (int y = 1; y < 7; ++y)
    for (int x = 1; x < 10; ++x) {
      const Vec3 corner = poses[0] * (0.025 * Vec3(x, -y, 0));
      const Vec2 pixel = pixelOf(known, corner);
      const QColor at = drawn.pixelColor(canvas->placeOf({pixel.x(), pixel.y()}).toPoint());
      bright += at.green() > at.red() + 60 || at.red() > at.blue() + 60;
    }
  EXPECT_GT(bright, 48) << "of 54";
  EXPECT_FALSE(fs::exists(pictures / "camera.yml"));
  clickOn("calibrate_use");
  ASSERT_TRUE(waitUntil([&] { return fs::exists(pictures / "camera.yml"); }, 10000));
  const Camera camera = readCamera(pictures / "camera.yml");
  EXPECT_NEAR(camera.fx, known.fx, 3);
  EXPECT_NEAR(camera.cy, known.cy, 3);
  // A name without a board is reported, and nothing is offered.
  ASSERT_TRUE(waitUntil([&] { return !desk().work(); }, 10000));
  auto* board = find<QLineEdit>("calibrate_board");
  wait(200); // the card's layout needs time once there is a camera
  click(*board);
  ASSERT_TRUE(waitUntil([&] { return board->hasFocus(); }, 5000));
  type('a', kControl);
  type(QStringLiteral("chessboard8x5"));
  ASSERT_TRUE(waitUntil([&] { return board->text() == QStringLiteral("chessboard8x5"); }, 5000))
      << board->text().toStdString();
  clickOn("calibrate_camera");
  EXPECT_TRUE(waitUntil(
      [&] { return found->text().contains(QStringLiteral("chessboard:COLUMNSxROWS")); }, 5000))
      << found->text().toStdString();
  EXPECT_FALSE(find<QPushButton>("calibrate_use")->isVisible());
}

TEST_F(SceneScansTest, BoardInAReplayCalibratesACameraKeptInTheChosenFile) {
  const QString words = QStringLiteral("charuco:6x8:25mm:18.75mm:4x4_50");
  const Board board = parseBoard(words.toStdString());
  const Camera known{640, 480, 610, 606, 325, 236, {-0.1, 0.04, 0, 0, 0}};
  const FrameRenderer renderer(known, test::printedBoard(board, true));
  const fs::path seen = folder_ / "seen", kept = folder_ / "kept";
  fs::create_directories(seen / "frames");
  fs::create_directories(kept);
  std::mt19937 random(4);
  std::string list = "frame,t [s]\n";
  for (int i = 0; i < 6; ++i) {
    writeGrey(seen / "frames" / (frameStem(i) + ".png"),
              renderer.render({test::boardPose(board, random, 0.35)}, test::boardLook(), 1));
    list += std::to_string(i) + "," + std::to_string(0.05 * i) + "\n";
  }
  writeFileAtomically(seen / "frames.csv", list);
  clickAction("desk_scan");
  find<QLineEdit>("calibrate_source")
      ->setText(QStringLiteral("replay:%1").arg(QString::fromStdString(seen.string())));
  find<QLineEdit>("calibrate_board")->setText(words);
  wait(300);
  clickOn("calibrate_camera");
  const auto* found = find<QLabel>("calibrate_found");
  ASSERT_TRUE(waitUntil([&] { return !found->text().isEmpty() && !desk().work(); }, 30000));
  EXPECT_TRUE(found->text().contains(QStringLiteral("in 6 of 6"))) << found->text().toStdString();
  wait(400); // the column scrolls to the result
  answerWithPath(kept);
  clickOn("calibrate_use");
  ASSERT_TRUE(waitUntil([&] { return fs::exists(kept / "camera.yml"); }, 10000));
  EXPECT_NEAR(readCamera(kept / "camera.yml").fx, known.fx, 5);
  // Another board causes a warning, and nothing is offered.
  ASSERT_TRUE(waitUntil([&] { return !desk().work(); }, 10000));
  find<QLineEdit>("calibrate_board")->setText(QStringLiteral("charuco:7x8:25mm:18.75mm:4x4_50"));
  clickOn("calibrate_camera");
  EXPECT_TRUE(waitUntil(
      [&] { return found->text().contains(QStringLiteral("which is no calibration")); }, 30000))
      << found->text().toStdString();
  EXPECT_FALSE(find<QPushButton>("calibrate_use")->isVisible());
}

TEST_F(SceneScansTest, TipFromPosesIsAnEditOfTheWorkspacesScan) {
  const fs::path turning = turningScan();
  openWorkspace(icosphere(0.04, 12));
  documents().open(requestFor(turning));
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }, 10000));
  wait(200);
  clickOn("put_scan");
  ASSERT_TRUE(waitUntil([&] { return status().done >= 1; }, 10000));
  wait(300);
  ASSERT_TRUE(waitForEdits(2));
  EXPECT_NE(scene().scans.at(0).text("path.csv"), nullptr);
  const std::size_t put = status().done;
  const Vec3 was = scan().path()->path.front().position;
  clickOn("calibrate_tip");
  const auto* found = find<QLabel>("calibrate_found");
  EXPECT_TRUE(found->text().contains(QStringLiteral("z -120.000"))) << found->text().toStdString();
  wait(400);
  clickOn("calibrate_use");
  ASSERT_TRUE(waitForEdits(put + 1));
  EXPECT_EQ(status().edits.back(), "calibrate and filter scan turning");
  EXPECT_NEAR(parseRig(*scene().scans[0].text("rig.json"), "rig").probe.tip.z(), -0.12, 1e-6);
  EXPECT_NE(scene().scans[0].text("rig.json")->find("mine"), std::string::npos);
  EXPECT_EQ(scene().scans[0].text("path.csv"), nullptr) << "of the previous tip";
  EXPECT_NE(scene().scans[0].text("poses.tum"), nullptr) << "of no tip";
  ASSERT_TRUE(waitUntil([&] { return scan().files()->of_scene && !desk().work(); }, 10000));
  EXPECT_NEAR(scan().files()->tip().z(), -0.12, 1e-6); // the tip is used
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr; }, 10000));
  EXPECT_GT((scan().path()->path.front().position - was).norm(), 0.01); // the path, too
  EXPECT_NEAR(readRig(turning / "rig.json").probe.tip.z(), -0.1, 1e-12);
  type('z', kControl);
  ASSERT_TRUE(waitForEdits(put));
  ASSERT_TRUE(waitUntil([&] { return scan().files()->tip().z() > -0.11; }, 10000));
}

TEST_F(SceneScansTest, TipOfAFolderScanReplacesTheEarlierPath) {
  const fs::path turning = turningScan();
  std::vector<PathSample> before(5);
  for (std::size_t i = 0; i < before.size(); ++i) {
    before[i].t = 0.1 * static_cast<double>(i);
    before[i].position = Vec3(1, 1, 1);
    before[i].sigma = 1e-4;
  }
  writePath(turning / "path.csv", before);
  documents().open(requestFor(turning));
  ASSERT_TRUE(waitUntil([&] { return scan().path() != nullptr && !desk().work(); }, 10000));
  EXPECT_EQ(scan().path()->path.size(), 5u);
  wait(300);
  clickOn("calibrate_tip");
  wait(400);
  clickOn("calibrate_use");
  ASSERT_TRUE(waitUntil([&] { return fs::exists(turning / "path.csv~"); }, 10000));
  EXPECT_FALSE(fs::exists(turning / "path.csv"));
  EXPECT_TRUE(fs::exists(turning / "poses.tum"));
  ASSERT_TRUE(
      waitUntil([&] { return scan().path() != nullptr && scan().path()->path.size() > 5; }, 10000));
  EXPECT_NEAR(scan().files()->tip().z(), -0.12, 1e-6);
}

} // namespace
} // namespace patina
