// Textures are read from files, laid along a drawn path, exchanged and removed: by pointer and
// keys.
#include <cmath>

#include "app/gui/control/desk_controller.h"
#include "app/gui/texturing/scene_textures.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/texturing/texture_library.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

class TextureLibraryTest : public DrivenWindow {
 protected:
  static FourierTexture wave(const char* name, double wavelength, double amplitude) {
    FourierTexture texture;
    texture.name = name;
    texture.omega = 2 * M_PI / wavelength;
    texture.series.a = {amplitude, 0};
    texture.series.b = {0, 0.3 * amplitude};
    texture.low = minHeight(texture);
    return texture;
  }
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    TriangleMesh mesh = icosphere(0.03, 40);
    ASSERT_TRUE(open(saved(mesh, "sphere.ply")));
    writeTexture(folder_ / "ribs.json", wave("ribs", 4e-3, 30e-6));
    writeTexture(folder_ / "felt.json", wave("felt", 1e-3, 8e-6));
    clickAction("desk_texture");
    clickOn("tab_library");
    wait(500);
  }
  ScanView& cell() { return *find<ScanView>("lay_view"); }
  QListWidget& list() { return *find<QListWidget>("textures"); }
  const TextureMappings* laid() {
    const auto& paint = edits().scene()->scene.objects[0].paint;
    return paint ? paint->textures.get() : nullptr;
  }
  void read(const char* file) {
    answerWithPath(folder_ / file);
    const int before = list().count();
    clickOn("texture_read");
    ASSERT_TRUE(waitUntil([&] { return list().count() == before + 1; }, 10000));
  }
  QPoint at(double x, double y) { // fractions of the picture's height, from its middle
    const int high = cell().height();
    return cell().mapToGlobal(cell().rect().center() + QPoint(qRound(x * high), qRound(-y * high)));
  }
  bool draw(const QPoint& from, const QPoint& to) {
    const std::size_t before = edits().status().done;
    drag(from, to, 1, 24);
    return waitUntil([&] { return edits().status().done == before + 1; }, 20000);
  }
  void keepPicture(const QString& name) {
    wait(500);
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }
};

TEST_F(TextureLibraryTest, LaysATextureAlongADrawnPathAndUndoesIt) {
  EXPECT_FALSE(find<QPushButton>("texture_draw")->isVisible()); // there is no texture to lay
  read("ribs.json");
  clickOn("texture_draw");
  ASSERT_TRUE(draw(at(-0.2, 0.05), at(0.2, 0.05)));
  ASSERT_NE(laid(), nullptr);
  keepPicture("texture_library");
  // The layout: x grows along the hand's path, 1 m a metre, and no face lies far from the path.
  const auto& mesh = *edits().scene()->scene.objects[0].mesh;
  EXPECT_GT(laid()->faces.size(), 50U);
  EXPECT_EQ(laid()->library.at(1)->value.name, "ribs");
  double most = 0, least = 1e9;
  for (const TexturedFace& face : laid()->faces) {
    const Triangle& corners = mesh.triangles[static_cast<std::size_t>(face.face)];
    for (int k = 0; k < 3; ++k) {
      const Vec3& a =
          mesh.positions[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
      const Vec3& b =
          mesh.positions[static_cast<std::size_t>(corners[static_cast<std::size_t>((k + 1) % 3)])];
      const double way = (b - a).norm();
      const double drawn = (face.coords[static_cast<std::size_t>((k + 1) % 3)] -
                            face.coords[static_cast<std::size_t>(k)])
                               .norm();
      most = std::max(most, drawn / way);
      least = std::min(least, drawn / way);
    }
  }
  EXPECT_LT(most, 1.5);
  EXPECT_GT(least, 0.5);
  // The servo has the texture's stage.
  EXPECT_TRUE(list().item(0)->text().contains(QStringLiteral("ribs, on")))
      << list().item(0)->text().toStdString();
  EXPECT_TRUE(find<QWidget>("page_profile")->isVisible());
  const std::size_t faces = laid()->faces.size();
  type('z', kControl);
  ASSERT_TRUE(waitUntil([&] { return laid() == nullptr; }, 10000));
  // The menu offers to redo a moment after the scene has changed.
  const QKeySequence redo(QStringLiteral("Ctrl+Y"));
  ASSERT_TRUE(waitUntil([&] {
    for (const QAction* action : window_->findChildren<QAction*>())
      if (action->shortcuts().contains(redo)) return action->isEnabled();
    return false;
  }));
  type('y', kControl);
  ASSERT_TRUE(waitUntil([&] { return laid() != nullptr && laid()->faces.size() == faces; }, 10000));
}

TEST_F(TextureLibraryTest, HighlightsTheFacesOfTheChosenTexture) {
  // Counts the orange pixels of the picture's right or left half.
  const auto orange = [this](bool right) {
    cell().refresh();
    const QImage picture = cell().grabFramebuffer();
    int count = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = right ? picture.width() / 2 : 0; x < picture.width() / (right ? 1 : 2); ++x) {
        const QColor color = picture.pixelColor(x, y);
        count += std::abs(color.hue() - 30) < 10 && color.saturation() > 185;
      }
    return count;
  };
  read("ribs.json");
  clickOn("texture_draw");
  ASSERT_TRUE(draw(at(-0.2, 0.1), at(-0.2, -0.1)));
  clickOn("texture_draw");
  read("felt.json");
  clickOn("texture_draw");
  ASSERT_TRUE(draw(at(0.2, 0.1), at(0.2, -0.1)));
  clickOn("texture_draw");
  wait(300);
  keepPicture("texture_chosen");
  EXPECT_GT(orange(true), 200);
  EXPECT_LT(orange(false), 20);
  list().setFocus();
  constexpr std::uint32_t kUp = 0xff52;
  type(kUp);
  ASSERT_EQ(list().currentRow(), 0);
  wait(300);
  EXPECT_GT(orange(false), 200);
  EXPECT_LT(orange(true), 20);
}

