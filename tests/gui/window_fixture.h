// A window per test, shown on the test program's own X display.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>

#include <QApplication>
#include <QCheckBox>
#include <QElapsedTimer>
#include <QListWidget>
#include <QMenu>
#include <QMouseEvent>
#include <QSettings>
#include <QTimer>
#include <QToolButton>
#include <QWheelEvent>
#include <gtest/gtest.h>

#include "app/gui/panels/tool_bar.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/window/main_window.h"
#include "geometry/io/mesh_io.h"
#include "support/fresh_folder.h"
#include "support/own_display.h"

namespace patina {

// Qt needs one application a process, made in main's thread and never twice.
inline QApplication& application() {
  static int count = 1;
  static char name[] = "gui_tests";
  static char* words[] = {name, nullptr};
  static QApplication* made = [] {
    setenv("QT_QPA_PLATFORM", "xcb", 0);
    QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
    auto* app = new QApplication(count, words);
    QApplication::setOrganizationName(QStringLiteral("patina-tests"));
    QApplication::setApplicationName(QStringLiteral("patina-tests"));
    applyStyle(*app, Theme::light);
    return app;
  }();
  return *made;
}

// Waits in the window's thread while events are processed. Returns false on time-out. Checks `done`
// after each event, and sleeps in between.
inline bool waitUntil(const std::function<bool()>& done, int milliseconds) {
  QElapsedTimer clock;
  clock.start();
  // processEvents with a time limit returns at once without events, so it would use all CPU time.
  QTimer wake;
  wake.setTimerType(Qt::PreciseTimer);
  wake.start(5);
  while (!done()) {
    if (clock.elapsed() > milliseconds) return false;
    QApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents);
    // The program's event loop deletes what is to be deleted later; processEvents() leaves it.
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
  }
  return true;
}

