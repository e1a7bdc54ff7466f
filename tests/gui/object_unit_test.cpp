// The unit and the upper axis of an open mesh, corrected by real events.
#include <QComboBox>
#include <QDialog>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class ObjectUnitTest : public DrivenWindow {
 protected:
  Vec3 size() { return bounds(*edits().scene()->mesh).sizes(); }
};

TEST_F(ObjectUnitTest, IsAnEditThatIsSavedAndUndone) {
  if (IsSkipped()) return;
  const Vec3 read(0.02, 0.05, 0.03); // centimetres that were read as millimetres
  ASSERT_TRUE(open(saved(box(read), "block.obj")));
  openTab("object");
  whenAsked<QDialog>([this](QDialog& dialog) {
    EXPECT_TRUE(test::misfits(dialog).isEmpty());
    click(*dialog.findChild<QComboBox*>("unit_now"));
    wait(200);
    type(QStringLiteral("cent"));
    type(kEnter);
    EXPECT_TRUE(dialog.findChild<QLabel*>("unit_result")->text().startsWith("500"));
    click(*dialog.findChild<QCheckBox*>("y_is_up"));
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      dialog.grab().save(QString::fromUtf8(folder) + "/object_unit.png");
    type(kEnter);
  });
  clickOn("object_unit");
  const Vec3 right(0.2, 0.3, 0.5);
  ASSERT_TRUE(waitUntil([&] { return (size() - right).norm() < 1e-9; }, 20000))
      << size().transpose();
  wait(300);
  EXPECT_GT(surfaceShare(), 0.05) << "the picture fits the new size";
  EXPECT_LT(surfaceShare(), 0.6);
  saving().saveTo(QString::fromStdString((folder_ / "block").string()));
  const Scene kept = loadWorkspace(folder_ / "block");
  EXPECT_NEAR((bounds(*kept.objects.front().mesh).sizes() - 10 * read).norm(), 0, 1e-9);
  view().setFocus();
  type('z', kControl);
  ASSERT_TRUE(waitUntil([&] { return (size() - read).norm() < 1e-9; }, 20000));
}

} // namespace
} // namespace patina
