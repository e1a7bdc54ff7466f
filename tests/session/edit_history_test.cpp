// Undo is limited by memory only: dropped scenes are replayed to the same bits.
#include "session/store/edit_history.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "geometry/mesh/shapes.h"
#include "scene/fourier/haptic_texture.h"
#include "support/same_scene.h"

namespace patina {
namespace {

using test::same;

Scene startScene() {
  Scene scene;
  SceneObject& object = scene.objects.emplace_back();
  object.name = "ball";
  object.mesh = std::make_shared<const TriangleMesh>(icosphere(0.05, 3));
  return scene;
}

// Writes one tile, chosen by the stroke, so that most tiles are shared between versions.
Scene painted(const Scene& before, const Stroke& stroke) {
  Scene after = before;
  auto paint = std::make_shared<ObjectPaint>(before.objects[0].paint ? *before.objects[0].paint
                                                                     : ObjectPaint{});
  auto image =
      std::make_shared<TiledImage>(paint->relief ? *paint->relief : TiledImage(256, 256, 1));
  const auto tile = static_cast<std::size_t>(stroke.brush.value) % image->tileCount();
  float* texels = image->writable(tile);
  for (int i = 0; i < kTileSide * kTileSide; ++i)
    texels[i] =
        0.5f * texels[i] + static_cast<float>(stroke.brush.value) + 0.1f * static_cast<float>(i);
  paint->relief = std::move(image);
  after.objects[0].paint = std::move(paint);
  return after;
}

struct Replays {
  std::size_t count = 0;
};

EditHistory::Replay counted(Replays& replays) {
  return [&replays](const Scene& before, const Edit& edit) {
    ++replays.count;
    if (const auto* stroke = std::get_if<Stroke>(&edit)) return painted(before, *stroke);
    Scene after = before;
    const auto* values = std::get_if<ValueEdit>(&edit);
    if (!values) throw std::invalid_argument("no record makes it");
    setValues(after, values->values);
    return after;
  };
}

Stroke stroke(int number, std::size_t samples = 10) {
  Stroke result;
  result.brush.tool = Tool::relief;
  result.brush.value = number;
  result.samples.resize(samples);
  return result;
}

void paint(EditHistory& history, int number) {
  const Stroke one = stroke(number);
  history.append(one, painted(history.scene(), one));
}

constexpr std::size_t kAmple = std::size_t{1} << 30;
constexpr std::size_t kTileBytes = kTileSide * kTileSide * sizeof(float);

class Histories : public testing::Test {
 protected:
  Replays replays;
};

TEST_F(Histories, BeginAtTheGivenSceneWithNothingToUndo) {
  EditHistory history(startScene(), counted(replays), kAmple);
  EXPECT_EQ(history.undoable(), 0U);
  EXPECT_EQ(history.redoable(), 0U);
  EXPECT_FALSE(history.undo());
  EXPECT_FALSE(history.redo());
  EXPECT_TRUE(same(history.scene(), history.start()));
}

TEST_F(Histories, UndoAndRedoWalkThroughEveryScene) {
  EditHistory history(startScene(), counted(replays), kAmple);
  std::vector<Scene> scenes{history.scene()};
  for (int i = 0; i < 40; ++i) {
    paint(history, i);
    scenes.push_back(history.scene());
  }
  EXPECT_FALSE(same(scenes[40], scenes[39])); // the comparison is not empty
  for (std::size_t i = 40; i-- > 0;) {
    ASSERT_TRUE(history.undo());
    ASSERT_TRUE(same(history.scene(), scenes[i])) << i;
    EXPECT_EQ(history.undoable(), i);
    EXPECT_EQ(history.redoable(), 40 - i);
  }
  EXPECT_FALSE(history.undo());
  for (std::size_t i = 1; i <= 40; ++i) {
    ASSERT_TRUE(history.redo());
    ASSERT_TRUE(same(history.scene(), scenes[i])) << i;
  }
  EXPECT_FALSE(history.redo());
  EXPECT_TRUE(history.undo(40));
  EXPECT_TRUE(same(history.scene(), scenes[0]));
  EXPECT_FALSE(history.redo(41));
  EXPECT_TRUE(same(history.scene(), scenes[0]));
  EXPECT_EQ(replays.count, 0U); // all were kept
}

TEST_F(Histories, EditAfterUndoDropsTheRedoSteps) {
  EditHistory history(startScene(), counted(replays), kAmple);
  for (int i = 0; i < 5; ++i) paint(history, i);
  const Scene third = history.sceneAt(3);
  history.undo(2);
  const std::size_t before = history.bytes();
  paint(history, 77);
  EXPECT_EQ(history.redoable(), 0U);
  EXPECT_EQ(history.undoable(), 4U);
  EXPECT_EQ(history.descriptions().size(), 4U);
  EXPECT_EQ(std::get<Stroke>(history.edit(3)).brush.value, 77);
  EXPECT_LE(history.bytes(), before); // two scenes were dropped, one added
  history.undo();
  EXPECT_TRUE(same(history.scene(), third));
}

TEST_F(Histories, UnrecordableEditChangesNothing) {
  EditHistory history(startScene(), counted(replays), kAmple);
  paint(history, 1);
  const Scene first = history.scene();
  paint(history, 2);
  const Scene second = history.scene();
  history.undo();
  const std::size_t bytes = history.bytes();
  const auto refuse = [](const Edit&, std::int64_t) { throw std::runtime_error("disk full"); };
  EXPECT_THROW(history.append(stroke(3), painted(first, stroke(3)), refuse), std::runtime_error);
  EXPECT_EQ(history.undoable(), 1U);
  EXPECT_EQ(history.redoable(), 1U);
  EXPECT_EQ(history.bytes(), bytes);
  EXPECT_TRUE(same(history.scene(), first));
  EXPECT_TRUE(history.redo());
  EXPECT_TRUE(same(history.scene(), second));
}

TEST_F(Histories, BytesEqualTheSumOverAllTiles) {
  EditHistory history(startScene(), counted(replays), kAmple);
  // Tiles that scenes share count once, and tiles that no scene holds do not count.
  paint(history, 0);
  const std::size_t first = history.bytes();
  paint(history, 1); // another tile
  const std::size_t second = history.bytes();
  EXPECT_GE(second - first, kTileBytes);
  EXPECT_LT(second - first, 2 * kTileBytes);
  for (int i = 0; i < 20; ++i) paint(history, 5);
  history.undo(20);
  paint(history, 5);
  EXPECT_NEAR(static_cast<double>(history.bytes() - second), static_cast<double>(second - first),
              64);
}

TEST_F(Histories, ThinningKeepsMemoryBelowTheBudgetAndTheStartBitwise) {
  const Scene start = startScene();
  const std::size_t budget = 200 * kTileBytes; // one scene is 64 of them
  EditHistory history(start, counted(replays), budget);
  std::vector<Scene> some;
  for (int i = 0; i < 3000; ++i) {
    paint(history, 7 * i);
    if (i % 250 == 0) some.push_back(history.scene());
    ASSERT_LE(history.bytes(), budget) << i;
  }
  EXPECT_LT(history.scenes(), 200U);
  EXPECT_EQ(history.undoable(), 3000U);
  for (std::size_t i = 0; i < some.size(); ++i)
    EXPECT_TRUE(same(history.sceneAt(250 * i + 1), some[i])) << i;
  EXPECT_GT(replays.count, 0U);
  ASSERT_TRUE(history.undo(3000));
  EXPECT_TRUE(same(history.scene(), start));
  ASSERT_TRUE(history.redo(1));
  EXPECT_TRUE(same(history.scene(), some[0]));
}

TEST_F(Histories, UndoStaysWithinTheBudget) {
  EditHistory history(startScene(), counted(replays), 100 * kTileBytes);
  for (int i = 0; i < 300; ++i) paint(history, i);
  while (history.undoable() > 0) {
    const std::size_t to = history.undoable() - 1;
    history.setPosition(to, history.sceneAt(to));
    ASSERT_LE(history.bytes(), 100 * kTileBytes) << to;
  }
}

// Undo mostly concerns recent edits: near the present nearly every scene is kept.
TEST_F(Histories, RecentScenesAreKeptLongest) {
  EditHistory history(startScene(), counted(replays), 100 * kTileBytes);
  for (int i = 0; i < 1000; ++i) paint(history, 3 * i);
  replays.count = 0;
  (void)history.sceneAt(998);
  EXPECT_LE(replays.count, 3U);
}

TEST_F(Histories, ScenesWithoutARecordAreNeverDropped) {
  EditHistory history(startScene(), counted(replays), 10 * kTileBytes);
  for (int i = 0; i < 50; ++i) paint(history, i);
  Scene moved = history.scene();
  moved.objects[0].world_from_object.translation() = Vec3(0.1, 0, 0);
  history.append(SceneEdit{"move ball", std::make_shared<const Scene>(moved)}, moved);
  for (int i = 0; i < 200; ++i) paint(history, i);
  EXPECT_TRUE(same(history.sceneAt(51), moved));
  ASSERT_TRUE(history.undo(201));
  EXPECT_TRUE(history.scene().objects[0].world_from_object.matrix().isIdentity(0));
}

TEST_F(Histories, ValueEditsAreReplayedToo) {
  EditHistory history(startScene(), counted(replays), 1); // nothing fits
  for (int i = 1; i <= 20; ++i) {
    const ValueEdit edit{{{"stiffness", std::to_string(100 * i)}}};
    Scene after = history.scene();
    setValues(after, edit.values);
    history.append(edit, after);
    paint(history, i);
  }
  for (std::size_t i = 1; i <= 20; ++i)
    EXPECT_EQ(history.sceneAt(2 * i).haptics.stiffness, 100.0 * static_cast<double>(i));
}

TEST_F(Histories, FailedReplayKeepsThePosition) {
  EditHistory history(
      startScene(), [](const Scene&, const Edit&) -> Scene { throw std::runtime_error("no"); }, 1);
  for (int i = 0; i < 3; ++i) paint(history, i);
  const Scene present = history.scene();
  EXPECT_THROW(history.undo(), std::runtime_error);
  EXPECT_EQ(history.undoable(), 3U);
  EXPECT_TRUE(same(history.scene(), present));
}

TEST_F(Histories, LoadOnlyTheStoredScenesThatAreNeeded) {
  const Scene start = startScene();
  std::vector<Scene> scenes{start};
  for (int i = 0; i < 10; ++i) scenes.push_back(painted(scenes.back(), stroke(i)));
  EditHistory history(start, counted(replays), kAmple);
  std::size_t loads = 0;
  for (std::size_t i = 0; i < 10; ++i) {
    EditHistory::Load load;
    if (i == 4)
      load = [&] {
        ++loads;
        return scenes[5];
      };
    history.appendStored(stroke(static_cast<int>(i)), std::move(load));
  }
  history.setPosition(8, scenes[8]);
  EXPECT_EQ(history.undoable(), 8U);
  EXPECT_EQ(history.redoable(), 2U);
  EXPECT_EQ(loads, 0U);
  EXPECT_TRUE(same(history.sceneAt(7), scenes[7]));
  EXPECT_EQ(loads, 1U);
  EXPECT_EQ(replays.count, 2U); // from 5 on
  ASSERT_TRUE(history.redo(2));
  EXPECT_TRUE(same(history.scene(), scenes[10]));
  ASSERT_TRUE(history.undo(10));
  EXPECT_TRUE(same(history.scene(), start));
}

// Kept scenes are sparser towards the past, and none of them is dropped later.
TEST_F(Histories, KeptScenesAreSparserTowardsThePast) {
  EditHistory history(startScene(), counted(replays), kAmple);
  for (int i = 0; i < 2000; ++i) paint(history, i);
  const std::vector<std::size_t> marks = history.checkpoints(100);
  ASSERT_GE(marks.size(), 4U);
  EXPECT_LE(marks.size(), 12U); // about log2 of the 22,000 samples and steps over 100
  EXPECT_TRUE(std::is_sorted(marks.begin(), marks.end()));
  EXPECT_GT(marks.back(), 1980U);
  for (std::size_t i = 2; i < marks.size(); ++i)
    EXPECT_LE(marks[i] - marks[i - 1], marks[i - 1] - marks[i - 2]);
  replays.count = 0;
  for (const std::size_t mark : marks) (void)history.sceneAt(mark);
  EXPECT_EQ(replays.count, 0U);
}

// Fourier textures count too: faces for each version, a shared texture once.
TEST_F(Histories, CountMappedTextures) {
  Scene scene = startScene();
  FourierTexture texture;
  texture.omega = 1000;
  texture.series.a.assign(64, 1e-6);
  texture.series.b.assign(64, 0);
  texture.low = minHeight(texture);
  const auto felt = hapticTexture(texture);
  const auto laidOn = [&](std::size_t faces) {
    TextureMappings laid;
    for (std::size_t f = 0; f < faces; ++f)
      laid.faces.push_back({static_cast<std::int32_t>(f), 1, {}});
    laid.library[1] = felt;
    ObjectPaint paint;
    paint.textures = std::make_shared<const TextureMappings>(std::move(laid));
    Scene with = startScene();
    with.objects[0].mesh = scene.objects[0].mesh;
    with.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
    return with;
  };
  const std::size_t bare = EditHistory(scene, counted(replays), kAmple).bytes();
  const std::size_t few = EditHistory(laidOn(50), counted(replays), kAmple).bytes();
  const std::size_t many = EditHistory(laidOn(150), counted(replays), kAmple).bytes();
  EXPECT_EQ(many - few, 100 * sizeof(TexturedFace));
  EXPECT_GE(few - bare, 50 * sizeof(TexturedFace) + bytes(*felt));
}

} // namespace
} // namespace patina
