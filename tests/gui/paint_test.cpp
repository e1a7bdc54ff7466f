// Painting in the window: one gesture feels and paints, and every step can be taken back.
#include <cmath>
#include <utility>

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QTabletEvent>
#include <QToolButton>

#include "core/run_queue_wait.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "support/least_time.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;

class Painting : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(kRadius, 30), "sphere.obj")));
    window_->activateWindow();
    view().setFocus();
  }
  QAction* action(const char* name) {
    return window_->findChild<QAction*>(QString::fromUtf8(name));
  }
  void choose(Tool tool) {
    window_->tools().choose({Handling::paint, tool});
    wait(100);
  }
  // As a hand does it: down, along, up, with the time that it takes.
  void stroke(const QPoint& from, const QPoint& to, int milliseconds = 400) {
    send(QEvent::MouseMove, from, Qt::NoButton, Qt::NoButton);
    wait(150);
    send(QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    const int steps = milliseconds / 16;
    for (int i = 1; i <= steps; ++i) {
      wait(16);
      send(QEvent::MouseMove, from + (to - from) * i / steps, Qt::NoButton, Qt::LeftButton);
    }
    send(QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
  }
  bool strokeDone(std::size_t edits) {
    return waitUntil([&] { return window_->standing().edits.size() == edits; }, 20000);
  }
  const ObjectPaint* paint() { return window_->scene()->scene.objects[0].paint.get(); }
  void key(int code, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    for (QAction* each : window_->findChildren<QAction*>())
      for (const QKeySequence& sequence : each->shortcuts())
        if (sequence == QKeySequence(static_cast<int>(keys) | code)) return each->trigger();
    FAIL() << "no action has the key "
           << QKeySequence(static_cast<int>(keys) | code).toString().toStdString();
  }
  double redShare() {
    return share([](int r, int g, int b) { return r > 90 && r > 1.7 * g && r > 1.7 * b; });
  }
};

TEST_F(Painting, NothingToPaintWithIsThereBeforeItIsNeeded) {
  EXPECT_FALSE(window_->brushPanel().isVisible());
  EXPECT_FALSE(window_->relief().isVisible());
  EXPECT_FALSE(window_->history().isVisible());
  EXPECT_FALSE(window_->paintDisplay().isVisible());
  choose(Tool::material(MaterialChannel::stiffness));
  EXPECT_TRUE(window_->brushPanel().isVisible());
  EXPECT_FALSE(window_->relief().isVisible());
  choose(Tool::relief);
  EXPECT_TRUE(window_->relief().isVisible());
  window_->setMode(SceneWidget::Mode::feel);
  EXPECT_FALSE(window_->brushPanel().isVisible());
  EXPECT_FALSE(window_->relief().isVisible());
  EXPECT_FALSE(window_->history().isVisible());
}

TEST_F(Painting, AStrokeIsSeenIsOneEditAndIsUndoneAndDoneAgain) {
  choose(Tool::color);
  window_->display().setShown(Layer::tip, false); // the tool is warm too
  const double before = redShare();
  stroke(middle() - QPoint(60, 0), middle() + QPoint(60, 0));
  ASSERT_TRUE(strokeDone(1));
  wait(150);
  ASSERT_NE(paint(), nullptr);
  EXPECT_TRUE(paint()->color);
  EXPECT_FALSE(paint()->material) << "what was not painted is not there";
  EXPECT_TRUE(window_->history().isVisible());
  EXPECT_TRUE(window_->isWindowModified());
  send(QEvent::MouseMove, QPoint(5, 5), Qt::NoButton, Qt::NoButton); // the cursor is red as well
  wait(100);
  EXPECT_GT(redShare(), before + 0.005);
  key(Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(waitUntil([&] { return window_->standing().done == 0; }));
  wait(100);
  EXPECT_NEAR(redShare(), before, 0.001);
  key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  ASSERT_TRUE(waitUntil([&] { return window_->standing().done == 1; }));
  wait(100);
  EXPECT_GT(redShare(), before + 0.005);
}

TEST_F(Painting, PaintingAndFeelingAreOneGesture) {
  choose(Tool::material(MaterialChannel::stiffness));
  const double base = window_->scene()->scene.haptics.stiffness;
  Brush brush = window_->desk().brush();
  brush.value = 4 * base;
  brush.radius = 0.006;
  brush.falloff = 16;
  window_->desk().setBrush(brush);
  window_->startRecording();
  stroke(middle() - QPoint(40, 0), middle() + QPoint(40, 0), 600);
  ASSERT_TRUE(strokeDone(1));
  const auto felt = window_->takeRecording();
  // Force on the hand while it painted, and harder than the bare surface at the same depth.
  double most = 0, stiffest = 0;
  for (const ToolSample& tick : felt) {
    if (!tick.contact || tick.depth < 2e-4) continue;
    most = std::max(most, tick.force.norm());
    stiffest = std::max(stiffest, tick.force.norm() / tick.depth);
  }
  EXPECT_GT(most, 0.3);
  EXPECT_GT(stiffest, 2 * base);
  ASSERT_TRUE(paint() && paint()->material);
  EXPECT_TRUE(paint()->material->has(MaterialChannel::stiffness));
}

TEST_F(Painting, AQuickClickPaintsToo) {
  choose(Tool::color);
  send(QEvent::MouseMove, middle(), Qt::NoButton, Qt::NoButton);
  Vec3 tip = Vec3::Constant(NAN);
  ASSERT_TRUE(waitUntil([&] { // the tip hovers there
    wait(50);
    const Vec3 before = std::exchange(tip, window_->lastSample().tip);
    return (tip - before).norm() < 1e-5 && tip.norm() > kRadius && tip.norm() < 1.1 * kRadius;
  }));
  send(QEvent::MouseButtonPress, middle(), Qt::LeftButton, Qt::LeftButton);
  send(QEvent::MouseButtonRelease, middle(), Qt::LeftButton, Qt::NoButton);
  EXPECT_TRUE(strokeDone(1));
}

TEST_F(Painting, BesideTheObjectNothingIsPainted) {
  choose(Tool::color);
  stroke(QPoint(20, 20), QPoint(60, 30), 200);
  wait(400);
  EXPECT_TRUE(window_->standing().edits.empty());
}

TEST_F(Painting, LayersThatAreTickedArePaintedByTheSameStroke) {
  choose(Tool::material(MaterialChannel::stiffness));
  for (const char* name : {"also_color", "also_friction.static"}) {
    ASSERT_NE(action(name), nullptr) << name;
    action(name)->trigger();
  }
  EXPECT_EQ(action("also_stiffness"), nullptr); // that is what the tool paints anyway
  EXPECT_EQ(layersOf(window_->desk().brush()).size(), 3U);
  stroke(middle(), middle() + QPoint(40, 0));
  ASSERT_TRUE(strokeDone(1));
  ASSERT_NE(paint(), nullptr);
  EXPECT_TRUE(paint()->color);
  EXPECT_FALSE(paint()->relief);
  EXPECT_TRUE(paint()->material->has(MaterialChannel::stiffness));
  EXPECT_TRUE(paint()->material->has(MaterialChannel::static_friction));
  // Another tool keeps the ticks, and its own layer is no second one.
  choose(Tool::color);
  EXPECT_EQ(layersOf(window_->desk().brush()).size(), 2U);
  choose(Tool::erase);
  EXPECT_EQ(layersOf(window_->desk().brush()).size(), 1U);
}

TEST_F(Painting, AClickInTheHistoryGoesThere) {
  choose(Tool::color);
  stroke(middle() - QPoint(50, 30), middle() + QPoint(50, -30), 200);
  ASSERT_TRUE(strokeDone(1));
  choose(Tool::material(MaterialChannel::static_friction));
  stroke(middle() - QPoint(50, -30), middle() + QPoint(50, 30), 200);
  ASSERT_TRUE(strokeDone(2));
  ASSERT_EQ(window_->history().count(), 3);
  EXPECT_EQ(window_->history().currentRow(), 2);
  emit window_->history().itemClicked(window_->history().item(0));
  ASSERT_TRUE(waitUntil([&] { return window_->standing().done == 0; }));
  EXPECT_EQ(paint(), nullptr);
  EXPECT_EQ(window_->history().currentRow(), 0);
  emit window_->history().itemClicked(window_->history().item(1));
  ASSERT_TRUE(waitUntil([&] { return window_->standing().done == 1; }));
  ASSERT_NE(paint(), nullptr);
  EXPECT_TRUE(paint()->color && !paint()->material);
}

TEST_F(Painting, KeysChooseToolsAndTheBrushesSize) {
  for (const ToolCard& card : toolCards()) {
    key(card.key);
    if (card.choice.handling == Handling::pick) continue;
    EXPECT_TRUE(window_->tools().choice() == card.choice) << card.words.toStdString();
  }
  key(Qt::Key_P);
  const Brush before = window_->desk().brush();
  key(Qt::Key_BracketRight);
  EXPECT_NEAR(window_->desk().brush().radius, 1.15 * before.radius, 1e-9);
  key(Qt::Key_BracketLeft);
  key(Qt::Key_BracketLeft, Qt::ShiftModifier);
  EXPECT_NEAR(window_->desk().brush().radius, before.radius, 1e-9);
  EXPECT_NEAR(window_->desk().brush().falloff, before.falloff / 1.15, 1e-9);
  key(Qt::Key_Space);
  EXPECT_EQ(window_->tools().choice().handling, Handling::navigate);
  key(Qt::Key_Space);
  EXPECT_TRUE(window_->tools().choice() == (ToolChoice{Handling::paint, Tool::color}));
}

TEST_F(Painting, TheEyedropperTakesWhatIsThereAndGivesTheBrushBack) {
  choose(Tool::material(MaterialChannel::stiffness));
  Brush brush = window_->desk().brush();
  brush.value = 2345;
  brush.radius = 0.008;
  brush.falloff = 16;
  window_->desk().setBrush(brush);
  stroke(middle(), middle() + QPoint(4, 0), 300);
  ASSERT_TRUE(strokeDone(1));
  brush.value = 10;
  window_->desk().setBrush(brush);
  send(QEvent::MouseButtonPress, middle() + QPoint(2, 0), Qt::LeftButton, Qt::LeftButton,
       Qt::AltModifier);
  send(QEvent::MouseButtonRelease, middle(), Qt::LeftButton, Qt::NoButton, Qt::AltModifier);
  EXPECT_NEAR(window_->desk().brush().value, 2345, 25);
  window_->tools().choose({Handling::pick, {}});
  brush.value = 10;
  window_->desk().setBrush(brush);
  send(QEvent::MouseButtonPress, middle() + QPoint(2, 0), Qt::LeftButton, Qt::LeftButton);
  EXPECT_NEAR(window_->desk().brush().value, 2345, 25);
  EXPECT_TRUE(window_->tools().choice() ==
              (ToolChoice{Handling::paint, Tool::material(MaterialChannel::stiffness)}));
  send(QEvent::MouseMove, middle(), Qt::NoButton, Qt::NoButton);
  ASSERT_TRUE(waitUntil(
      [&] { return window_->status().pickedText().contains(QStringLiteral("N/m")); }, 3000));
  EXPECT_TRUE(window_->status().pickedText().contains(QRegExp("23[234]\\d N/m")))
      << window_->status().pickedText().toStdString();
}

TEST_F(Painting, APensPressureIsForceAndMakesTheBrushLarger) { // K19
  choose(Tool::material(MaterialChannel::stiffness));
  Brush brush = window_->desk().brush();
  brush.radius = 0.002;
  brush.radius_per_force = 0.006;
  brush.falloff = 16;
  window_->desk().setBrush(brush);
  const auto pen = [&](QEvent::Type type, const QPoint& at, double pressure) {
    QTabletEvent event(type, at, view().mapToGlobal(at), QTabletEvent::Stylus, QTabletEvent::Pen,
                       pressure, 0, 0, 0, 0, 0, Qt::NoModifier, 1, Qt::LeftButton,
                       type == QEvent::TabletRelease ? Qt::NoButton : Qt::LeftButton);
    QApplication::sendEvent(&view(), &event);
  };
  const auto blocksAfter = [&](double pressure, std::size_t edits) {
    pen(QEvent::TabletMove, middle(), 0);
    wait(150);
    pen(QEvent::TabletPress, middle(), pressure);
    for (int i = 0; i < 15; ++i) {
      wait(16);
      pen(QEvent::TabletMove, middle() + QPoint(i / 8, 0), pressure);
    }
    pen(QEvent::TabletRelease, middle(), 0);
    EXPECT_TRUE(strokeDone(edits));
    std::size_t nodes = 0;
    if (paint() && paint()->material)
      for (const auto& [index, block] : paint()->material->blocks())
        if (const auto* layer = paint()->material->layer(index, MaterialChannel::stiffness))
          for (const float weight : layer->weight) nodes += weight > 0.5F ? 1 : 0;
    return nodes;
  };
  const std::size_t light = blocksAfter(0.2, 1);
  key(Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(waitUntil([&] { return window_->standing().done == 0; }));
  const std::size_t hard = blocksAfter(1.0, 1);
  EXPECT_GT(light, 0u);
  EXPECT_GT(hard, 3 * light);
}

TEST_F(Painting, WhatIsShownFollowsTheToolUntilSomethingElseIsChosen) {
  choose(Tool::color);
  stroke(middle() - QPoint(40, 20), middle() + QPoint(40, -20), 200);
  ASSERT_TRUE(strokeDone(1));
  choose(Tool::material(MaterialChannel::stiffness));
  stroke(middle() - QPoint(40, -20), middle() + QPoint(40, 20), 200);
  ASSERT_TRUE(strokeDone(2));
  wait(100);
  auto* combo = window_->findChild<QComboBox*>(QStringLiteral("paint_shown"));
  EXPECT_EQ(combo->count(), 4) << "as the tool, nothing, colour, stiffness";
  EXPECT_EQ(window_->paintDisplay().shown(), quantityOf(MaterialChannel::stiffness));
  choose(Tool::color);
  EXPECT_EQ(window_->paintDisplay().shown(), PaintQuantity::color);
  window_->paintDisplay().choose(quantityOf(MaterialChannel::stiffness));
  choose(Tool::relief);
  EXPECT_EQ(window_->paintDisplay().shown(), quantityOf(MaterialChannel::stiffness));
  // The range can be held.
  auto* lock = window_->findChild<QCheckBox*>(QStringLiteral("lock_range"));
  lock->setChecked(true);
  window_->findChild<QDoubleSpinBox*>(QStringLiteral("range_low"))->setValue(100);
  window_->findChild<QDoubleSpinBox*>(QStringLiteral("range_high"))->setValue(4000);
  wait(100);
  const ValueRange range = view().view().paintRange(quantityOf(MaterialChannel::stiffness));
  EXPECT_EQ(range.low, 100);
  EXPECT_EQ(range.high, 4000);
  window_->paintDisplay().choose(std::nullopt);
  EXPECT_FALSE(window_->paintDisplay().shown().has_value());
}

TEST_F(Painting, ReliefSaysHowHighItMayBe) { // F7
  window_->display().setShown(Layer::tip, false);
  choose(Tool::relief);
  stroke(middle() - QPoint(40, 0), middle() + QPoint(40, 0), 300);
  ASSERT_TRUE(strokeDone(1));
  auto* note = window_->findChild<QLabel*>(QStringLiteral("relief_note"));
  ASSERT_TRUE(waitUntil([&] { return note->isVisible(); }, 10000));
  EXPECT_TRUE(note->text().contains(QStringLiteral("mm"))) << note->text().toStdString();
  window_->setMode(SceneWidget::Mode::feel);
  EXPECT_TRUE(window_->relief().isVisible()) << "the scene has relief";
  auto* inverted = window_->findChild<QCheckBox*>(QStringLiteral("relief_inverted"));
  inverted->setChecked(true);
  ASSERT_TRUE(waitUntil([&] { return window_->scene()->scene.relief.height < 0; }));
  ASSERT_TRUE(strokeDone(2));
}

TEST_F(Painting, TheWindowGoesOnWhileAnEditIsUnderWay) {
  choose(Tool::material(MaterialChannel::stiffness));
  QElapsedTimer clock;
  const RunQueueWait queue; // what other programs take of the processor is not the window's
  // Its work by its own processor time, its waiting by what the edit takes beside it: both of them
  // hold on a machine that does other things.
  double longest = 0, most_work = 0, frame = 0, before = 0, worked = 0; // [ms]
  QTimer beat;
  QObject::connect(&beat, &QTimer::timeout, [&] {
    const double now = 1e-6 * static_cast<double>(clock.nsecsElapsed() - queue.total().value_or(0));
    const double work = 1000 * test::threadSeconds();
    if (before != 0) {
      longest = std::max(longest, now - before);
      most_work = std::max(most_work, work - worked);
    }
    frame = std::max(frame, 1000 * view().frameSeconds());
    before = now;
    worked = work;
  });
  // A field of 300 cells takes a second or more.
  bool done = false;
  const auto begin = std::chrono::steady_clock::now();
  window_->edits().apply(
      "finer",
      [](const CompiledScene& now) {
        auto scene = std::make_shared<Scene>(now.scene);
        scene->field.resolution = 300;
        return scene;
      },
      false, [&](const std::string&) { done = true; });
  clock.start();
  beat.start(5);
  ASSERT_TRUE(waitUntil([&] {
    if (done) beat.stop(); // what is shown then is drawing, not waiting
    return done;
  }));
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("edit %.0f ms, longest gap of the window %.0f ms, most work in one %.0f ms, longest "
              "frame %.0f ms\n",
              1000 * took, longest, most_work, frame);
  EXPECT_GT(1000 * took, 5 * longest);
  EXPECT_LT(most_work, 5 * std::max(frame, 40.0)); // frames of software OpenGL
}

TEST_F(Painting, WhatWasSavedOpensAgainWithItsHistory) {
  choose(Tool::color);
  stroke(middle() - QPoint(40, 0), middle() + QPoint(40, 0), 200);
  ASSERT_TRUE(strokeDone(1));
  window_->saveWorkspaceTo(QString::fromStdString((folder_ / "ws").string()));
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("ws")));
  stroke(middle() - QPoint(40, 30), middle() + QPoint(40, -30), 200); // journaled, not saved
  ASSERT_TRUE(strokeDone(2));
  EXPECT_TRUE(window_->isWindowModified());
  window_ = std::make_unique<MainWindow>();
  window_->setAsks(false);
  window_->resize(1100, 760);
  window_->show();
  ASSERT_TRUE(open(folder_ / "ws"));
  EXPECT_EQ(window_->standing().edits.size(), 2u);
  EXPECT_EQ(window_->standing().done, 2u);
  EXPECT_TRUE(window_->standing().unsaved);
  EXPECT_TRUE(paint() && paint()->color);
  bool said = false;
  for (const QLabel* label : window_->findChildren<QLabel*>())
    said = said ||
           (label->isVisible() && label->text().contains(QStringLiteral("after the last save")));
  EXPECT_TRUE(said);
}

} // namespace
} // namespace patina
