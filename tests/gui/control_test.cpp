// Small controls that users often miss, by pointer and keys.
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QListWidget>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

class Controls : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  }
  QToolButton* crossOf(const QString& row) {
    for (auto* button : find<ValueRow>(row)->findChildren<QToolButton*>())
      if (button->isVisible()) return button;
    return nullptr;
  }
  void addFriction() {
    addProperty("Friction");
    ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.haptics.friction.has_value(); }));
    wait(100);
  }
  bool frictionGoes() {
    return waitUntil([&] { return !edits().scene()->scene.haptics.friction.has_value(); }, 5000) &&
           find<ValueRow>("friction_static") == nullptr;
  }
  void paintAcross() {
    type(QStringLiteral("p"));
    wait(200);
    drag(inView({-60, 0}), inView({60, 0}));
  }
  bool editsAre(std::size_t count) {
    return waitUntil([&] { return edits().status().edits.size() == count; }, 60000);
  }
};

TEST_F(Controls, CrossRemovesARowByPointer) {
  addFriction();
  click(*crossOf("friction_static"));
  EXPECT_TRUE(frictionGoes());
}

TEST_F(Controls, CrossRemovesARowByKey) {
  addFriction();
  crossOf("friction_static")->setFocus(Qt::TabFocusReason);
  type(' ');
  EXPECT_TRUE(frictionGoes());
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::feel)
      << "Space belonged to the button";
}

TEST_F(Controls, SpaceTogglesTheSelectedRowAndKeepsTheTool) {
  openTab("show");
  wait(50);
  auto* list = find<QListWidget>("layers");
  list->setFocus(Qt::TabFocusReason);
  list->setCurrentItem(rowOf("slice"));
  type(' ');
  EXPECT_TRUE(isShown("slice"));
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::feel);
  click(view());
  type(' ');
  EXPECT_TRUE(isShown("slice"));
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::navigate);
}

TEST_F(Controls, UndoTakesBackAValueThatHasJustBeenSet) {
  const auto stiffness = [&] { return edits().scene()->scene.haptics.stiffness; };
  const double before = stiffness();
  click(*find<ValueRow>("stiffness")->findChild<QDoubleSpinBox*>());
  type('a', kControl);
  type(QStringLiteral("900"));
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return stiffness() == 900; }, 3000));
  EXPECT_EQ(edits().status().done, 0U) << "it is no edit yet";
  for (const QAction* action : window_->findChildren<QAction*>())
    if (action->text() == QStringLiteral("&Undo")) {
      EXPECT_TRUE(action->isEnabled());
    }
  type('z', kControl);
  EXPECT_TRUE(waitUntil([&] { return stiffness() == before; }, 3000));
  EXPECT_EQ(find<ValueRow>("stiffness")->value(), before);
  wait(600);
  EXPECT_EQ(stiffness(), before);
}

TEST_F(Controls, RecordingNeedsTwoKeysAndSaysThatItRuns) {
  type('r');
  wait(100);
  EXPECT_FALSE(feel().recording());
  type('r', kControl);
  ASSERT_TRUE(waitUntil([&] { return feel().recording(); }, 3000));
  EXPECT_TRUE(find<QLabel>("notice")->text().startsWith(QStringLiteral("Recording")));
}

TEST_F(Controls, DesksHaveTheKeysOneToSixFromLeftToRight) {
  char key = '1';
  for (const DeskRow& row : deskRows()) {
    type(static_cast<std::uint32_t>(key++), kControl);
    EXPECT_TRUE(find<QAction>(QStringLiteral("desk_") + row.name)->isChecked()) << row.name;
  }
}

TEST_F(Controls, SwatchShowsThePaintColour) {
  type(QStringLiteral("p"));
  wait(100);
  auto* now = find<QToolButton>("brush_color");
  QToolButton* green = nullptr;
  for (auto* button : find<BrushPanel>()->findChildren<QToolButton*>())
    if (button->toolTip().contains(QStringLiteral("#4a9447"))) green = button;
  ASSERT_NE(green, nullptr);
  click(*green);
  EXPECT_EQ(now->grab().toImage().pixelColor(now->rect().center()).name(),
            QStringLiteral("#4a9447"));
}

