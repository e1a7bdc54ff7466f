// A window that is driven like by a user: by pointer and keys of the window system, under a window
// manager.
#pragma once

#include <chrono>
#include <thread>

#include <QAbstractButton>
#include <QAbstractNativeEventFilter>
#include <QFileDialog>
#include <QMenuBar>
#include <QScrollArea>
#include <QToolBar>
#include <QWindow>

#include <xcb/xcb.h>

#include "gui/window_fixture.h"
#include "gui/x_hand.h"

namespace patina {

// Number of the hand's last mark that has reached this program.
class MarkSeen : public QAbstractNativeEventFilter {
 public:
  bool nativeEventFilter(const QByteArray&, void* message, long*) override {
    const auto* event = static_cast<const xcb_client_message_event_t*>(message);
    if ((event->response_type & 0x7f) != XCB_CLIENT_MESSAGE || event->type != test::XHand::kMark)
      return false;
    number = event->data.data32[0];
    return true;
  }
  std::uint32_t number = 0;
};

class DrivenWindow : public WindowTest {
 protected:
  void SetUp() override {
    if (test::hasDisplay()) {
      ASSERT_TRUE(test::hasWindowManager()) << "install openbox";
    }
    WindowTest::SetUp();
    if (IsSkipped()) return;
    hand_ = std::make_unique<test::XHand>();
    ASSERT_TRUE(hand_->works()) << "the X server has no XTEST";
    application().installNativeEventFilter(&seen_);
    takeSize(1280, 800);
  }
  void TearDown() override {
    if (hand_ != nullptr) application().removeNativeEventFilter(&seen_);
    hand_.reset();
    WindowTest::TearDown();
  }

  // The frame is drawn at the screen's corner, so that all of it can be reached.
  void takeSize(int wide, int high) {
    window_->move(0, 0);
    window_->resize(wide, high);
    EXPECT_TRUE(
        waitUntil([&] { return window_->width() == wide && window_->height() == high; }, 3000))
        << window_->width() << " x " << window_->height();
    window_->activateWindow();
    EXPECT_TRUE(waitUntil([&] { return window_->isActiveWindow(); }, 3000));
    wait(100);
  }

