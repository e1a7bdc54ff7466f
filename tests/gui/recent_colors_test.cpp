// Recently chosen colours are offered, also at the next start.
#include <QColorDialog>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class RecentColors : public DrivenWindow {
 protected:
  void paintColor() {
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
    trigger("tool_color");
    wait(100);
  }
  void choose(const QColor& color) {
    whenAsked<QColorDialog>([this, color](QColorDialog& dialog) {
      dialog.setCurrentColor(color);
      type(kEnter);
    });
    clickOn("brush_color");
    wait(50);
  }
  QColor shown(const QString& name) {
    auto* button = find<QToolButton>(name);
    if (button == nullptr) return {};
    const QImage picture = button->grab().toImage();
    return picture.pixelColor(picture.width() / 2, picture.height() / 2);
  }
};

TEST_F(RecentColors, AreOfferedNewestFirstAlsoAtTheNextStart) {
  if (IsSkipped()) return;
  paintColor();
  EXPECT_EQ(find<QToolButton>("recent_color_0"), nullptr);
  for (int i = 0; i < 9; ++i) choose(QColor(20 * i, 200, 255 - 20 * i));
  choose(QColor(60, 200, 195)); // again
  EXPECT_EQ(find<QToolButton>("recent_color_8"), nullptr) << "eight are kept";
  EXPECT_EQ(shown("recent_color_0"), QColor(60, 200, 195));
  EXPECT_EQ(shown("recent_color_1"), QColor(160, 200, 95));
  EXPECT_EQ(shown("recent_color_7"), QColor(20, 200, 235));
  clickOn("recent_color_7");
  EXPECT_EQ(shown("brush_color"), QColor(20, 200, 235));

  window_ = std::make_unique<MainWindow>();
  window_->show();
  takeSize(1280, 800);
  paintColor();
  EXPECT_EQ(shown("recent_color_0"), QColor(60, 200, 195));
  EXPECT_EQ(shown("recent_color_7"), QColor(20, 200, 235));
}

} // namespace
} // namespace patina
