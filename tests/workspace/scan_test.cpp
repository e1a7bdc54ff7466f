// Scans of a scene in its workspace: they come back, cost nothing where there are none, and what is
// wrong with one is said.
#include "workspace/workspace_support.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

SceneScan someScan(const std::string& name, const fs::path& frames) {
  SceneScan scan;
  scan.name = name;
  for (const char* file : {"camera.yml", "rig.json", "poses.tum"})
    scan.files[file] = std::make_shared<const std::string>(std::string("text of ") + file + "\n");
  scan.folder = frames;
  scan.frames = frames.empty() ? "" : std::string(64, 'a');
  return scan;
}

class ScanTest : public WorkspaceTest {
 protected:
  ScanTest() : bare(sceneWithObjects(0.05)), scene(bare) {
    scene = withScan(scene, someScan("rim", root / "rim"));
    scene = withScan(scene, someScan("base", {}));
  }
  Scene bare, scene;
};

TEST_F(ScanTest, ComeBackWithAllTheirFiles) {
  saveWorkspace(scene, folder);
  EXPECT_EQ(loadWorkspace(folder).scans, scene.scans);
  EXPECT_EQ(filesIn("scans"), 6u);
  saveWorkspace(withScan(scene, someScan("base", {})), folder); // the same: nothing new
  EXPECT_EQ(filesIn("scans"), 6u);
}

TEST_F(ScanTest, CostNothingWhereThereAreNone) {
  saveWorkspace(scene, folder);
  saveWorkspace(withoutScan(withoutScan(scene, "rim"), "base"), folder);
  EXPECT_EQ(filesIn("scans"), 0u); // nothing names them any more
  saveWorkspace(bare, root / "other");
  EXPECT_FALSE(fs::exists(root / "other" / "scans"));
  EXPECT_EQ(readFile(root / "other" / "workspace.json").find("scans"), std::string::npos);
}

TEST_F(ScanTest, FindTheirFramesAfterBothFoldersWereMovedTogether) {
  saveWorkspace(scene, folder);
  const fs::path moved = root / "moved";
  fs::create_directories(moved);
  fs::rename(folder, moved / "scene");
  EXPECT_EQ(loadWorkspace(moved / "scene").scans[0].folder, moved / "rim");
}

TEST_F(ScanTest, AFileThatWasChangedIsNamedAndRecoveryLeavesThatScanOut) {
  saveWorkspace(scene, folder);
  fs::path file;
  for (const auto& item : fs::directory_iterator(folder / "scans"))
    if (says(item.path().filename(), "rim-rig")) file = item.path();
  writeFileAtomically(file, "another\n");
  const std::string error = errorOf([&] { loadWorkspace(folder); });
  EXPECT_TRUE(says(error, file.filename())) << error;
  EXPECT_TRUE(says(error, "SHA-256")) << error;
  const OpenedWorkspace kept = openWorkspace(folder, true);
  ASSERT_EQ(kept.scene.scans.size(), 1u);
  EXPECT_EQ(kept.scene.scans[0].name, "base");
  EXPECT_EQ(kept.scene.objects.size(), scene.objects.size());
  EXPECT_TRUE(std::any_of(kept.notes.begin(), kept.notes.end(), [](const std::string& note) {
    return says(note, "scan rim is left out");
  }));
}

TEST_F(ScanTest, WhatNoScanHasIsRefused) {
  saveWorkspace(scene, folder);
  replaceIn(folder / "workspace.json", "\"rig.json\":", "\"mesh.obj\":");
  EXPECT_TRUE(says(errorOf([&] { loadWorkspace(folder); }), "'mesh.obj' is no file of a scan"));
}

TEST(Scans, OneOfANameAndItsStepsInWords) {
  const SceneScan first = someScan("rim", {});
  SceneScan later = first;
  later.files["path.csv"] = std::make_shared<const std::string>("path");
  EXPECT_EQ(wordsFor(nullptr, first), "attach scan rim");
  EXPECT_EQ(wordsFor(&first, first), "");
  EXPECT_EQ(wordsFor(&first, later), "filter scan rim");
  later.files["poses.tum"] = std::make_shared<const std::string>("others");
  EXPECT_EQ(wordsFor(&first, later), "track and filter scan rim");
  later.files.erase("rig.json");
  EXPECT_EQ(wordsFor(&first, later), "calibrate, track and filter scan rim");
  Scene scene = withScan(withScan({}, first), later);
  ASSERT_EQ(scene.scans.size(), 1u);
  EXPECT_EQ(scene.scans[0], later);
  EXPECT_THROW((void)withScan(scene, someScan("a b", {})), Error);
  EXPECT_THROW((void)withoutScan(scene, "base"), Error);
  EXPECT_EQ(scanNameOf("/tmp/a scan of a cup/"), "a-scan-of-a-cup");
}

} // namespace
} // namespace patina
