// The tutorial as a test: every click, drag and key that it names comes through the window system,
// and its commands run as printed.
#include <fstream>
#include <sstream>

#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QRadioButton>
#include <vtkCamera.h>

#include "app/gui/panels/object_panel.h"
#include "core/csv.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/places.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

class Tutorial : public DrivenWindow {
 protected:
  const HapticProperties& haptics() { return edits().scene()->scene.haptics; }
  double force() { return feel().sample().force.norm(); }
  void keepPicture(const char* name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/tutorial_%2.png").arg(folder, name));
  }
  void typeInto(const char* row, const QString& number) {
    auto* line = find<ValueRow>(row)->findChild<QDoubleSpinBox*>()->findChild<QLineEdit*>();
    click(*line);
    type('a', kControl);
    type(number);
    type(kEnter);
  }
  template <typename Done> bool soon(Done done) { return waitUntil(done, 20000); }
  // Turns the wheel until the tip is pressed with more than so many newtons.
  void pressIn(double newtons) {
    for (int i = 0; i < 30 && force() < newtons; ++i) {
      wheelAt(flank_, 1);
      wait(150);
    }
  }

  QPoint flank_;

 public:
  void start();
  void touch();
  void stroke();
  void softAndHard();
  void friction();
  void lookInside();
  void ownMesh();
  void takeHome();
  void commands();
};

void Tutorial::start() {
  documents().open({});
  ASSERT_TRUE(waitUntil([&] { return feel().servo().running(); }, 120000));
  wait(500);
  EXPECT_FALSE(find<LoadBar>()->isVisible());
  EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("Toy dinosaur")));
  EXPECT_GT(toolShare(), 0);
  keepPicture("start");
}

void Tutorial::touch() {
  flank_ = inView({0, 0});
  // A window begins with this tool, but this fixture with another one.
  find<ToolBar>()->choose({InteractionMode::press, {}});
  pointAt(flank_ - QPoint(20, 0));
  press();
  for (int i = 0; i <= 10; ++i) pointAt(flank_ + QPoint(4 * i - 20, 0));
  EXPECT_GT(force(), 0.2);
  release();
  type(QStringLiteral("v"));
  doubleClickAt(flank_);
  wait(300);
  EXPECT_LT(force(), 0.2);
  clickOn("page_forces");
  pressIn(0.5);
  wait(300);
  const ToolSample sample = feel().sample();
  EXPECT_TRUE(sample.contact);
  EXPECT_GT(sample.depth, 5e-4);
  EXPECT_GT((sample.vcp - sample.tip).norm(), 5e-4) << "the ghost is inside, the tool is not";
  EXPECT_GT(forceShare(), 0);
  EXPECT_TRUE(find<ForcePlot>()->isVisible());
  keepPicture("window");
  for (int i = 0; i < 30 && force() > 0; ++i) wheelAt(flank_, -1), wait(100);
  EXPECT_EQ(force(), 0);
}

void Tutorial::stroke() {
  type(QStringLiteral("q"));
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::press);
  startLog();
  pointAt(flank_ - QPoint(60, 0));
  press();
  for (int i = 0; i <= 20; ++i) pointAt(flank_ + QPoint(-60 + 6 * i, 0));
  keepPicture("feel");
  const auto samples = logged();
  release();
  std::size_t pressed = 0;
  double most = 0;
  for (const ToolSample& sample : samples) {
    pressed += sample.force.norm() > 0.2 ? 1 : 0;
    most = std::max(most, sample.force.norm());
  }
  EXPECT_LT(most, 1.6) << "0.8 N are set, and a stroke begins on the surface";
  EXPECT_GT(pressed, samples.size() / 2);
  const auto eye = [this] {
    return Vec3(view().view().renderer().GetActiveCamera()->GetPosition());
  };
  const Vec3 before = eye();
  hand_->key(kShift, true);
  drag(flank_, flank_ + QPoint(80, 0), 1, 4);
  hand_->key(kShift, false);
  EXPECT_GT((eye() - before).norm(), 1e-3);
  type(QStringLiteral("7")); // back, and fitted
  type(QStringLiteral("f"));
  type(QStringLiteral("v"));
  EXPECT_EQ(find<ToolBar>()->choice().handling, InteractionMode::feel);
  wait(200);
}

void Tutorial::softAndHard() {
  doubleClickAt(flank_);
  pressIn(0.6);
  wait(300);
  const double before = force();
  typeInto("stiffness", QStringLiteral("100"));
  ASSERT_TRUE(soon([&] { return haptics().stiffness == 100; }));
  wait(400);
  EXPECT_NEAR(force(), 0.2 * before, 0.05 * before);
  typeInto("stiffness", QStringLiteral("2000"));
  ASSERT_TRUE(soon([&] { return haptics().stiffness == 2000; }));
  pressIn(3.25);
  wait(400);
  EXPECT_NEAR(force(), haptics().force_limit, 0.05);
  typeInto("stiffness", QStringLiteral("500"));
  ASSERT_TRUE(soon([&] { return haptics().stiffness == 500; }));
}

void Tutorial::friction() {
  clickOn("add_property");
  choose(*find<QMenu>("properties"), "Friction");
  ASSERT_TRUE(soon([&] { return haptics().friction.has_value(); }));
  EXPECT_TRUE(soon([&] { return find<QLabel>("stages")->text().contains("friction"); }));
  typeInto("friction_static", QStringLiteral("1"));
  typeInto("friction_dynamic", QStringLiteral("0.1"));
  ASSERT_TRUE(soon([&] { return haptics().friction->static_coefficient == 1; }));
  doubleClickAt(flank_);
  pressIn(0.8);
  const Vec3 held = feel().sample().vcp;
  drag(flank_, flank_ + QPoint(3, 0), 1, 3);
  wait(300);
  const ToolSample sample = feel().sample();
  EXPECT_LT((sample.vcp - held).norm(), 3e-3) << "it sticks";
  for (auto* button : find<ValueRow>("friction_static")->findChildren<QToolButton*>())
    if (button->isVisible()) {
      click(*button);
      break;
    }
  EXPECT_TRUE(soon([&] { return !haptics().friction.has_value(); }));
}

