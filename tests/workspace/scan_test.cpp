// Scans of a scene in its workspace are loaded again, cost nothing if there are none, and faults in
// one are reported.
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

TEST_F(ScanTest, ReloadsScansWithAllTheirFiles) {
  saveWorkspace(scene, folder);
  EXPECT_EQ(loadWorkspace(folder).scans, scene.scans);
  EXPECT_EQ(filesIn("scans"), 6u);
  saveWorkspace(withScan(scene, someScan("base", {})), folder); // unchanged: no new files
  EXPECT_EQ(filesIn("scans"), 6u);
}

TEST_F(ScanTest, WritesNothingWithoutScans) {
  saveWorkspace(scene, folder);
  saveWorkspace(withoutScan(withoutScan(scene, "rim"), "base"), folder);
  EXPECT_EQ(filesIn("scans"), 0u); // no scan names them any more
  saveWorkspace(bare, root / "other");
  EXPECT_FALSE(fs::exists(root / "other" / "scans"));
  EXPECT_EQ(readFile(root / "other" / "workspace.json").find("scans"), std::string::npos);
}

TEST_F(ScanTest, FindsFramesAfterBothFoldersMoved) {
  saveWorkspace(scene, folder);
  const fs::path moved = root / "moved";
  fs::create_directories(moved);
  fs::rename(folder, moved / "scene");
  EXPECT_EQ(loadWorkspace(moved / "scene").scans[0].folder, moved / "rim");
}

TEST_F(ScanTest, NamesAChangedFileAndRecoverySkipsItsScan) {
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

TEST_F(ScanTest, RefusesFilesThatNoScanHas) {
  saveWorkspace(scene, folder);
  replaceIn(folder / "workspace.json", "\"rig.json\":", "\"mesh.obj\":");
  EXPECT_TRUE(says(errorOf([&] { loadWorkspace(folder); }), "'mesh.obj' is no file of a scan"));
}

TEST(Scans, HaveUniqueNamesAndStepsInWords) {
  const SceneScan first = someScan("rim", {});
  SceneScan later = first;
  later.files["path.csv"] = std::make_shared<const std::string>("path");
  EXPECT_EQ(describeChange(nullptr, first), "attach scan rim");
  EXPECT_EQ(describeChange(&first, first), "");
  EXPECT_EQ(describeChange(&first, later), "filter scan rim");
  later.files["poses.tum"] = std::make_shared<const std::string>("others");
  EXPECT_EQ(describeChange(&first, later), "track and filter scan rim");
  later.files.erase("rig.json");
  EXPECT_EQ(describeChange(&first, later), "calibrate, track and filter scan rim");
  Scene scene = withScan(withScan({}, first), later);
  ASSERT_EQ(scene.scans.size(), 1u);
  EXPECT_EQ(scene.scans[0], later);
  EXPECT_THROW((void)withScan(scene, someScan("a b", {})), Error);
  EXPECT_THROW((void)withoutScan(scene, "base"), Error);
  EXPECT_EQ(scanNameOf("/tmp/a scan of a cup/"), "a-scan-of-a-cup");
}

SceneScan scanOf(const std::string& texts, const std::string& frames = "") {
  SceneScan scan;
  scan.name = "rim";
  if (!frames.empty()) scan.folder = "/rim", scan.frames = std::string(64, frames[0]);
  // "rig.json:a path.csv:b", one character each
  for (std::size_t at = 0; at < texts.size(); at = texts.find(' ', at) + 1) {
    const std::size_t end = std::min(texts.find(' ', at), texts.size());
    scan.files[texts.substr(at, end - 2 - at)] =
        std::make_shared<const std::string>(texts.substr(end - 1, 1));
    if (end == texts.size()) break;
  }
  return scan;
}

TEST(Scans, KeepOnlyResultsOfTheFolderPresentFiles) {
  const auto kept = [](const SceneScan& known, const SceneScan& found) {
    std::string names;
    for (const auto& [file, text] : mergedScan(known, found).files)
      names += file + ":" + *text + " ";
    return names;
  };
  const SceneScan known = scanOf(
      "probe.csv:a rig.json:a poses.tum:a path.csv:a registered.csv:a registered.txt:a", "f");
  const std::string whole = kept(known, known);
  EXPECT_EQ(whole, "path.csv:a poses.tum:a probe.csv:a registered.csv:a registered.txt:a "
                   "rig.json:a ");
  EXPECT_EQ(kept(known, scanOf("probe.csv:a rig.json:a", "f")), whole);
  EXPECT_EQ(kept(known, scanOf("probe.csv:a", "f")), whole);
  // Another recording differs by its frames, its samples, or because only one has any.
  EXPECT_EQ(kept(known, scanOf("probe.csv:a rig.json:a", "g")), "probe.csv:a rig.json:a ");
  EXPECT_EQ(kept(known, scanOf("probe.csv:b", "f")), "probe.csv:b ");
  EXPECT_EQ(kept(known, scanOf("rig.json:a", "f")), "rig.json:a ");
  EXPECT_EQ(kept(known, scanOf("probe.csv:a rig.json:a")), "probe.csv:a rig.json:a ");
  EXPECT_EQ(kept(scanOf("poses.tum:a path.csv:a"), scanOf("poses.tum:b")), "poses.tum:b ");
  EXPECT_EQ(kept(scanOf("path.csv:a registered.txt:a"), scanOf("path.csv:b")), "path.csv:b ");
  EXPECT_EQ(kept(scanOf("path.csv:a"), scanOf("poses.tum:a")), "poses.tum:a ");
  // The same recording with another calibration: a new camera keeps the rig, but not the later
  // results.
  EXPECT_EQ(kept(known, scanOf("probe.csv:a rig.json:b", "f")), "probe.csv:a rig.json:b ");
  EXPECT_EQ(kept(known, scanOf("probe.csv:a camera.yml:b", "f")),
            "camera.yml:b probe.csv:a rig.json:a ");
  // The registration of a path belongs to that path alone, even if other files of the scan are
  // newer.
  EXPECT_EQ(kept(scanOf("path.csv:a registered.csv:a registered.txt:a"),
                 scanOf("probe.csv:a path.csv:a heights.csv:a", "f")),
            "heights.csv:a path.csv:a probe.csv:a registered.csv:a registered.txt:a ");
  EXPECT_EQ(kept(scanOf("path.csv:a registered.csv:a registered.txt:a"),
                 scanOf("path.csv:a registered.csv:b")),
            "path.csv:a registered.csv:b ");
  EXPECT_EQ(invalidatedFiles(known, scanOf("probe.csv:b poses.tum:b")),
            "rig.json, path.csv, registered.csv, registered.txt");
  EXPECT_EQ(invalidatedFiles(known, known), "");
}

} // namespace
} // namespace patina