TEST_F(Controls, EscapeUndoesAStrokeAndTheNextOnePaints) {
  type(QStringLiteral("p"));
  wait(200);
  pointAt(inView({-60, 0}));
  wait(200);
  press();
  for (int i = 0; i < 20; ++i) pointAt(inView({-60 + 6 * i, 0}));
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.objects[0].paint != nullptr; }, 5000));
  type(kEscape);
  pointAt(inView({60, 30}));
  release();
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.objects[0].paint == nullptr; }, 5000));
  wait(500);
  EXPECT_TRUE(edits().status().edits.empty());
  paintAcross();
  EXPECT_TRUE(editsAre(1));
}

TEST_F(Controls, HistoryShowsWordsAndRoundedUnits) {
  setRow("stiffness", 250);
  ASSERT_TRUE(editsAre(1));
  find<QToolButton>("mode_offset")->click();
  setRow("offset", 1.24);
  ASSERT_TRUE(editsAre(2));
  paintAcross();
  ASSERT_TRUE(editsAre(3));
  find<QDoubleSpinBox>("turn_z")->setValue(30);
  ASSERT_TRUE(editsAre(4));
  QStringList words;
  for (int i = 1; i < find<HistoryPanel>()->count(); ++i)
    words << find<HistoryPanel>()->item(i)->text();
  EXPECT_EQ(words[0], QStringLiteral("Stiffness 250 N/m"));
  EXPECT_EQ(words[1], QStringLiteral("Offset 1.24 mm"));
  EXPECT_TRUE(words[2].contains(QRegExp("^Painted colour, [\\d.]+ mm$"))) << words[2].toStdString();
  EXPECT_EQ(words[3], QStringLiteral("Turn sphere by 30° about z"));
  // The current row's text begins at the same position as the others'.
  auto* list = find<HistoryPanel>();
  list->setCurrentRow(0);
  const auto begins = [&](int row) {
    const QImage line = list->viewport()->grab(list->visualItemRect(list->item(row))).toImage();
    for (int x = 0; x < line.width(); ++x)
      for (int y = 0; y < line.height(); ++y)
        if (line.pixelColor(x, y).lightness() < 120) return x;
    return -1;
  };
  EXPECT_NEAR(begins(0), begins(2), 2);
}

TEST_F(Controls, TitleNamesTheMeshFromTheFirstSecond) {
  const auto path = saved(torus(0.035, 0.015, 400, 200), "torus.obj");
  QString title;
  QObject::connect(find<SceneLoader>(), &SceneLoader::meshReady, window_.get(), [&] {
    QTimer::singleShot(0, window_.get(), [&] { title = window_->windowTitle(); });
  });
  documents().open(requestFor(path));
  ASSERT_TRUE(waitUntil([&] { return !title.isEmpty(); }));
  EXPECT_TRUE(title.startsWith(QStringLiteral("torus.obj"))) << title.toStdString();
}

TEST_F(Controls, DoubleClickPutsABallOnTheSurface) {
  addProperty("Tip radius");
  setRow("tip_radius", 2);
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.haptics.tip_radius == 2e-3; }));
  wait(300);
  doubleClickAt(inView({30, -20}));
  wait(400);
  const ToolSample sample = feel().sample();
  EXPECT_NEAR(sample.tip.norm(), 0.032, 1e-4);
  EXPECT_LT(sample.force.norm(), 0.05);
}

TEST_F(Controls, DoubleClickRestartsOnTheVisibleSide) {
  doubleClickAt(inView({0, 0}));
  wheelAt(inView({0, 0}), 6);
  wait(300);
  ASSERT_GT(feel().sample().force.norm(), 0.5);
  type(QStringLiteral("1")); // from +x
  wait(200);
  doubleClickAt(inView({0, 0}));
  wait(400);
  const ToolSample sample = feel().sample();
  EXPECT_NEAR((sample.vcp - Vec3(0.03, 0, 0)).norm(), 0, 1e-3) << sample.vcp.transpose();
  EXPECT_LT(sample.force.norm(), 0.1);
}