  // Waits until all input events have reached the window, however busy the machine is.
  void settle() {
    const std::uint32_t number = ++marks_;
    hand_->mark(static_cast<std::uint32_t>(window_->winId()), number);
    EXPECT_TRUE(waitUntil([&] { return seen_.number >= number; }));
    QApplication::processEvents(); // processes events that came with it
  }
  void pointAt(const QPoint& screen) {
    const double scale = window_->devicePixelRatioF();
    hand_->moveTo(qRound(scale * screen.x()), qRound(scale * screen.y()));
    wait(10); // a hand needs time
    settle();
  }
  void press(int button = 1) { hand_->button(button, true), wait(10), settle(); }
  void release(int button = 1) { hand_->button(button, false), wait(10), settle(); }
  void click(QWidget& widget) {
    ASSERT_TRUE(widget.isVisible()) << widget.objectName().toStdString();
    const bool box = qobject_cast<QCheckBox*>(&widget) != nullptr; // the box and its label
    pointAt(box ? widget.mapToGlobal({8, widget.height() / 2})
                : widget.mapToGlobal(widget.rect().center()));
    press();
    release();
    wait(30);
  }
  void clickOn(const QString& name) {
    auto* widget = find<QAbstractButton>(name);
    ASSERT_NE(widget, nullptr) << name.toStdString();
    click(*widget);
  }
  // Clicks the check of a row in the list of what is shown, or its name.
  void clickRow(const QString& thing, bool on_name = false) {
    auto* list = find<QListWidget>("layers");
    ASSERT_TRUE(list->isVisible());
    for (QWidget* up = list; up != nullptr; up = up->parentWidget())
      if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(list);
    const QRect row = list->visualItemRect(rowOf(thing));
    pointAt(list->viewport()->mapToGlobal(
        {row.left() + (on_name ? row.width() / 2 : 10), row.center().y()}));
    press();
    release();
    wait(30);
  }
  // Clicks an action of the top bar.
  void clickAction(const QString& name) {
    auto* action = find<QAction>(name);
    ASSERT_NE(action, nullptr) << name.toStdString();
    for (QWidget* widget : action->associatedWidgets())
      if (auto* bar = qobject_cast<QToolBar*>(widget)) return click(*bar->widgetForAction(action));
    FAIL() << "no bar has " << name.toStdString();
  }
  // Chooses an entry of an open menu.
  void choose(QMenu& menu, const QString& words) {
    ASSERT_TRUE(waitUntil([&] { return menu.isVisible(); }, 3000));
    wait(200); // the window manager needs time
    for (QAction* action : menu.actions()) {
      if (action->text() != words) continue;
      pointAt(menu.mapToGlobal(menu.actionGeometry(action).center()));
      press(), release();
      return wait(50);
    }
    FAIL() << "the menu has no " << words.toStdString();
  }
  // Chooses an entry of a menu of the window by two clicks.
  void chooseInMenu(const QString& title, const QString& words) {
    QMenuBar& bar = *window_->menuBar();
    for (QAction* entry : bar.actions()) {
      if (entry->text() != title) continue;
      pointAt(bar.mapToGlobal(bar.actionGeometry(entry).center()));
      press(), release();
      return choose(*entry->menu(), words);
    }
    FAIL() << "there is no menu " << title.toStdString();
  }
  // Position in the picture, relative to its centre.
  QPoint inView(const QPoint& from_middle) { return view().mapToGlobal(middle() + from_middle); }
  void doubleClickAt(const QPoint& screen) {
    pointAt(screen);
    wait(200); // widgets under the pointer get the event
    // The clicks come from a thread of their own: drawing between them would split a double click.
    std::thread hand([this] {
      for (int i = 0; i < 4; ++i) {
        hand_->button(1, i % 2 == 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
      }
    });
    wait(250);
    hand.join();
    wait(50);
  }
  void drag(const QPoint& from, const QPoint& to, int button = 1, int steps = 12) {
    pointAt(from);
    press(button);
    for (int i = 1; i <= steps; ++i) pointAt(from + (to - from) * i / steps);
    release(button);
  }
  void wheelAt(const QPoint& screen, int notches) {
    pointAt(screen);
    for (int i = 0; i < std::abs(notches); ++i) {
      for (const bool down : {true, false}) hand_->button(notches > 0 ? 4 : 5, down);
      wait(10);
    }
    settle();
  }
  // A dialog blocks the code that opened it: a timer answers it.
  template <typename Look, typename Act> void whenThere(Look look, Act act) {
    auto* timer = new QTimer(window_.get());
    QObject::connect(timer, &QTimer::timeout, window_.get(), [=] {
      auto* found = look();
      if (found == nullptr || !found->isVisible()) return;
      timer->stop();
      timer->deleteLater();
      wait(300);
      act(*found);
    });
    timer->start(100);
  }
  static constexpr std::uint32_t kEscape = 0xff1b, kEnter = 0xff0d, kTab = 0xff09, kShift = 0xffe1,
                                 kControl = 0xffe3, kF1 = 0xffbe;
  void type(std::uint32_t keysym, std::uint32_t with = 0) {
    if (with != 0) hand_->key(with, true);
    hand_->key(keysym, true);
    hand_->key(keysym, false);
    if (with != 0) hand_->key(with, false);
    settle();
  }
  template <typename Dialog> void whenAsked(std::function<void(Dialog&)> act) {
    whenThere([] { return qobject_cast<Dialog*>(QApplication::activeModalWidget()); },
              std::move(act));
  }
  // Answers the next question for a file.
  void answerWithPath(const std::filesystem::path& path) {
    whenAsked<QFileDialog>([this, text = QString::fromStdString(path.string())](QFileDialog&) {
      type(text);
      type(kEnter);
    });
  }
  void type(const QString& letters) {
    for (const QChar& letter : letters) type(letter.unicode());
  }

  std::unique_ptr<test::XHand> hand_;

 private:
  MarkSeen seen_;
  std::uint32_t marks_ = 0;
};

} // namespace patina
