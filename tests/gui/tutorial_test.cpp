// The first five minutes of the tutorial: clicks, drags and keys that it names come through the
// window system; the menu of properties does not.
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <vtkCamera.h>

#include "gui/driven_window.h"

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
  // Notches until the tip is pressed with more than so many newtons.
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
  keepPicture("touch");
  for (int i = 0; i < 30 && force() > 0; ++i) wheelAt(flank_, -1), wait(100);
  EXPECT_EQ(force(), 0);
}

void Tutorial::stroke() {
  type(QStringLiteral("q"));
  EXPECT_EQ(find<ToolBar>()->choice().handling, Handling::press);
  feel().startLog();
  pointAt(flank_ - QPoint(60, 0));
  press();
  for (int i = 0; i <= 20; ++i) pointAt(flank_ + QPoint(-60 + 6 * i, 0));
  keepPicture("stroke");
  const auto samples = feel().log().samples();
  release();
  std::size_t pressed = 0;
  for (const ToolSample& sample : samples) pressed += sample.force.norm() > 0.2 ? 1 : 0;
  EXPECT_GT(pressed, samples.size() / 2);
  feel().log().clear();
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
  EXPECT_EQ(find<ToolBar>()->choice().handling, Handling::feel);
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
  addProperty("Friction");
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

TEST_F(Tutorial, TheFirstFiveMinutesAsTheyAreWritten) {
  const std::pair<const char*, void (Tutorial::*)()> steps[] = {
      {"start", &Tutorial::start},
      {"touch", &Tutorial::touch},
      {"stroke", &Tutorial::stroke},
      {"soft and hard", &Tutorial::softAndHard},
      {"friction", &Tutorial::friction}};
  for (const auto& [name, step] : steps) {
    SCOPED_TRACE(name);
    (this->*step)();
    ASSERT_FALSE(HasFatalFailure());
  }
}

} // namespace
} // namespace patina
