// Wheel and keys over the side panel's values.
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QtTest/qtestspontaneevent.h>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

class ValueFields : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
    show(Layer::slice, true);
    show(Layer::iso, true);
    window_->resize(1100, 440); // small enough to scroll
    addProperty("Friction");
    addProperty("Damping");
    window_->activateWindow();
    wait(100);
    view().setFocus();
    scroll_ = find<QScrollArea>("cards");
  }
  QDoubleSpinBox* stiffness() { return find<ValueRow>("stiffness")->findChild<QDoubleSpinBox*>(); }
  static void wheel(QWidget& over, int notches) {
    const QPoint at = over.rect().center();
    QWheelEvent event(at, over.mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton,
                      Qt::NoModifier, Qt::NoScrollPhase, false);
    // The events come from the window system: a program's own event neither gives focus nor goes on
    // to parents.
    QSpontaneKeyEvent::setSpontaneous(&event);
    application().notify(&over, &event);
  }
  static void key(QWidget& to, int code, const QString& text = {}) {
    QKeyEvent press(QEvent::KeyPress, code, Qt::NoModifier, text);
    QApplication::sendEvent(&to, &press);
  }
  void type(const QString& digits) {
    stiffness()->setFocus();
    stiffness()->selectAll();
    for (const QChar& digit : digits) key(*stiffness(), digit.unicode(), QString(digit));
  }
  QScrollArea* scroll_ = nullptr;
};

TEST_F(ValueFields, WheelScrollsThePanelAndChangesNoValue) {
  const auto tried = [this](QWidget* widget, const auto& value) {
    ASSERT_NE(widget, nullptr);
    EXPECT_EQ(widget->focusPolicy(), Qt::StrongFocus);
    scroll_->verticalScrollBar()->setValue(0);
    const auto before = value();
    wheel(*widget, -1);
    EXPECT_EQ(value(), before) << widget->metaObject()->className();
    EXPECT_GT(scroll_->verticalScrollBar()->value(), 0) << widget->metaObject()->className();
  };
  ASSERT_TRUE(waitUntil([&] { return scroll_->verticalScrollBar()->maximum() > 0; }, 5000));
  auto* slider = find<HapticsPanel>()->findChild<QSlider*>();
  auto* position = find<ValueRow>("slice_position")->findChild<QSlider*>();
  tried(stiffness(), [this] { return stiffness()->value(); });
  tried(slider, [=] { return slider->value(); });
  openTab("show");
  find<QListWidget>("layers")->setCurrentItem(rowOf("slice"));
  ASSERT_TRUE(waitUntil([&] { return position->isVisible(); }, 5000));
  find<DisplayPanel>()->setStabilityNote(QStringLiteral("one\ntwo\nthree\nfour\nfive"));
  ASSERT_TRUE(waitUntil([&] { return scroll_->verticalScrollBar()->maximum() > 0; }, 5000));
  tried(position, [=] { return position->value(); });
}

TEST_F(ValueFields, WheelChangesTheEditedValue) {
  stiffness()->setFocus();
  const double before = stiffness()->value();
  wheel(*stiffness(), 1);
  EXPECT_GT(stiffness()->value(), before);
}

TEST_F(ValueFields, EnterAcceptsTheNumberAndFocusesTheView) {
  type(QStringLiteral("432"));
  key(*stiffness(), Qt::Key_Return);
  EXPECT_EQ(QApplication::focusWidget(), &view());
  EXPECT_EQ(find<HapticsPanel>()->values().stiffness, 432);
  key(*stiffness(), Qt::Key_Enter); // leaves an unedited value unchanged
  EXPECT_EQ(find<HapticsPanel>()->values().stiffness, 432);
}

TEST_F(ValueFields, EscapeDiscardsTheTextAndFocusesTheView) {
  const double before = find<HapticsPanel>()->values().stiffness;
  type(QStringLiteral("432"));
  key(*stiffness(), Qt::Key_Escape);
  EXPECT_EQ(QApplication::focusWidget(), &view());
  EXPECT_EQ(find<HapticsPanel>()->values().stiffness, before);
  EXPECT_EQ(stiffness()->value(), before);
}

} // namespace
} // namespace patina
