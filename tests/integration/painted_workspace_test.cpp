// The other commands on a painted workspace: scene, info, emboss, export, field, simulate.
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/tree/triangle_tree.h"
#include "integration/painted.h"
#include "pictures/picture_file.h"
#include "session/open/session.h"
#include "support/own_display.h"

namespace patina::test {
namespace {

class PaintedWorkspace : public Painted {
 protected:
  void paint() {
    ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  }
  std::set<std::string> layersOf(const Json& info) const {
    std::set<std::string> names;
    for (const Json& layer : info.at("layers").asArray()) {
      names.insert(layer.at("name").asString());
      EXPECT_GT(layer.at("bytes").asNumber(), 0) << layer.at("name").asString();
    }
    return names;
  }
};

TEST_F(PaintedWorkspace, RangeOfAPictureReplacesThePercentileOfItsColours) {
  if (!hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  std::filesystem::remove_all(workspace);
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", box, "--set", "voxel=1mm", "--set",
                 "paint.size=256", "--set", "colors.stiffness=percentile=20"})
                .exit,
            0);
  paint();
  const std::vector<std::string> words = {"render",    workspace, "--show",
                                          "stiffness", "-o",      folder / "p.png"};
  const auto rangeOf = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    const Json report = runJson(more);
    const auto& range = report.at("range").asArray();
    return ValueRange{range[0].asNumber(), range[1].asNumber()};
  };
  EXPECT_LT(rangeOf({}).high, 900) << "the percentile leaves out the painted dab";
  const ValueRange given = rangeOf({"--range", "100,2000"});
  EXPECT_EQ(given.low, 100);
  EXPECT_EQ(given.high, 2000);
}

TEST_F(PaintedWorkspace, InfoNamesLayersStagesReliefAndHistory) {
  const Json plain = runJson({"info", workspace});
  EXPECT_EQ(plain.find("relief"), nullptr);
  EXPECT_EQ(plain.find("history"), nullptr);
  const std::set<std::string> before = layersOf(plain);
  paint();
  const Json info = runJson({"info", workspace});
  const std::set<std::string> after = layersOf(info);
  for (const std::string name : {"color", "relief", "stiffness", "chart atlas"}) {
    EXPECT_FALSE(before.contains(name)) << name;
    EXPECT_TRUE(after.contains(name)) << name;
  }
  EXPECT_FALSE(after.contains("damping"));
  EXPECT_FALSE(after.contains("relief bake"));
  EXPECT_EQ(info.at("history").at("undo").asInteger(), 3);
  EXPECT_EQ(info.at("history").at("redo").asInteger(), 0);
  EXPECT_NEAR(info.at("relief").at("highest").asNumber(), 5e-4, 1e-8);
  EXPECT_EQ(info.at("relief").find("admissible"), nullptr); // no device, nothing to judge by
  EXPECT_GT(info.at("stages").asArray().size(), plain.at("stages").asArray().size());
  // F7: the part of it that the device can render.
  ASSERT_EQ(
      run({"scene", "-o", workspace, "--set", "device.damping=0.5", "--set", "relief.mode=baked"})
          .exit,
      0);
  const Json judged = runJson({"info", workspace});
  EXPECT_TRUE(judged.at("relief").at("exceeded").asBool()); // a hard brush makes a cliff
  EXPECT_LT(judged.at("relief").at("admissible").asNumber(), 5e-4);
  EXPECT_TRUE(layersOf(judged).contains("relief bake"));
}

TEST_F(PaintedWorkspace, EveryCommandForWorkspacesReadsIt) {
  paint();
  for (const char* mode : {"pulled", "baked"}) {
    ASSERT_EQ(run({"scene", "-o", workspace, "--set", std::string("relief.mode=") + mode}).exit, 0);
    EXPECT_EQ(run({"field", workspace, "-o", folder / "f.vti"}).exit, 0);
    const Json simulated = runJson({"simulate", workspace, "--seconds", "3"});
    EXPECT_TRUE(simulated.at("stable").asBool()) << mode;
    EXPECT_EQ(run({"info", workspace, "--no-field"}).exit, 0);
  }
}

TEST_F(PaintedWorkspace, SceneCallIsOneEdit) {
  const Scene start = loadWorkspace(workspace);
  const std::string aside = folder.write("aside.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", box + "@" + aside, "--move", "box@" + aside,
                 "--set", "stiffness=700"})
                .exit,
            0);
  const Json list = runJson({"undo", workspace, "--list"});
  ASSERT_EQ(list.at("edits").asArray().size(), 1U);
  EXPECT_EQ(list.at("edits").asArray()[0].at("what").asString(),
            "move box, add box, stiffness = 700");
  ASSERT_EQ(run({"undo", workspace}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(workspace), start));
}

