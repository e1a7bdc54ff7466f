// The whole chain on its embedded scan; its figures must reveal a fault.
#include "demo/demo_report.h"

#include <gtest/gtest.h>

#include "core/file.h"
#include "geometry/io/textured_obj.h"
#include "scan/run_scan.h"
#include "support/fresh_folder.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

TEST(Demo, ReproducesAScanWithinItsLimits) {
  const std::filesystem::path folder = test::freshFolder("demo");
  Demo demo(folder, 1);
  Progress progress;
  while (!isDone(demo)) runNext(demo, progress);
  for (std::size_t i = 0; i < demo.seconds.size(); ++i)
    std::printf("%s %.2f s\n", demoSteps()[i].name.c_str(), demo.seconds[i]);
  const std::vector<DemoFigure> figures = demoFigures(demo);
  EXPECT_EQ(figures.size(), 1 + 7 * demo.object.materials.size());
  for (const DemoFigure& figure : figures) {
    std::printf("%s %s: %.4g of %.4g %s\n", figure.what.c_str(), figure.of.c_str(), figure.value,
                figure.limit, figure.unit.c_str());
    EXPECT_TRUE(figure.passes()) << figure.what << " " << figure.of;
  }
  // The output opens again, with paint and textures.
  const Scene scene = loadWorkspace(demo.folder / "workspace");
  ASSERT_TRUE(scene.objects.at(0).paint);
  EXPECT_EQ(scene.objects[0].paint->textures->library.size(), 3u);
  EXPECT_TRUE(scene.objects[0].paint->color && scene.objects[0].paint->material);
  double stiffness = 0; // mean over the textures, as no boundary throws the tip off
  for (const auto& [number, texture] : scene.objects[0].paint->textures->library)
    stiffness += texture->stiffness / 3;
  EXPECT_NEAR(scene.haptics.stiffness, stiffness, 0.51);
  EXPECT_GT(readTexturedObj(demo.folder / "textured.obj").textured.size(), 1000u);
  EXPECT_TRUE(demoJson(demo).at("holds").asBool());
  EXPECT_NE(demoMarkdown(demo, {"paths.png"}).find("![paths](paths.png)"), std::string::npos);

  // All steps at once from the same frames give the same bytes.
  RunScanOptions again;
  for (const DemoScan& one : demo.scans)
    (one.name == "survey" ? again.also : again.folders).push_back(folder / ("scan-" + one.name));
  again.mesh = folder / "toy.obj";
  again.workspace = folder / "again";
  for (const auto& scan : again.folders) std::filesystem::remove(scan / "poses.tum");
  const RunScanReport ran = runScan(again, progress);
  EXPECT_TRUE(ran.done);
  EXPECT_EQ(ran.steps.size(), 3U + 4 + 4 + 3) << "the survey has its poses";
  const auto areAlike = [&](const std::string& a, const std::string& b) {
    EXPECT_TRUE(readFile(folder / a) == readFile(folder / b)) << a << " and " << b;
  };
  for (const DemoMaterial& material : demo.object.materials) {
    const std::string scan = "scan-" + material.name + "/";
    areAlike("path-" + material.name + ".csv", scan + "path.csv");
    areAlike("registered-" + material.name + ".csv", scan + "registered.csv");
    areAlike("heights-" + material.name + ".csv", scan + "heights.csv");
    areAlike(material.name + ".json", scan + "texture.json");
  }
  areAlike("textured.obj", "scan-ribs/textured.obj");
  EXPECT_EQ(loadWorkspace(folder / "again").objects.at(0).paint->textures->library.size(), 3U);
  // Repeats the last step from the files of those before it; for other paths the pose is fitted
  // again.
  EXPECT_THROW(runScan(again, progress), FileError) << "the workspace is there";
  std::filesystem::rename(folder / "scan-ribs" / "texture.json", folder / "first.json");
  again.workspace = folder / "once-more";
  EXPECT_EQ(runScan(again, progress).steps.size(), 3U);
  areAlike("first.json", "scan-ribs/texture.json");
  again.also.clear();
  again.workspace = folder / "without";
  EXPECT_EQ(runScan(again, progress).steps.size(), 3U + 3);

  // The figures must fail for the same scan if its textures are absent.
  Scene bare = demo.compiled->scene;
  auto paint = std::make_shared<ObjectPaint>(*bare.objects[0].paint);
  paint->textures.reset();
  bare.objects[0].paint = std::move(paint);
  demo.compiled = compile(bare, progress);
  for (DemoTexture& texture : demo.textures) texture.felt.clear();
  demoSteps().back().run(demo, progress);
  for (const DemoTexture& texture : demo.textures)
    EXPECT_GT(texture.force_error.texture_error, 0.9);
  EXPECT_FALSE(demoJson(demo).at("holds").asBool());
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
