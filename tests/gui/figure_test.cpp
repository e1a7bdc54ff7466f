// Pictures for papers, from the window alone.
#include <QClipboard>
#include <QDesktopServices>
#include <QImage>
#include <QMenuBar>
#include <QTextBrowser>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"

namespace patina {
namespace {

class FigureWindowTest : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
    wait(200);
  }
  // Opens the dialog by the menu: two clicks.
  void openDialog() {
    chooseInMenu(QStringLiteral("&File"), QStringLiteral("&Export picture…"));
    ASSERT_TRUE(waitUntil([&] { return find<QDialog>("figure_dialog") != nullptr; }, 3000));
    wait(300);
  }
  void keepDialog(const QString& name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->screen()->grabWindow(0).save(QString::fromUtf8(folder) + '/' + name + ".png");
  }
};

TEST_F(FigureWindowTest, IsSavedAt85MillimetresAnd300DpiAndTransparentByFiveClicks) {
  if (IsSkipped()) return;
  const QImage before = view().grabFramebuffer();
  openDialog();
  clickOn("figure_unit_mm");
  clickOn("figure_background_transparent");
  keepDialog("figure_dialog");
  EXPECT_TRUE(test::misfits(*find<QDialog>("figure_dialog")).isEmpty());
  EXPECT_TRUE(find<QLabel>("figure_size")->text().startsWith(QStringLiteral("1004")));
  const auto path = folder_ / "figure.png";
  answerWithPath(path);
  clickOn("figure_save");
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(path); }, 10000));
  const QImage figure(QString::fromStdString(path.string()));
  EXPECT_EQ(figure.width(), 1004);
  EXPECT_NEAR(figure.height(), 1004.0 * view().height() / view().width(), 1);
  EXPECT_NEAR(figure.dotsPerMeterX(), 300 / 0.0254, 1);
  EXPECT_EQ(qAlpha(figure.pixel(figure.width() - 3, 3)), 0);
  EXPECT_EQ(qAlpha(figure.pixel(2, figure.height() - 3)), 0) << "beside the cube";
  EXPECT_EQ(qAlpha(figure.pixel(figure.width() / 2, figure.height() / 2)), 255);
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    figure.save(QString::fromUtf8(folder) + "/figure_saved.png");
  // The window shows what it showed.
  ASSERT_TRUE(waitUntil([&] { return view().frames().settled(); }, 5000));
  wait(200);
  const QImage after = view().grabFramebuffer();
  ASSERT_EQ(after.size(), before.size());
  int changed = 0;
  for (int y = 0; y < after.height(); y += 3)
    for (int x = 0; x < after.width(); x += 3)
      changed += std::abs(qGreen(after.pixel(x, y)) - qGreen(before.pixel(x, y))) > 40;
  EXPECT_LT(changed, 60);
  // The message leads to the file.
  QTextBrowser opener;
  QDesktopServices::setUrlHandler(QStringLiteral("file"), &opener, "setSource");
  auto* link = find<QToolButton>("open_saved");
  ASSERT_TRUE(link->isVisible());
  keepDialog("figure_message");
  click(*link);
  QDesktopServices::unsetUrlHandler(QStringLiteral("file"));
  EXPECT_EQ(opener.source().toLocalFile().toStdString(), path.string());
}

TEST_F(FigureWindowTest, IsCopiedAtFourTimesTheViewsSizeWithoutTheTool) {
  if (IsSkipped()) return;
  openDialog();
  clickOn("figure_scale_4");
  clickOn("figure_background_white");
  clickOn("figure_with_cube");
  clickOn("figure_copy");
  QImage copy;
  ASSERT_TRUE(waitUntil(
      [&] {
        copy = QApplication::clipboard()->image();
        return !copy.isNull();
      },
      10000));
  EXPECT_EQ(copy.width(), 4 * view().width());
  EXPECT_EQ(copy.height(), 4 * view().height());
  EXPECT_EQ(copy.pixel(copy.width() - 3, 3), 0xffffffff);
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    copy.save(QString::fromUtf8(folder) + "/figure_copy.png");
}

} // namespace
} // namespace patina