// A step of grey along x is half a millimetre higher on one side, and is undone as one edit.
TEST_F(PaintedWorkspace, PictureBecomesReliefAndIsRendered) {
  Picture picture{64, 64, 1, std::vector<float>(64 * 64)};
  for (std::size_t i = 0; i < picture.texel.size(); ++i) picture.texel[i] = i % 64 < 32 ? 0 : 0.5f;
  const std::string file = folder / "step,z.png"; // its name ends like an option's word
  writePicture(file, picture);
  const Scene start = loadWorkspace(workspace);
  ASSERT_EQ(run({"scene", "-o", workspace, "--image", "box=" + file + ",relief,z"}).exit, 0);
  EXPECT_NEAR(hapticLast(workspace, pressAt(0.0153, 0.0004, 1e-3))[6] / 500, 1.5e-3, 2e-5);
  EXPECT_NEAR(hapticLast(workspace, pressAt(-0.0153, 0.0004, 1e-3))[6] / 500, 1e-3, 2e-5);
  ASSERT_EQ(run({"undo", workspace}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(workspace), start));
  ASSERT_EQ(run({"redo", workspace}).exit, 0);
  EXPECT_TRUE(loadWorkspace(workspace).objects[0].paint->relief);
}

TEST_F(PaintedWorkspace, BadPicturesChangeNothing) {
  const std::string file = folder / "a.png";
  writePicture(file, {64, 64, 1, std::vector<float>(64 * 64, 1.0f)});
  const std::string before = fingerprint(workspace);
  const auto tryWith = [&](const std::string& text, const std::vector<std::string>& parts) {
    expectOneLineError(run({"scene", "-o", workspace, "--image", text}), parts);
  };
  tryWith("box", {"OBJECT=FILE"});
  tryWith("cup=" + file, {"cup", "box"});
  tryWith("box=" + (folder / "none.png"), {"none.png"});
  tryWith("box=" + file + ",relief,mapped", {"coordinates"}); // the box has none
  tryWith("box=" + folder.write("broken.png", "\x89PNG\r\n\x1a\n nothing"), {"broken.png"});
  tryWith("box=" + box, {"box.ply"});
  EXPECT_EQ(fingerprint(workspace), before);
}

// K27: the mesh has the painted heights, in the unit that other commands read by default.
TEST_F(PaintedWorkspace, EmbossWritesTheReliefAsAMesh) {
  ASSERT_EQ(
      run({"paint", workspace, "--strokes",
           script("r.json", {stroke(Tool::relief, 8e-4, 0.012, {{0, 0, kTop}})}), "-o", workspace})
          .exit,
      0);
  const std::string before = fingerprint(workspace);
  for (const auto& [height, name] :
       {std::pair<double, const char*>{8e-4, "raised.ply"}, {-8e-4, "carved.stl"}}) {
    if (height < 0) {
      ASSERT_EQ(run({"scene", "-o", workspace, "--set", "relief.height=-1mm"}).exit, 0);
    }
    const std::string out = folder / name;
    const Json report = runJson({"emboss", workspace, "-o", out, "--voxel", "0.5mm"});
    EXPECT_TRUE(report.at("watertight").asBool());
    EXPECT_EQ(report.at("voxel").asNumber(), 5e-4);
    EXPECT_NEAR(report.at("highest").asNumber(), 8e-4, 1e-8);
    EXPECT_LT(report.at("deviation_rms").asNumber(), 1e-4);
    OpenedScene opened = openScene(out, {});
    const TriangleMesh& mesh = *opened.scene.objects[0].mesh;
    EXPECT_TRUE(inspect(mesh).watertight);
    const TriangleTree tree(mesh);
    EXPECT_LT(tree.closestPoint({0.0011, 0.0007, kTop + height}).distance, 2e-5) << name;
    EXPECT_LT(tree.closestPoint({0.0251, 0.0007, kTop}).distance, 2e-5) << name;
  }
  EXPECT_NE(fingerprint(workspace), before); // the set changed it, not emboss
  expectOneLineError(run({"emboss", workspace, "-o", folder / "a.xyz"}), {"a.xyz"});
  expectOneLineError(run({"emboss", workspace, "-o", folder / "a.ply", "--unit", "fit"}),
                     {"--unit"});
  // The result without relief is the field's own surface, and the command reports it.
  ASSERT_EQ(run({"undo", workspace, "--steps", "2"}).exit, 0);
  const Outcome flat = run({"emboss", workspace, "-o", folder / "flat.obj"});
  EXPECT_EQ(flat.exit, 0);
  EXPECT_NE(flat.err.find("no relief"), std::string::npos);
}

TEST_F(PaintedWorkspace, ExportWritesItsImagesToo) {
  paint();
  const Json report = runJson({"export", workspace, "-o", folder / "out"});
  for (const char* file : {"box-color.png", "box-color.exr", "box-relief.png", "box-relief.exr"})
    EXPECT_TRUE(std::filesystem::exists((folder / "out") + "/" + file)) << file;
  const Scene scene = loadWorkspace(workspace);
  const Picture relief = readPicture((folder / "out") + "/box-relief.exr");
  ASSERT_EQ(relief.width, 256);
  const TiledImage& image = *scene.objects[0].paint->relief;
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i)
      ASSERT_EQ(relief.texel[static_cast<std::size_t>(256 * j + i)], image.at(i, j, 0));
  bool listed = false;
  for (const Json& file : report.at("files").asArray())
    listed = listed || file.asString() == "box-relief.png";
  EXPECT_TRUE(listed);
}

// Linking the picture library would cost every start 170 ms.
TEST(PictureLibrary, IsNotLoadedWithTheProgram) {
  Running ldd({programPath().string()}, "ldd");
  const Outcome outcome = ldd.wait();
  ASSERT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.out.find("libstdc++"), std::string::npos);
  EXPECT_EQ(outcome.out.find("OpenImageIO"), std::string::npos);
}

} // namespace
} // namespace patina::test
