// The next window offers the edits of a killed one, and opens the readable part of a damaged
// workspace.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <signal.h>
#include <sys/wait.h>

#include <QAbstractButton>
#include <QMessageBox>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class Recovery : public WindowTest {
 protected:
  void paintOne() {
    trigger("tool_color");
    wait(200);
    send(QEvent::MouseMove, middle(), Qt::NoButton, Qt::NoButton);
    wait(200);
    send(QEvent::MouseButtonPress, middle(), Qt::LeftButton, Qt::LeftButton);
    wait(200);
    send(QEvent::MouseButtonRelease, middle(), Qt::LeftButton, Qt::NoButton);
  }
  bool editsDone(std::size_t count) {
    return waitUntil([&] { return edits().status().edits.size() == count; }, 20000);
  }
  std::size_t editsAfterAKillIn(int milliseconds);
  QWidget* bar() { return find<QWidget>("recover_bar"); }
};

// This runs in a program of its own that kills itself in its second stroke.
TEST_F(Recovery, DISABLED_PaintsAndIsKilled) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  paintOne();
  ASSERT_TRUE(editsDone(1));
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.path().filename() != "state") fs::remove_all(entry.path());
  const char* after = std::getenv("PATINA_KILL_AFTER");
  std::thread([wait = after != nullptr ? std::atoi(after) : 0] {
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    kill(getpid(), SIGKILL);
  }).detach();
  for (;;) dragFromTo(middle() - QPoint(50, 20), middle() + QPoint(50, 20)), wait(20);
}

// Returns the edits that are found after `milliseconds` of another stroke.
std::size_t Recovery::editsAfterAKillIn(int milliseconds) {
  const pid_t child = fork();
  if (child == 0) {
    setenv("PATINA_KILL_AFTER", std::to_string(milliseconds).c_str(), 1);
    execl("/proc/self/exe", "gui_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=Recovery.DISABLED_PaintsAndIsKilled", nullptr);
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it was to be killed";
  documents().setInteractive(false);
  window_->controllers().recovery.begin();
  if (!bar()->isVisible()) return 0;
  bool ready = false;
  const auto connection =
      QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  find<QAbstractButton>("recover")->click();
  EXPECT_TRUE(waitUntil([&] { return ready; }));
  wait(300);
  QObject::disconnect(connection);
  const auto& paint = edits().scene()->scene.objects[0].paint;
  EXPECT_TRUE(paint && paint->color);
  return edits().status().edits.size();
}

// A shorter series than in the long form: PATINA_KILLS=50.
TEST_F(Recovery, LosesNoFinishedStrokeIfKilledInOne) {
  const char* asked = std::getenv("PATINA_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 3;
  std::size_t least = 100;
  for (int i = 0; i < kills; ++i) {
    const std::size_t found = editsAfterAKillIn(37 * i % 211);
    EXPECT_GE(found, 1U) << "kill " << i;
    least = std::min(least, found);
  }
  std::printf("%d kills, at least %zu strokes found\n", kills, least);
}

TEST_F(Recovery, OffersAKilledWindowsStrokeInTheNextOne) {
  const pid_t child = fork();
  if (child == 0) {
    execl("/proc/self/exe", "gui_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=Recovery.DISABLED_PaintsAndIsKilled", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was to be killed";

  EXPECT_FALSE(bar()->isVisible());
  window_->controllers().recovery.begin();
  ASSERT_TRUE(bar()->isVisible());
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  find<QAbstractButton>("recover")->click();
  EXPECT_FALSE(bar()->isVisible());
  ASSERT_TRUE(waitUntil([&] { return ready && edits().status().edits.size() == 1; }));
  const auto& paint = edits().scene()->scene.objects[0].paint;
  EXPECT_TRUE(paint && paint->color);
  EXPECT_TRUE(window_->isWindowModified()) << "it has no folder";
  EXPECT_FALSE(edits().status().folder.has_value());
  saving().saveTo(QString::fromStdString((folder_ / "ws").string()));
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_TRUE(fs::is_empty(folder_ / "state" / "patina"));
}

TEST_F(Recovery, OffersNothingAfterACleanEnd) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  paintOne();
  ASSERT_TRUE(editsDone(1));
  EXPECT_FALSE(fs::is_empty(folder_ / "state" / "patina"));
  window_.reset();
  EXPECT_TRUE(fs::is_empty(folder_ / "state" / "patina"));
}

TEST_F(Recovery, CloseAsksAboutUnsavedEditsAndDiscardRestoresTheSavedScene) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  const fs::path ws = folder_ / "ws";
  paintOne();
  ASSERT_TRUE(editsDone(1));
  saving().saveTo(QString::fromStdString(ws.string()));
  paintOne();
  ASSERT_TRUE(editsDone(2));
  int asked = 0;
  const auto answer = [&](QMessageBox::StandardButton button) {
    QTimer::singleShot(300, window_.get(), [this, button, &asked] {
      auto* box = find<QMessageBox>("unsaved_edits");
      if (box == nullptr) return;
      ++asked;
      box->button(button)->click();
    });
  };
  answer(QMessageBox::Cancel);
  EXPECT_FALSE(window_->close());
  EXPECT_TRUE(window_->isVisible());
  EXPECT_EQ(edits().status().done, 2u);
  answer(QMessageBox::Discard);
  EXPECT_TRUE(window_->close());
  EXPECT_EQ(asked, 2);
  window_ = std::make_unique<MainWindow>();
  window_->show();
  ASSERT_TRUE(open(ws));
  EXPECT_EQ(edits().status().done, 1u);
  EXPECT_EQ(edits().status().edits.size(), 1u) << "no edit of the other is left to redo";
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_TRUE(window_->close()) << "nothing to ask about";
}

TEST_F(Recovery, OffersTheReadablePartOfADamagedWorkspace) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 20), "sphere.obj")));
  const fs::path ws = folder_ / "ws";
  saving().saveTo(QString::fromStdString(ws.string()));
  paintOne();
  ASSERT_TRUE(editsDone(1));
  paintOne();
  ASSERT_TRUE(editsDone(2));
  window_ = std::make_unique<MainWindow>();
  documents().setInteractive(false);
  window_->show();
  for (const auto& entry : fs::directory_iterator(ws)) { // damages the first record
    if (entry.path().extension() != ".jsonl") continue;
    std::fstream file(entry.path(), std::ios::in | std::ios::out);
    std::string line;
    std::getline(file, line);
    file.seekp(static_cast<std::streamoff>(line.size() + 40));
    file << "#####";
  }
  QString message;
  QObject::connect(&documents(), &DocumentController::failed,
                   [&](const QString& m) { message = m; });
  documents().open(requestFor(ws));
  ASSERT_TRUE(waitUntil([&] { return !message.isEmpty(); }));
  auto* recover = find<QAbstractButton>("recover_damaged");
  ASSERT_NE(recover, nullptr) << message.toStdString();
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  recover->click();
  ASSERT_TRUE(waitUntil([&] { return ready; }));
  EXPECT_EQ(edits().scene()->scene.objects.size(), 1U);
}

} // namespace
} // namespace patina