TEST_F(TextureLibraryTest, ExchangesATextureOnEveryFaceAndRemovesIt) {
  read("ribs.json");
  clickOn("texture_draw");
  ASSERT_TRUE(draw(at(-0.15, 0), at(0.15, 0.1)));
  clickOn("texture_draw"); // the hand rests
  const std::vector<TexturedFace> faces = laid()->faces;
  const std::size_t done = edits().status().done;
  answerWithPath(folder_ / "felt.json");
  clickOn("texture_swap");
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == done + 1; }, 20000));
  EXPECT_EQ(laid()->faces, faces);
  EXPECT_TRUE(laid()->library.at(1)->value == readTexture(folder_ / "felt.json"));
  clickOn("texture_remove");
  ASSERT_TRUE(waitUntil([&] { return laid() == nullptr; }, 20000));
  EXPECT_TRUE(list().item(0)->text().contains(QStringLiteral("unused")));
  // The kept file contains the texture.
  answerWithPath(folder_ / "kept.json");
  clickOn("texture_keep");
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(folder_ / "kept.json"); }, 10000));
  EXPECT_TRUE(readTexture(folder_ / "kept.json") == readTexture(folder_ / "felt.json"));
}

TEST_F(TextureLibraryTest, RestoresTheProfileAfterAnotherDesk) {
  read("ribs.json");
  ASSERT_TRUE(find<QWidget>("page_profile")->isVisible());
  clickAction("desk_feel");
  EXPECT_FALSE(find<QWidget>("page_profile")->isVisible());
  clickAction("desk_texture");
  EXPECT_TRUE(find<QWidget>("page_profile")->isVisible());
  EXPECT_TRUE(find<PlotWidget>("profile_plot")->isVisible());
}

TEST_F(TextureLibraryTest, HandTurnsThePictureWithoutPenOrTextureAndAMissingScanIsReported) {
  const std::size_t done = edits().status().done;
  drag(at(-0.1, 0), at(0.1, 0));
  wait(300);
  EXPECT_EQ(edits().status().done, done);
  read("ribs.json");
  clickOn("texture_draw");
  type(kEscape);
  EXPECT_FALSE(find<QPushButton>("texture_draw")->isChecked());
  drag(at(-0.1, 0), at(0.1, 0));
  wait(300);
  EXPECT_EQ(edits().status().done, done);
  clickOn("texture_scan");
  EXPECT_TRUE(find<QLabel>("texture_hint")->text().contains(QStringLiteral("desk Scan")));
}

// Three faces have a texture, one of them two.
TEST(TexturedFaces, ContainTheChosenTexturesFacesAndTheRest) {
  Scene scene;
  scene.objects.push_back({"ball",
                           std::make_shared<const TriangleMesh>(icosphere(0.03, 4)),
                           Pose(Eigen::Translation3d(0.1, 0, 0)),
                           {}});
  const TriangleMesh& mesh = *scene.objects[0].mesh;
  EXPECT_EQ(texturedParts(scene, {}).selected, nullptr);
  auto laid = std::make_shared<TextureMappings>();
  for (const auto& [face, number] : {std::pair{7, 1}, {7, 2}, {3, 1}, {5, 2}}) {
    TexturedFace on;
    on.face = face;
    on.texture = number;
    laid->faces.push_back(on);
  }
  auto paint = std::make_shared<ObjectPaint>();
  paint->textures = laid;
  scene.objects[0].paint = paint;
  const auto middles = [](const std::shared_ptr<const TriangleMesh>& part) {
    std::vector<double> sums;
    if (part)
      for (const Triangle& t : part->triangles)
        sums.push_back((part->positions[index(t[0])] + part->positions[index(t[1])] +
                        part->positions[index(t[2])])
                           .sum());
    return sums;
  };
  const auto faces = [&](std::initializer_list<int> numbers) {
    std::vector<double> sums;
    for (const int f : numbers) {
      const Triangle& t = mesh.triangles[index(f)];
      sums.push_back((mesh.positions[index(t[0])] + mesh.positions[index(t[1])] +
                      mesh.positions[index(t[2])] + Vec3(0.3, 0, 0))
                         .sum());
    }
    return sums;
  };
  const auto expect = [&](std::optional<std::int32_t> number, std::initializer_list<int> meant,
                          std::initializer_list<int> rest) {
    const TexturedFaces parts = texturedParts(scene, number);
    for (const auto& [part, those] : {std::pair{parts.selected, meant}, {parts.others, rest}}) {
      const auto found = middles(part), wanted = faces(those);
      ASSERT_EQ(found.size(), wanted.size());
      for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12);
    }
  };
  expect(1, {3, 7}, {5});
  expect(2, {5, 7}, {3});
  expect({}, {3, 5, 7}, {});
  expect(9, {3, 5, 7}, {}); // read, and laid nowhere yet
}

} // namespace
} // namespace patina
