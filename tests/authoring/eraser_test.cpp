// An eraser keeps mapped textures.
#include <gtest/gtest.h>

#include "authoring/brush/painter.h"
#include "authoring/paint_fixture.h"

namespace patina {
namespace {

TEST(Painter, EraserKeepsMappedTextures) {
  Scene scene = test::sceneOf(icosphere(0.05, 12));
  ObjectPaint laid;
  laid.textures = std::make_shared<const TextureMappings>(TextureMappings{{{3, 1, {}}}, {}});
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(laid);
  const auto surface = test::surfaceOf(scene);
  const Scene now =
      painted(surface, scene, test::strokeAt(test::brushOf(Tool::color, 0.02), Vec3(0, 0, 0.05)));
  Brush eraser = test::brushOf(Tool::erase, 0.03);
  eraser.falloff = 1000;
  const Scene erased = painted(surface, now, test::strokeAt(eraser, Vec3(0, 0, 0.05)));
  ASSERT_TRUE(erased.objects[0].paint);
  EXPECT_EQ(erased.objects[0].paint->color, nullptr);
  EXPECT_EQ(erased.objects[0].paint->textures, laid.textures);
}

} // namespace
} // namespace patina
