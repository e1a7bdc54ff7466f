// The window does what commands can do to a scene, by pointer and within six clicks.
#include <QImage>
#include <QRadioButton>

#include "authoring/brush/surface_values.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "scene/surface_pick.h"

namespace patina {
namespace {

using OneClick = DrivenWindow;

TEST_F(OneClick, DoesWhatAWarningProposes) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(sheet(0.06, 0.06, 20), "sheet.obj")));
  auto* act = find<QToolButton>("open_saved");
  ASSERT_TRUE(waitUntil([&] { return act->isVisible(); }, 3000));
  EXPECT_TRUE(find<QLabel>("notice")->text().contains(QStringLiteral("stays open")));
  EXPECT_EQ(act->text(), QStringLiteral("Feel both sides"));
  click(*act); // the only one
  const auto scene = [&] { return edits().scene()->scene; };
  ASSERT_TRUE(waitUntil([&] { return scene().field.sides == OpenSides::two; }, 20000));
  EXPECT_EQ(scene().haptics.tip_radius, 1e-3);
  EXPECT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 5000))
      << "one step of the history";
}

TEST_F(OneClick, ChangesNoOtherSceneThanThatOfItsMessage) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(sheet(0.06, 0.06, 20), "sheet.obj")));
  auto* act = find<QToolButton>("open_saved");
  ASSERT_TRUE(waitUntil([&] { return act->isVisible(); }, 3000));
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  if (act->isVisible()) act->click();
  wait(500);
  EXPECT_EQ(edits().scene()->scene.field.sides, OpenSides::automatic);
  EXPECT_EQ(edits().status().edits.size(), 0U);
}

TEST_F(OneClick, SwitchesTheForceOnAgain) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "ball.obj")));
  trigger("no_force");
  auto* act = find<QToolButton>("open_saved");
  ASSERT_TRUE(waitUntil([&] { return act->isVisible(); }, 3000));
  click(*act);
  EXPECT_FALSE(find<QAction>("no_force")->isChecked());
}

TEST_F(OneClick, LaysAPictureOnAnObjectAsRelief) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(box(Vec3::Constant(0.06), 8), "cube.obj")));
  QImage stripes(64, 64, QImage::Format_Grayscale8);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      stripes.setPixel(x, y, x < 32 ? qRgb(0, 0, 0) : qRgb(255, 255, 255));
  const auto file = folder_ / "stripes.png";
  ASSERT_TRUE(stripes.save(QString::fromStdString(file.string())));
  clickOn("tab_object"); // the first click
  answerWithPath(file);
  clickOn("lay_picture");
  QWidget* dialog = nullptr;
  ASSERT_TRUE(waitUntil(
      [&] { return (dialog = find<QWidget>("picture_dialog")) && dialog->isVisible(); }, 5000));
  wait(300);
  auto* relief = dialog->findChild<QRadioButton*>("picture_target_1");
  pointAt(relief->mapToGlobal({8, relief->height() / 2}));
  press(), release();
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    dialog->grab().save(QString::fromUtf8(folder) + "/picture_dialog.png");
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 20000))
      << (QApplication::activeModalWidget()
              ? QApplication::activeModalWidget()->findChild<QLabel*>("qt_msgbox_label")
                    ? QApplication::activeModalWidget()
                          ->findChild<QLabel*>("qt_msgbox_label")
                          ->text()
                          .toStdString()
                    : "other"
              : "none");
  const Scene& scene = edits().scene()->scene;
  ASSERT_TRUE(scene.objects[0].paint && scene.objects[0].paint->relief);
  // Along z, with x to the right: high where x > 0.
  const auto heightAt = [&](const Vec3& p) {
    const auto joint = surfacePointAt(*edits().scene()->built.field, *edits().scene()->mesh, p);
    return surfaceValues(scene, 0, *joint).height;
  };
  EXPECT_NEAR(heightAt({0.015, 0.002, 0.03}), scene.relief.height, 1e-5);
  EXPECT_NEAR(heightAt({-0.015, 0.002, 0.03}), 0, 1e-5);
  if (const char* folder = std::getenv("PATINA_PICTURES"))
    window_->grab().save(QString::fromUtf8(folder) + "/picture_laid.png");
}

} // namespace
} // namespace patina