inline void wait(int milliseconds) {
  waitUntil([] { return false; }, milliseconds);
}

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
    folder_ = test::freshFolder("gui");
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope,
                       QString::fromStdString(folder_.string()));
    application();
    QSettings().clear();
    // Scenes that a window keeps for recovery go to this test's folder, too.
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 0);
    window_ = std::make_unique<MainWindow>();
    window_->resize(1100, 760);
    window_->show();
    wait(50);
    // Most tests move the free tip; tests/gui/first_touch_test.cpp has the window as it opens.
    find<ToolBar>()->choose({InteractionMode::feel, {}});
  }
  void TearDown() override {
    window_.reset();
    if (std::getenv("XDG_STATE_HOME") == (folder_ / "state").string()) unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(folder_);
  }

  static bool waitUntil(const std::function<bool()>& done, int milliseconds = 60000) {
    return patina::waitUntil(done, milliseconds);
  }
  static void wait(int milliseconds) { patina::wait(milliseconds); }

  std::filesystem::path saved(const TriangleMesh& mesh, const std::string& name) const {
    writeMesh(folder_ / name, mesh);
    return folder_ / name;
  }
  // The file is in metres, so that no question about the unit comes up.
  bool open(const std::filesystem::path& path, MeshUnit unit = MeshUnit::m) {
    bool ready = false;
    const auto connection =
        QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
    documents().open(requestFor(path, unit));
    const bool done = waitUntil([&] { return ready; });
    QObject::disconnect(connection);
    wait(80);
    return done;
  }
  static LoadRequest requestFor(const std::filesystem::path& path, MeshUnit unit = MeshUnit::m) {
    LoadRequest request;
    request.path = path;
    request.options.unit = unit;
    request.unit_chosen = true;
    return request;
  }

  // Controllers, which are no widgets. The tests find all else by its name and drive it like a
  // user.
  SaveController& saving() { return window_->controllers().saving; }
  DocumentController& documents() { return window_->controllers().documents; }
  EditController& edits() { return window_->controllers().edits; }
  FeelController& feel() { return window_->controllers().feel; }

  template <typename Widget> Widget* find(const QString& name = {}) {
    return window_->findChild<Widget*>(name);
  }
  void trigger(const QString& name) { find<QAction>(name)->trigger(); }
  // The row of a thing in the list of what is shown.
  QListWidgetItem* rowOf(const QString& thing) {
    auto* list = find<QListWidget>("layers");
    for (int i = 0; i < list->count(); ++i)
      if (list->item(i)->data(Qt::UserRole) == thing) return list->item(i);
    return nullptr;
  }
  bool isShown(const QString& thing) { return rowOf(thing)->checkState() == Qt::Checked; }
  void show(Layer layer, bool on) {
    rowOf(QString::fromStdString(std::string(name(layer))))
        ->setCheckState(on ? Qt::Checked : Qt::Unchecked);
  }
  void openTab(const QString& name) { find<QToolButton>("tab_" + name)->click(); }
  void setRow(const QString& name, double value) { // in the unit of the row
    find<ValueRow>(name)->findChild<QDoubleSpinBox*>()->setValue(value);
  }
  void addProperty(const QString& words) {
    for (QAction* action : find<QMenu>("properties")->actions())
      if (action->text() == words) action->trigger();
  }
  SceneWidget& view() { return *find<SceneWidget>(); }
  double frameSeconds() { return view().view().renderer().GetLastRenderTimeInSeconds(); }
  QPoint middle() { return view().rect().center(); }
  void send(QEvent::Type type, const QPoint& at, Qt::MouseButton button, Qt::MouseButtons held,
            Qt::KeyboardModifiers keys = Qt::NoModifier) {
    QMouseEvent event(type, at, view().mapToGlobal(at), button, held, keys);
    QApplication::sendEvent(&view(), &event);
  }
  void dragFromTo(const QPoint& from, const QPoint& to, Qt::MouseButton button = Qt::LeftButton,
                  Qt::KeyboardModifiers keys = Qt::NoModifier) {
    send(QEvent::MouseButtonPress, from, button, button, keys);
    for (int step = 1; step <= 8; ++step)
      send(QEvent::MouseMove, from + (to - from) * step / 8, Qt::NoButton, button, keys);
    send(QEvent::MouseButtonRelease, to, button, Qt::NoButton, keys);
  }
  void turnWheel(int notches, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    QWheelEvent event(middle(), view().mapToGlobal(middle()), {}, {0, 120 * notches}, Qt::NoButton,
                      keys, Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view(), &event);
  }

  // Keeps the servo's samples from now on.
  void startLog() {
    feel().collect();
    logged_.clear();
    QObject::disconnect(logs_);
    logs_ = QObject::connect(&feel(), &FeelController::collected, [this](const auto& samples) {
      logged_.insert(logged_.end(), samples.begin(), samples.end());
    });
  }
  const std::vector<ToolSample>& logged() {
    feel().collect();
    return logged_;
  }

  // Share of the view's pixels that pass a test of red, green and blue.
  double share(const std::function<bool(int, int, int)>& test) {
    view().frames().refresh();
    const QImage image = view().grabFramebuffer();
    int hits = 0, all = 0;
    for (int y = 0; y < image.height(); y += 2)
      for (int x = image.width() / 7; x < image.width(); x += 2, ++all) {
        const QRgb pixel = image.pixel(x, y);
        if (test(qRed(pixel), qGreen(pixel), qBlue(pixel))) ++hits;
      }
    return static_cast<double>(hits) / std::max(1, all);
  }
  double surfaceShare() {
    return share([](int r, int g, int b) { return g > r + 3 && g > b + 5; });
  }
  double toolShare() {
    return share([](int r, int g, int b) { return r > 150 && r > g + 40 && g > b + 30; });
  }
  double forceShare() {
    return share([](int r, int g, int b) { return r > 120 && g < 70 && b < 100; });
  }

  std::filesystem::path folder_;
  std::unique_ptr<MainWindow> window_;

 private:
  std::vector<ToolSample> logged_;
  QMetaObject::Connection logs_;
};

} // namespace patina
