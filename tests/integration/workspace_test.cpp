// patina scene: a workspace that opens again and feels like the mesh it was made of.
#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/csv.h"
#include "core/file.h"
#include "integration/program.h"

namespace patina::test {
namespace {

class Workspaces : public testing::Test {
 protected:
  void SetUp() override {
    torus = folder / "torus.ply";
    ASSERT_EQ(run({"model", "torus", "-o", torus, "--around", "48", "--across", "24"}).exit, 0);
    workspace = folder / "workspace";
    std::string text = "t [s],x [m],y [m],z [m]\n";
    for (int i = 0; i < 300; ++i) // pressed into the ring, then dragged along it
      text += std::to_string(0.001 * i) + ",0.04," + std::to_string(1e-5 * std::max(0, i - 100)) +
              "," + std::to_string(0.016 - 2e-5 * std::min(i, 100)) + "\n";
    path = folder.write("tip.csv", text);
  }

  // Returns the whole row but the time of the step, which depends on the machine.
  std::vector<std::vector<double>> forces(const std::string& file) const {
    CsvTable table = readCsv(file, {"t [s]"});
    const auto step = std::find(table.columns.begin(), table.columns.end(), "step [ns]");
    if (step == table.columns.end()) throw std::runtime_error("no column of times");
    for (std::vector<double>& row : table.rows)
      row[static_cast<std::size_t>(step - table.columns.begin())] = 0;
    return table.rows;
  }

  ScratchFolder folder;
  std::string torus, workspace, path;
};

TEST_F(Workspaces, ReopenedOneRendersBitwiseLikeTheMesh) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus, "--set", "stiffness=700", "--set",
                 "friction.static=0.5", "--set", "friction.dynamic=0.3", "--set",
                 "tip.radius=0.4mm", "--set", "resolution=80", "--set", "sampler=kim"})
                .exit,
            0);
  ASSERT_EQ(run({"feel", workspace, "--path", path, "-o", folder / "a.csv"}).exit, 0);
  ASSERT_EQ(run({"feel", torus, "--path", path, "-o", folder / "b.csv", "--stiffness", "700",
                 "--friction-static", "0.5", "--friction-dynamic", "0.3", "--tip-radius", "0.4mm",
                 "--resolution", "80", "--sampler", "kim"})
                .exit,
            0);
  const auto a = forces(folder / "a.csv"), b = forces(folder / "b.csv");
  EXPECT_EQ(a, b);
  EXPECT_GT(b.back()[6], 0.5); // the comparison is of forces, not of zeros

  // An option overrides the workspace for one run and does not change it.
  const std::string before = readFile(workspace + "/workspace.json");
  const Json softer =
      runJson({"feel", workspace, "--path", path, "-o", folder / "c.csv", "--stiffness", "70"});
  EXPECT_LT(softer.at("max_force").asNumber(), 0.2);
  EXPECT_EQ(readFile(workspace + "/workspace.json"), before);
}

TEST_F(Workspaces, AreListedWithoutChanges) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  const Json listed = runJson({"scene", "-o", workspace});
  EXPECT_FALSE(listed.at("saved").asBool());
  ASSERT_EQ(listed.at("objects").asArray().size(), 1u);
  EXPECT_EQ(listed.at("objects").asArray()[0].at("name").asString(), "torus");
  EXPECT_EQ(listed.at("objects").asArray()[0].at("triangles").asInteger(), 2 * 48 * 24);
  EXPECT_EQ(listed.at("values").at("stiffness").asNumber(), 500);
  EXPECT_EQ(listed.at("values").at("sampler").asString(), "high");
  EXPECT_EQ(listed.at("values").find("damping"), nullptr); // an absent feature is an absent value
}

TEST_F(Workspaces, PoseMovesTheObject) {
  const std::string pose =
      folder.write("pose.txt", "# world_from_object\n0 -1 0 0.1\n1 0 0 0\n0 0 1 -0.02\n0 0 0 1\n");
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus + "@" + pose}).exit, 0);
  const Json info = runJson({"info", workspace, "--no-field"});
  EXPECT_EQ(info.at("kind").asString(), "workspace");
  const auto& low = info.at("bounds").asArray()[0].asArray();
  EXPECT_NEAR(low[0].asNumber(), 0.1 - 0.055, 1e-9);
  EXPECT_NEAR(low[2].asNumber(), -0.02 - 0.015, 1e-9);

  const std::string scaled = folder.write("scaled.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  expectOneLineError(run({"scene", "-o", folder / "other", "--add", torus + "@" + scaled}),
                     {"scaled.txt:1:", "scale"});
}

