// Every desk fits at all tested sizes and scales: nothing is cut or overlaps.
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QListWidget>

#include <sys/wait.h>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/control/desk_controller.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"

namespace patina {
namespace {

std::string inLines(const QStringList& list) {
  return ("\n  " + list.join("\n  ")).toStdString();
}

TEST_F(WindowTest, MisfitsFindCutCoveredAndUnlabelledWidgets) {
  QWidget parent;
  parent.resize(300, 100);
  auto* cut = new QLabel(QStringLiteral("a line of some length"), &parent);
  cut->setGeometry(0, 0, 40, 20);
  auto* mute = new QPushButton(QStringLiteral("Zero"), &parent);
  mute->setGeometry(100, 0, 100, 40);
  auto* over = new QLabel(QStringLiteral("x"), &parent);
  over->setGeometry(150, 10, 30, 20);
  auto* number = new QDoubleSpinBox(&parent);
  number->setMaximum(1e6);
  number->setValue(123456);
  number->setGeometry(0, 60, 60, 24);
  auto* beyond = new QLabel(QStringLiteral("y"), &parent);
  beyond->setGeometry(280, 60, 40, 20);
  parent.show();
  wait(20);
  EXPECT_EQ(test::misfits(parent).size(), 4) << inLines(test::misfits(parent));
  EXPECT_EQ(test::muteControls(parent).size(), 2) << inLines(test::muteControls(parent));
  for (QWidget* each : {static_cast<QWidget*>(cut), static_cast<QWidget*>(over),
                        static_cast<QWidget*>(number), static_cast<QWidget*>(beyond)})
    each->hide();
  mute->setToolTip(QStringLiteral("Sets the energy to zero"));
  EXPECT_TRUE(test::misfits(parent).isEmpty());
  EXPECT_TRUE(test::muteControls(parent).isEmpty());
}

class Fit : public DrivenWindow {
 protected:
  // All layers of a scene, with numbers of many digits.
  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.03, 20), "a_sphere_of_a_long_and_winding_name.obj")));
    for (const char* property : {"Friction", "Damping", "Damping cut-off", "Tip radius"}) {
      addProperty(property);
      wait(50);
    }
    find<QToolButton>("mode_magnetic")->click();
    setRow("stiffness", 9999);
    find<QComboBox>("device")->setCurrentIndex(1);
    wait(50);
    find<QToolButton>("device_numbers")->click();
    find<QDoubleSpinBox>("device_rate")->setValue(4000);
    for (const Layer layer : {Layer::slice, Layer::iso, Layer::stability}) show(layer, true);
    find<QDoubleSpinBox>("place_x")->setValue(-12345.67);
    ASSERT_TRUE(waitUntil([&] { return edits().status().edits.size() > 1; }, 30000));
    emit documents().notified(
        {QStringLiteral("The workspace a_sphere_of_a_long_and_winding_name is "
                        "open in another program: edits are not kept in it"),
         true});
    feel().toggleRecording();
    std::vector<PathSample> path(300);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double angle = 0.1 * static_cast<double>(i);
      path[i].t = angle;
      path[i].position = Vec3(0.02 * std::cos(angle), 0.02 * std::sin(angle), 2e-5 * angle);
    }
    window_->findChild<AlignDesk*>()->setPath(
        QStringLiteral("a_path_of_a_long_and_winding_name.csv"), {path, {}});
    find<QPushButton>("align_pick")->click();
    wait(400);
  }
  void checkAll(const std::string& size) {
    DeskController& desks = window_->controllers().desks;
    for (const DeskRow& row : deskRows()) {
      desks.choose(row.desk);
      desks.foldSidePanel(false);
      desks.foldBottomPanel(false);
      const Tab first = row.tab;
      for (const TabRow& tab : tabRows()) {
        auto* button = find<QToolButton>(QStringLiteral("tab_") + tab.name);
        if (!button->isVisible()) continue;
        if (desks.tab() != tab.tab) button->click();
        for (const Panel page :
             {Panel::forces, Panel::energy, Panel::history, Panel::messages, Panel::cost_profile}) {
          if (tab.tab != first && page != Panel::energy) continue;
          desks.open(page);
          wait(60);
          check(size + ' ' + row.name + ' ' + tab.name + ' ' +
                std::to_string(static_cast<int>(page)));
        }
        if (row.desk != Desk::paint || tab.tab != Tab::tool) continue;
        for (const ToolCard& card : toolCards()) {
          find<ToolBar>()->choose(card.choice);
          wait(60);
          check(size + " tool " + card.name);
        }
        find<ToolBar>()->choose({InteractionMode::paint, Tool::color});
      }
      if (const char* folder = std::getenv("PATINA_PICTURES"))
        window_->grab().save(
            QStringLiteral("%1/%2_%3.png")
                .arg(QString::fromUtf8(folder), QString::fromStdString(size), row.name));
      desks.foldSidePanel(true);
      desks.foldBottomPanel(true);
      wait(60);
      check(size + ' ' + row.name + " folded");
    }
  }
  void check(const std::string& where) {
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    const QStringList cut = test::misfits(*window_), mute = test::muteControls(*window_);
    EXPECT_TRUE(cut.isEmpty()) << where << inLines(cut);
    EXPECT_TRUE(mute.isEmpty()) << where << " says nothing:" << inLines(mute);
  }
};

TEST_F(Fit, EveryDeskAtEverySize) {
  for (const QSize& size : {QSize(1024, 700), QSize(1280, 800), QSize(1920, 1080)}) {
    takeSize(size.width(), size.height());
    checkAll(std::to_string(size.width()) + 'x' + std::to_string(size.height()));
  }
}

TEST_F(Fit, EveryDeskInTheDarkTheme) {
  applyStyle(application(), Theme::dark);
  takeSize(1024, 700);
  checkAll("dark");
  applyStyle(application(), Theme::light);
}

// This runs in a program of its own, with a scale of two and a screen of 3840 x 2160.
TEST_F(Fit, DISABLED_EveryDeskAtTwice) {
  ASSERT_EQ(window_->devicePixelRatioF(), 2);
  takeSize(1280, 760);
  checkAll("twice");
  takeSize(1920, 1040); // its frame fills the screen
  checkAll("4k");
}

TEST(FitAtTwice, EveryDesk) {
  if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  const pid_t child = fork();
  if (child == 0) {
    setenv("QT_SCALE_FACTOR", "2", 1);
    setenv("PATINA_SCREEN", "3840x2160x24", 1);
    execl("/proc/self/exe", "gui_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=Fit.DISABLED_EveryDeskAtTwice", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "what it printed is above";
}

} // namespace
} // namespace patina
