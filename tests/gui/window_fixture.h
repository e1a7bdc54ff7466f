// A window per test, shown on the test program's own X display.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>

#include <QApplication>
#include <QCheckBox>
#include <QMenu>
#include <QMouseEvent>
#include <QSettings>
#include <QToolButton>
#include <QWheelEvent>
#include <gtest/gtest.h>

#include "app/gui/window/main_window.h"
#include "app/gui/window/theme.h"
#include "app/gui/window/wait.h"
#include "geometry/io/mesh_io.h"
#include "support/fresh_folder.h"
#include "support/own_display.h"

namespace patina {

// Qt wants one application a process, made in main's thread and never twice.
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

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
    folder_ = test::freshFolder("gui");
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope,
                       QString::fromStdString(folder_.string()));
    application();
    QSettings().clear();
    // Scenes that a window keeps against a crash are this test's, too.
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 0);
    window_ = std::make_unique<MainWindow>();
    window_->resize(1100, 760);
    window_->show();
    wait(50);
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
  // In metres, so that no question about the unit comes up.
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

  // What is no widget: all else is found by its name, and driven as a person does.
  SaveController& saving() { return window_->controllers().saving; }
  DocumentController& documents() { return window_->controllers().documents; }
  EditController& edits() { return window_->controllers().edits; }
  FeelController& feel() { return window_->controllers().feel; }

  template <typename Widget> Widget* find(const QString& name = {}) {
    return window_->findChild<Widget*>(name);
  }
  void trigger(const QString& name) { find<QAction>(name)->trigger(); }
  void show(Layer layer, bool on) {
    find<QCheckBox>(QString::fromStdString(std::string(name(layer))))->setChecked(on);
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
};

} // namespace patina