TEST_F(Workspaces, BadPosesAreNamedByFileAndLine) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  const std::string before = readFile(workspace + "/workspace.json");
  const std::pair<const char*, std::vector<std::string>> bad[] = {
      {"1 0 0 0\n0 1 zero 0\n0 0 1 0\n0 0 0 1\n", {"bad.txt:2:", "zero"}},
      {"1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", {"bad.txt:1:", "nan"}},
      {"1 0 0 0\n# y\n0 1 0 0\n0 0 1 0\n", {"bad.txt:4:", "12 numbers"}},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n7\n", {"bad.txt:5:", "one more"}},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", {"bad.txt:4:", "0 0 0 1"}},
      {"1 0 0 0\n0 1 0 0\n0 0 2 0\n0 0 0 1\n", {"bad.txt:3:", "scale"}},
      {"1 0 0 0\n0.6 0.8 0 0\n0 0 1 0\n0 0 0 1\n", {"bad.txt:1:", "right angles"}},
      {"-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", {"bad.txt:1:", "reflection"}},
      {"", {"bad.txt", "0 numbers"}}};
  for (const auto& [text, parts] : bad) {
    const std::string pose = folder.write("bad.txt", text);
    expectOneLineError(run({"scene", "-o", workspace, "--add", torus + "@" + pose}), parts);
    expectOneLineError(run({"scene", "-o", workspace, "--move", "torus@" + pose}), parts);
  }
  const std::string pose = folder.write("pose.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expectOneLineError(run({"scene", "-o", workspace, "--move", "cup@" + pose}), {"cup", "torus"});
  expectOneLineError(run({"scene", "-o", workspace, "--move", "torus"}), {"NAME@POSE.txt"});
  expectOneLineError(run({"scene", "-o", workspace, "--move", "torus@" + (folder / "no.txt")}),
                     {"no.txt"});
  EXPECT_EQ(readFile(workspace + "/workspace.json"), before);
}

// K14: added, moved, felt, removed.
TEST_F(Workspaces, SeveralObjectsAreTouchedAsOne) {
  const std::string aside =
      folder.write("aside.txt", "1 0 0 0.2\n0 1 0 0\n0 0 1 0\n0 0 0 1 # metres\n");
  const std::string far = folder.write("far.txt", "1 0 0 0.3\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Json made = runJson({"scene", "-o", workspace, "--add", torus, "--add", torus + "@" + aside,
                             "--set", "voxel=0.8mm"});
  const auto& objects = made.at("objects").asArray();
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0].at("name").asString(), "torus");
  EXPECT_EQ(objects[1].at("name").asString(), "torus-2");
  EXPECT_EQ(objects[1].at("world_from_object").asArray()[0].asArray()[3].asNumber(), 0.2);

  // The force on the first object does not depend on the second.
  const Json feel = runJson({"feel", workspace, "--path", path, "-o", folder / "two.csv"});
  ASSERT_EQ(run({"feel", torus, "--path", path, "-o", folder / "one.csv", "--voxel", "0.8mm"}).exit,
            0);
  EXPECT_NEAR(feel.at("max_force").asNumber(), 0.5, 0.05);
  const auto one = forces(folder / "one.csv"), two = forces(folder / "two.csv");
  for (std::size_t row = 0; row < one.size(); ++row)
    for (std::size_t c = 4; c < 7; ++c) EXPECT_NEAR(one[row][c], two[row][c], 2e-3);

  const Json moved = runJson({"scene", "-o", workspace, "--move", "torus-2@" + far});
  EXPECT_EQ(
      moved.at("objects").asArray()[1].at("world_from_object").asArray()[0].asArray()[3].asNumber(),
      0.3);
  const Json removed = runJson({"scene", "-o", workspace, "--remove", "torus"});
  ASSERT_EQ(removed.at("objects").asArray().size(), 1u);
  EXPECT_EQ(removed.at("objects").asArray()[0].at("name").asString(), "torus-2");
  const Json none = runJson({"feel", workspace, "--path", path, "-o", folder / "f.csv"});
  EXPECT_EQ(none.at("contact_ticks").asNumber(), 0);
}

// Stages that are on because of the second object are listed, and none while there is one object.
TEST_F(Workspaces, InfoNamesTheObjectsAndTheCostOfTheirUnion) {
  const std::string aside = folder.write("aside.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  const Json one = runJson({"info", workspace});
  EXPECT_EQ(one.at("objects").asArray().size(), 1u);
  for (const Json& layer : one.at("layers").asArray())
    EXPECT_NE(layer.at("name").asString(), "merge");
  ASSERT_EQ(
      run({"scene", "-o", workspace, "--add", torus + "@" + aside, "--set", "merge.redistance=on"})
          .exit,
      0);
  const Json two = runJson({"info", workspace});
  ASSERT_EQ(two.at("objects").asArray().size(), 2u);
  EXPECT_EQ(two.at("objects").asArray()[1].at("name").asString(), "torus-2");
  EXPECT_GT(two.at("field").at("redistanced_nodes").asNumber(), 0);
  bool listed = false;
  for (const Json& layer : two.at("layers").asArray()) {
    if (layer.at("name").asString() != "merge") continue;
    listed = true;
    EXPECT_EQ(layer.at("why").asString(), "2 objects, merge.redistance = on");
    EXPECT_GT(layer.at("bytes").asNumber(), 0);
  }
  EXPECT_TRUE(listed);
}

TEST_F(Workspaces, ExportAssignsTrianglesToObjects) {
  const std::string aside = folder.write("aside.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus, "--add", torus + "@" + aside, "--set",
                 "resolution=60"})
                .exit,
            0);
  ASSERT_EQ(run({"export", workspace, "-o", folder / "out"}).exit, 0);
  EXPECT_NE(readFile(folder / "out/mesh.vtp").find("\"object\""), std::string::npos);
  EXPECT_EQ(run({"field", workspace, "-o", folder / "two.vti"}).exit, 0);
}