void Tutorial::lookInside() {
  clickAction("desk_analyse");
  type(QStringLiteral("7"));
  const auto pictures = [this] { return view().grabFramebuffer(); };
  const auto tick = [this](const char* name) {
    clickRow(name);
    EXPECT_TRUE(isShown(name)) << name;
    wait(500);
  };
  tick("slice");
  tick("iso");
  typeInto("iso_value", QStringLiteral("1.5"));
  EXPECT_EQ(find<ValueRow>("iso_value")->value(), 1.5);
  type(QStringLiteral("f"));
  wait(500);
  keepPicture("slice");
  clickRow("slice", true);
  const QImage before = pictures();
  auto* slider = find<ValueRow>("slice_position")->findChild<QSlider*>();
  const QPoint grip = slider->mapToGlobal(slider->rect().center());
  drag(grip, grip + QPoint(30, 0));
  EXPECT_NE(find<ValueRow>("slice_position")->value(), 50);
  wait(500);
  EXPECT_NE(pictures(), before);
  for (const char* name : {"slice", "iso"}) {
    clickRow(name);
    EXPECT_FALSE(isShown(name)) << name;
  }
  doubleClickAt(flank_);
  pressIn(0.5);
  tick("nodes");
  tick("wireframe");
  keepPicture("nodes");
}

void Tutorial::ownMesh() {
  type('4', kControl);
  TriangleMesh mesh = icosphere(30, 40);
  mesh.triangles.resize(mesh.triangles.size() - 100); // a hole
  const auto path = saved(mesh, "own.obj");
  answerWithPath(path);
  whenAsked<QMessageBox>([this](QMessageBox& box) { click(*box.button(QMessageBox::Discard)); });
  bool ready = false;
  const auto connection =
      QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  type('o', kControl);
  ASSERT_TRUE(soon([&] { return ready; }));
  QObject::disconnect(connection);
  wait(500); // the window's layout needs time
  clickOn("tab_object");
  EXPECT_TRUE(soon([&] { return find<ObjectPanel>()->isVisible(); }));
  bool defect = false;
  for (const auto* label : find<ObjectPanel>()->findChildren<QLabel*>())
    defect = defect || label->text() == QStringLiteral("Boundary edges");
  EXPECT_TRUE(defect);
  doubleClickAt(flank_);
  pressIn(0.4);
  EXPECT_GT(force(), 0.4);
}

void Tutorial::takeHome() {
  type('r', kControl);
  EXPECT_TRUE(feel().recording());
  type(QStringLiteral("q"));
  drag(flank_, flank_ + QPoint(60, 0), 1, 40);
  answerWithPath(folder_ / "feel.csv");
  type('r', kControl);
  ASSERT_TRUE(soon([&] { return std::filesystem::exists(folder_ / "feel.csv"); }));
  EXPECT_FALSE(feel().recording());
  answerWithPath(folder_ / "scene.patina");
  type('s', kControl);
  ASSERT_TRUE(soon([&] { return isWorkspace(folder_ / "scene.patina"); }));
  wait(300);
  EXPECT_TRUE(window_->windowTitle().startsWith(QStringLiteral("scene.patina")));
}

// Returns all indented lines of the tutorial except the first, which starts the window.
std::string commandsOfTutorial() {
  std::ifstream text(test::sourceFolder() / "docs/tutorial.md");
  std::string all;
  for (std::string line; std::getline(text, line);)
    if (line.starts_with("    ") && line.find("run.sh") == std::string::npos)
      all += line.substr(4) + "\n";
  return all;
}

void Tutorial::commands() {
  documents().setInteractive(false);
  ASSERT_TRUE(window_->close());
  window_.reset(); // the program ends with it
  std::filesystem::create_directory_symlink(test::programFolder().parent_path(), folder_ / "build");
  std::ofstream(folder_ / "commands.sh") << commandsOfTutorial();
  const std::string run = "cd '" + folder_.string() + "' && sh -e commands.sh > said.txt 2>&1";
  const int code = std::system(run.c_str());
  std::ostringstream notified;
  notified << std::ifstream(folder_ / "said.txt").rdbuf();
  EXPECT_EQ(code, 0) << notified.str();
  EXPECT_GT(readCsv(folder_ / "forces.csv", {"t [s]"}).rows.size(), 100U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "picture.png"));
  EXPECT_EQ(loadWorkspace(folder_ / "scene.patina").objects[0].paint, nullptr) << "it is undone";
}

TEST_F(Tutorial, EachStepWorksAsWritten) {
  const std::pair<const char*, void (Tutorial::*)()> steps[] = {
      {"start", &Tutorial::start},
      {"touch", &Tutorial::touch},
      {"stroke", &Tutorial::stroke},
      {"soft and hard", &Tutorial::softAndHard},
      {"friction", &Tutorial::friction},
      {"look inside", &Tutorial::lookInside},
      {"own mesh", &Tutorial::ownMesh},
      {"take it home", &Tutorial::takeHome},
      {"without a hand", &Tutorial::commands}};
  for (const auto& [name, step] : steps) {
    SCOPED_TRACE(name);
    (this->*step)();
    ASSERT_FALSE(HasFatalFailure());
  }
}

} // namespace
} // namespace patina
