// Several objects in the window are added, moved and removed while the servo runs.
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QListWidget>
#include <QToolButton>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

class Objects : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(open(saved(icosphere(0.02, 16), "ball.obj")));
  }
  bool rebuiltAfter(const std::function<void()>& edit) {
    bool ready = false;
    const auto connection =
        QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
    edit();
    const bool done = waitUntil([&] { return ready; });
    QObject::disconnect(connection);
    wait(60);
    return done;
  }
  bool add(const char* name) {
    return rebuiltAfter([&] {
      LoadRequest request = requestFor(saved(icosphere(0.02, 16), name));
      request.adds = true;
      documents().open(request);
    });
  }
  QListWidget* list() { return find<QListWidget>("objects"); }
  const std::vector<SceneObject>& objects() { return edits().scene()->scene.objects; }
};

TEST_F(Objects, GetUniqueNamesWhenAdded) {
  ASSERT_TRUE(add("cup.obj"));
  ASSERT_TRUE(add("ball.obj"));
  ASSERT_EQ(objects().size(), 3U);
  EXPECT_EQ(list()->item(1)->text(), QStringLiteral("cup"));
  EXPECT_EQ(list()->item(2)->text(), QStringLiteral("ball-2"));
  EXPECT_TRUE(window_->isWindowModified());
  EXPECT_TRUE(feel().servo().running());
}

TEST_F(Objects, AreTouchedAtTheirNewPose) {
  ASSERT_TRUE(add("cup.obj"));
  list()->setCurrentRow(1);
  ASSERT_TRUE(rebuiltAfter([&] { find<QDoubleSpinBox>("place_x")->setValue(60); }));
  EXPECT_NEAR(objects()[1].world_from_object.translation()[0], 0.06, 1e-12);
  EXPECT_EQ(list()->currentRow(), 1);
  feel().servo().setTarget(Vec3(0.06, 0, 0.03));
  wait(200);
  feel().servo().setTarget(Vec3(0.06, 0, 0.018));
  wait(400);
  EXPECT_TRUE(feel().sample().contact);
  EXPECT_GT(feel().sample().force[2], 0.5);
}

TEST_F(Objects, KeepEditsThatComeDuringAnother) {
  ASSERT_TRUE(add("cup.obj"));
  list()->setCurrentRow(1);
  find<QDoubleSpinBox>("place_x")->setValue(50);
  find<QDoubleSpinBox>("place_y")->setValue(10);
  find<QDoubleSpinBox>("turn_z")->setValue(90);
  ASSERT_TRUE(waitUntil([&] {
    const Pose& pose = objects()[1].world_from_object;
    return (pose.translation() - Vec3(0.05, 0.01, 0)).norm() < 1e-12 &&
           std::abs(pose.linear()(1, 0) - 1) < 1e-12;
  }));
}

TEST_F(Objects, AreRemovedExceptForTheLast) {
  auto* remove = find<QToolButton>("remove_object");
  EXPECT_FALSE(remove->isEnabled());
  ASSERT_TRUE(add("cup.obj"));
  EXPECT_TRUE(remove->isEnabled());
  list()->setCurrentRow(0);
  ASSERT_TRUE(rebuiltAfter([&] { remove->click(); }));
  ASSERT_EQ(objects().size(), 1U);
  EXPECT_EQ(objects()[0].name, "cup");
  EXPECT_FALSE(remove->isEnabled());
}

TEST_F(Objects, OfferDepthToTheUnionIfThereAreSeveral) { // F9
  auto* union_depth = find<QCheckBox>("redistance");
  EXPECT_FALSE(union_depth->isVisibleTo(find<ObjectList>()));
  ASSERT_TRUE(add("cup.obj"));
  EXPECT_TRUE(union_depth->isVisibleTo(find<ObjectList>()));
  ASSERT_TRUE(rebuiltAfter([&] { union_depth->setChecked(true); }));
  EXPECT_TRUE(edits().scene()->scene.redistance);
}

TEST_F(Objects, KeepTheSceneIfAFileCannotBeAdded) {
  bool failed = false;
  QObject::connect(&documents(), &DocumentController::failed, [&] { failed = true; });
  LoadRequest request = requestFor(folder_ / "none.obj");
  request.adds = true;
  documents().open(request);
  ASSERT_TRUE(waitUntil([&] { return failed; }));
  EXPECT_EQ(objects().size(), 1U);
  EXPECT_TRUE(feel().servo().running());
}

} // namespace
} // namespace patina