TEST_F(Controls, BallIsNotPushedThroughAThinSheet) {
  ASSERT_TRUE(open(saved(sheet(0.06, 0.06, 30), "sheet.obj")));
  addProperty("Tip radius");
  setRow("tip_radius", 1);
  ASSERT_TRUE(waitUntil([&] { return edits().scene()->scene.haptics.tip_radius == 1e-3; }));
  type(QStringLiteral("5")); // from above
  wait(300);
  doubleClickAt(inView({0, 0}));
  for (int i = 0; i < 40; ++i) wheelAt(inView({0, 0}), 1);
  wait(400);
  const ToolSample sample = feel().sample();
  EXPECT_LT(sample.tip.z(), -5e-3) << "the hand is through";
  EXPECT_GT(sample.vcp.z(), 0.5e-3) << "the ball is not";
  EXPECT_GT(sample.force.z(), 1);
}

TEST_F(Controls, TurnsAMeshWithYUpOnRequestAndRemembersIt) {
  LoadRequest request;
  request.path = saved(box(Vec3(0.02, 0.06, 0.04)), "tall.obj");
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, window_.get(), [&] { ready = true; });
  documents().open(request); // in millimetres the size is implausible
  ASSERT_TRUE(waitUntil([&] { return find<QCheckBox>("y_is_up") != nullptr; }, 10000));
  wait(300);
  EXPECT_FALSE(find<QCheckBox>("y_is_up")->isChecked());
  click(*find<QCheckBox>("y_is_up"));
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return ready; }));
  const Vec3 size = bounds(*edits().scene()->mesh).sizes();
  EXPECT_GT(size.z(), 2.9 * size.x()) << "60 of 20 by 40";
  documents().setInteractive(false);
  window_.reset();
  window_ = std::make_unique<MainWindow>(); // in the next session, too
  window_->show();
  wait(300);
  chooseInMenu(QStringLiteral("&Edit"), QStringLiteral("&Preferences…"));
  ASSERT_TRUE(waitUntil([&] { return find<QCheckBox>("y_up") != nullptr; }, 3000));
  EXPECT_TRUE(find<QCheckBox>("y_up")->isChecked());
}

TEST_F(Controls, FitsATurnedObjectToThePictureOnRequest) {
  ASSERT_TRUE(open(saved(box(Vec3(0.02, 0.02, 0.1)), "rod.obj")));
  type(QStringLiteral("3")); // along y
  type(QStringLiteral("f"));
  find<QDoubleSpinBox>("turn_y")->setValue(90);
  ASSERT_TRUE(editsAre(1));
  wait(300);
  click(view());
  type(QStringLiteral("f"));
  vtkRenderer& renderer = view().view().renderer();
  double left = 1, right = 0;
  for (const Vec3& p : edits().scene()->mesh->positions) {
    renderer.SetWorldPoint(p.x(), p.y(), p.z(), 1);
    renderer.WorldToDisplay();
    const double x = renderer.GetDisplayPoint()[0] / renderer.GetSize()[0];
    left = std::min(left, x);
    right = std::max(right, x);
  }
  EXPECT_GT(left, 0);
  EXPECT_LT(right, 1);
  EXPECT_GT(right - left, 0.5);
}

TEST_F(Controls, PressFollowsTheSurfaceWithConstantForce) {
  trigger("tool_press");
  wait(100);
  setRow("press_force", 0.6);
  drag(inView({-40, 0}), inView({40, 10}), 1, 20);
  pointAt(inView({-40, 0}));
  press();
  for (int i = 0; i < 16; ++i) {
    pointAt(inView({-40 + 5 * i, 0}));
    wait(30);
  }
  wait(200);
  EXPECT_NEAR(feel().sample().force.norm(), 0.6, 0.06);
  wheelAt(inView({40, 0}), 3);
  wait(300);
  EXPECT_NEAR(feel().sample().force.norm(), 0.9, 0.09);
  release();
  wait(300);
  EXPECT_EQ(feel().sample().force.norm(), 0);
  EXPECT_TRUE(edits().status().edits.empty()) << "it paints nothing";
}

} // namespace
} // namespace patina