TEST_F(Workspaces, ErrorsKeepTheFolder) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  const std::string before = readFile(workspace + "/workspace.json");
  expectOneLineError(
      run({"scene", "-o", workspace, "--set", "stiffness=900", "--set", "colour=red"}),
      {"colour", "stiffness", "friction.static", "tip.radius", "resolution"});
  expectOneLineError(run({"scene", "-o", workspace, "--set", "stiffness=-1"}), {"stiffness", "-1"});
  expectOneLineError(run({"scene", "-o", workspace, "--set", "stiffness"}), {"--set", "KEY=VALUE"});
  expectOneLineError(run({"scene", "-o", workspace, "--remove", "cup"}), {"cup", "torus"});
  expectOneLineError(
      run({"scene", "-o", workspace, "--remove", "torus", "--add", folder / "none.ply"}),
      {"none.ply"});
  EXPECT_EQ(readFile(workspace + "/workspace.json"), before);
}

TEST_F(Workspaces, RemovedObjectMakesRoomForAnother) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  const std::string box = folder / "box.stl";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  const Json changed = runJson({"scene", "-o", workspace, "--remove", "torus", "--add", box});
  EXPECT_EQ(changed.at("objects").asArray()[0].at("name").asString(), "box");
  expectOneLineError(run({"feel", (run({"scene", "-o", folder / "empty"}), folder / "empty"),
                          "--path", path, "-o", folder / "f.csv"}),
                     {"no object"});
}

TEST_F(Workspaces, EmptyOneHasNoBoundsAndNoStages) {
  ASSERT_EQ(run({"scene", "-o", workspace}).exit, 0);
  const Json info = runJson({"info", workspace});
  EXPECT_TRUE(info.at("bounds").isNull());
  EXPECT_TRUE(info.at("stages").asArray().empty());
  EXPECT_EQ(info.at("triangles").asInteger(), 0);
}

TEST_F(Workspaces, SettingsThatFitOnlyTogetherAreAccepted) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus, "--set", "friction.static=0.5", "--set",
                 "friction.dynamic=0.3"})
                .exit,
            0);
  EXPECT_EQ(run({"scene", "-o", workspace, "--set", "resolution=12", "--set", "band=3", "--set",
                 "friction.static=0.2", "--set", "friction.dynamic=0.1"})
                .exit,
            0);
  const Json values = runJson({"scene", "-o", workspace}).at("values");
  EXPECT_EQ(values.at("resolution").asNumber(), 12);
  EXPECT_EQ(values.at("friction.static").asNumber(), 0.2);
}

TEST_F(Workspaces, ForeignFolderIsNeverOverwritten) {
  const std::string photos = folder / "photos";
  std::filesystem::create_directories(photos);
  folder.write("photos/cat.txt", "meow");
  expectOneLineError(run({"scene", "-o", photos, "--add", torus}), {"photos", "not a workspace"});
  EXPECT_EQ(readFile(photos + "/cat.txt"), "meow");
  EXPECT_FALSE(std::filesystem::exists(photos + "/workspace.json"));
}

TEST_F(Workspaces, TheirJsonFileStandsForTheFolder) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus, "--set", "stiffness=700"}).exit, 0);
  const Json info = runJson({"info", workspace + "/workspace.json", "--no-field"});
  EXPECT_EQ(info.at("kind").asString(), "workspace");
  EXPECT_EQ(info.at("values").at("stiffness").asNumber(), 700);
  const Outcome useless = run({"info", workspace, "--no-field", "--unit", "cm", "--iso", "1"});
  EXPECT_EQ(useless.exit, 0);
  EXPECT_NE(useless.err.find("--unit has no effect on a workspace"), std::string::npos);
  EXPECT_NE(useless.err.find("--iso has no effect on a workspace"), std::string::npos);
}

TEST_F(Workspaces, ChangedFilesAreNoticed) {
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", torus}).exit, 0);
  for (const auto& file : std::filesystem::directory_iterator(workspace + "/meshes")) {
    std::string bytes = readFile(file.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    writeFileAtomically(file.path(), bytes);
  }
  expectOneLineError(run({"info", workspace}), {"SHA-256"});
}

} // namespace
} // namespace patina::test
