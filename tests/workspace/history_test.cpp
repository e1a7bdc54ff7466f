// Paint, states and the journal of a workspace are loaded again, and faults in them are reported.
#include <atomic>
#include <chrono>
#include <thread>

#include "core/sha256.h"
#include "workspace/workspace_support.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class HistoryTest : public WorkspaceTest {
 protected:
  // Three edits, the second by a state; saved after the second.
  HistoryTest() : start(sceneWithObjects(0.05)), later(paintedScene(0.05, 3, With::all)) {
    saveWorkspace(start, folder);
    const OpenedWorkspace opened = openWorkspace(folder);
    JournalWriter journal(opened.journal_file, 0);
    journal.append(someStroke(9, 700));
    state = storeState(later, 2, folder);
    journal.append(StoredSceneEdit{"change", state});
    saveWorkspace(later, 2, {opened.states.front(), {2, state}}, folder);
    journal.append(UndoEvent{});
  }
  std::string errorOfOpening() const {
    const std::string error = errorOf([&] { openWorkspace(folder); });
    EXPECT_TRUE(error.empty() || error.starts_with(folder.string())) << error;
    return error;
  }
  fs::path only(const std::string& part, const std::string& with) const {
    fs::path found;
    for (const auto& item : fs::directory_iterator(folder / part))
      if (says(item.path().filename().string(), with)) found = item.path();
    return found;
  }
  fs::path journal() const { return folder / "journal-1.jsonl"; }
  fs::path json() const { return folder / "workspace.json"; }

  Scene start, later;
  std::string state;
};

TEST_F(HistoryTest, ReloadsSceneJournalAndStates) {
  const OpenedWorkspace found = openWorkspace(folder);
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.event, 2u);
  EXPECT_EQ(found.journal_file, journal());
  EXPECT_EQ(found.journal, (std::vector<JournalEvent>{
                               someStroke(9, 700), StoredSceneEdit{"change", state}, UndoEvent{}}));
  ASSERT_EQ(found.states.size(), 2u);
  EXPECT_TRUE(same(loadState(folder, found.states[0].file), start));
  EXPECT_TRUE(same(loadState(folder, found.states[1].file), later));
  EXPECT_TRUE(found.notes.empty());
  EXPECT_TRUE(same(loadWorkspace(folder), later));
}

TEST_F(HistoryTest, MovesWithItsFolder) {
  fs::rename(folder, root / "elsewhere");
  EXPECT_TRUE(same(openWorkspace(root / "elsewhere").scene, later));
}

TEST_F(HistoryTest, WritesAHistoryIntoAnotherFolderAtOnce) {
  const OpenedWorkspace found = openWorkspace(folder);
  const fs::path other = root / "other";
  saveWorkspace(sceneWithObjects(0.02), other);
  const std::string first = storeState(start, 0, other), second = storeState(later, 2, other);
  EXPECT_EQ(second, state); // named by content
  saveWorkspace(later, 2, {{0, first}, {2, second}}, found.journal, other);
  const OpenedWorkspace copy = openWorkspace(other);
  EXPECT_TRUE(same(copy.scene, later));
  EXPECT_EQ(copy.journal, found.journal);
  EXPECT_NE(copy.journal_file, other / "journal-1.jsonl"); // a file of the old history
  EXPECT_FALSE(fs::exists(other / "journal-1.jsonl"));
}

TEST_F(HistoryTest, KeepsReferencedFilesAndRemovesOthers) {
  const OpenedWorkspace found = openWorkspace(folder);
  storeState(paintedScene(0.05, 9, With::material), 9, folder); // left by an edit that failed
  writeFileAtomically(folder / "paint" / "notes.txt", "mine");
  saveWorkspace(start, 3, {found.states.front()}, folder);
  EXPECT_TRUE(same(loadState(folder, state), later)); // only the journal names it
  EXPECT_EQ(filesIn("states"), 2u);
  EXPECT_EQ(filesIn("paint"), 5u); // layout, colour, relief, material of `later`, and the note
  saveWorkspace(start, folder);
  EXPECT_EQ(filesIn("states"), 1u);
  EXPECT_EQ(filesIn("paint"), 1u);
  EXPECT_FALSE(fs::exists(journal()));
}

TEST_F(HistoryTest, UnchangedFilesAreNotWrittenAgain) {
  const auto written = fs::last_write_time(only("paint", "color"));
  const auto mesh = fs::last_write_time(only("meshes", "ball"));
  const OpenedWorkspace found = openWorkspace(folder);
  Scene scene = found.scene;
  scene.haptics.stiffness = 321;
  saveWorkspace(scene, 3, found.states, folder);
  EXPECT_EQ(fs::last_write_time(only("paint", "color")), written);
  EXPECT_EQ(fs::last_write_time(only("meshes", "ball")), mesh);
  EXPECT_EQ(loadWorkspace(folder).haptics.stiffness, 321);
}

// Equal files are loaded as one value, so that data computed from a mesh can be kept.
TEST_F(HistoryTest, SharesEqualFilesInMemory) {
  const OpenedWorkspace found = openWorkspace(folder);
  const Scene again = loadState(folder, state);
  EXPECT_EQ(found.scene.objects[0].mesh, again.objects[0].mesh);
  EXPECT_EQ(found.scene.objects[0].paint->color, again.objects[0].paint->color);
}

TEST_F(HistoryTest, StoresOnlyAnOwnLayout) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  mesh.corner_uvs = someLayout(mesh.triangles.size(), 4);
  Scene scene;
  auto shared = std::make_shared<const TriangleMesh>(mesh);
  scene.objects.push_back({"box", shared, Pose::Identity(), nullptr});
  ObjectPaint paint = *somePaint(mesh, 4, With::all);
  paint.layout = {std::make_shared<const CornerUvs>(mesh.corner_uvs), false, 12};
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(paint);
  saveWorkspace(scene, root / "own");
  EXPECT_TRUE(same(loadWorkspace(root / "own"), scene));
  for (const auto& item : fs::directory_iterator(root / "own" / "paint"))
    EXPECT_NE(item.path().extension(), ".ply");
}

TEST_F(HistoryTest, RefusesALayoutOutsideTheUnitSquare) {
  Scene scene = later;
  ObjectPaint paint = *later.objects[0].paint;
  CornerUvs uvs = *paint.layout.uvs;
  uvs[5][1].x() = std::nan("");
  paint.layout.uvs = std::make_shared<const CornerUvs>(uvs);
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(paint);
  EXPECT_THROW(saveWorkspace(scene, folder), Error);
  EXPECT_TRUE(same(openWorkspace(folder).scene, later));
}

TEST_F(HistoryTest, LeavesOutATornLastRecordWithANote) {
  const std::string text = readFile(journal());
  writeFileAtomically(journal(), text.substr(0, text.size() - 3));
  const OpenedWorkspace found = openWorkspace(folder);
  EXPECT_EQ(found.journal.size(), 2u);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_TRUE(says(found.notes[0], "journal-1.jsonl: the last record is incomplete"));
}

TEST_F(HistoryTest, ReportsFaultsOfTheJournal) {
  const std::string text = readFile(journal());
  std::string damaged = text;
  damaged[text.size() / 2] ^= 4;
  writeFileAtomically(journal(), damaged);
  EXPECT_TRUE(says(errorOfOpening(), "journal-1.jsonl:2: the record's checksum differs"));
  writeFileAtomically(journal(), text.substr(0, text.find("{\"n\":2")));
  EXPECT_TRUE(says(errorOfOpening(), "holds 1 of the 2 edits that were saved"));
  writeFileAtomically(journal(), "");
  EXPECT_TRUE(says(errorOfOpening(), "holds nothing"));
  fs::remove(journal());
  EXPECT_TRUE(says(errorOfOpening(), "journal-1.jsonl: is missing"));
  EXPECT_TRUE(says(errorOfOpening(), "recover"));
  EXPECT_TRUE(same(loadWorkspace(folder), later)); // the scene needs no journal
}

TEST_F(HistoryTest, RefusesAnotherWorkspacesJournal) {
  // The history has another beginning.
  saveWorkspace(sceneWithObjects(0.02), root / "other");
  fs::copy_file(root / "other" / "journal-1.jsonl", journal(),
                fs::copy_options::overwrite_existing);
  EXPECT_TRUE(says(errorOfOpening(), "is the journal of another workspace"));
  // It has the same beginning, but other edits.
  fs::remove_all(root / "other");
  saveWorkspace(start, root / "other");
  JournalWriter writer(root / "other" / "journal-1.jsonl", 0);
  for (int k = 0; k < 3; ++k) writer.append(someStroke(4, 300));
  fs::copy_file(root / "other" / "journal-1.jsonl", journal(),
                fs::copy_options::overwrite_existing);
  EXPECT_TRUE(says(errorOfOpening(), "is the journal of another workspace"));
}

TEST_F(HistoryTest, EveryBrokenFileIsNamed) {
  for (const auto& [part, with] :
       std::vector<std::pair<std::string, std::string>>{{"paint", "color"},
                                                        {"paint", "relief"},
                                                        {"paint", "material"},
                                                        {"paint", "layout"},
                                                        {"meshes", "ball"},
                                                        {"states", "0-"},
                                                        {"states", "2-"}}) {
    const fs::path path = only(part, with);
    const std::string good = readFile(path);
    std::string changed = good;
    changed[good.size() / 2] ^= 1;
    for (const std::string& bad : {good.substr(0, good.size() / 2), std::string(), changed}) {
      writeFileAtomically(path, bad);
      const std::string error = errorOfOpening();
      EXPECT_TRUE(says(error, path.filename().string() + ": is not the file that was saved"))
          << error;
    }
    fs::remove(path);
    EXPECT_TRUE(says(errorOfOpening(), path.filename().string() + ": cannot be opened"));
    writeFileAtomically(path, good);
    EXPECT_EQ(errorOfOpening(), "");
  }
}

TEST_F(HistoryTest, RefusesPathsOutsideTheFolder) {
  const std::string good = readFile(json());
  for (const auto& [part, with] : std::vector<std::pair<std::string, std::string>>{
           {"paint", "color"}, {"paint", "material"}, {"paint", "layout"}, {"states", "0-"}}) {
    const fs::path path = only(part, with);
    const std::string relative = part + "/" + path.filename().string();
    writeFileAtomically(root / "outside", readFile(path));
    for (const std::string& to : {std::string("../outside"), (root / "outside").string()}) {
      replaceIn(json(), "\"" + relative + "\"", "\"" + to + "\"");
      EXPECT_TRUE(says(errorOfOpening(), "leaves the workspace's folder")) << errorOfOpening();
      writeFileAtomically(json(), good);
    }
    fs::rename(path, root / "kept");
    fs::create_symlink(root / "outside", path);
    EXPECT_TRUE(says(errorOfOpening(), "leaves the workspace's folder")) << errorOfOpening();
    fs::remove(path);
    fs::rename(root / "kept", path);
  }
  replaceIn(json(), "\"journal-1.jsonl\"", "\"../journal-1.jsonl\"");
  EXPECT_TRUE(says(errorOfOpening(), "leaves the workspace's folder"));
  EXPECT_TRUE(says(errorOf([&] { loadState(folder, "../outside-0123456789abcdef.json"); }),
                   "leaves the workspace's folder"));
}

TEST_F(HistoryTest, ChangesNothingBehindALink) {
  const fs::path others = root / "others", file = others / "cup-0123456789abcdef.ply",
                 bare = root / "bare";
  fs::create_directories(others);
  writeFileAtomically(file, "another workspace's");
  saveWorkspace(sceneWithObjects(0.01), bare);
  fs::remove_all(bare / "paint");
  fs::create_directory_symlink(others, bare / "paint");
  EXPECT_THROW(saveWorkspace(sceneWithObjects(0.02), bare), FileError);
  EXPECT_TRUE(fs::exists(file));
}

TEST_F(HistoryTest, KeepsAnotherProgramsHistory) {
  const OpenedWorkspace found = openWorkspace(folder);
  JournalWriter held(found.journal_file, 3);
  EXPECT_TRUE(says(errorOf([&] { saveWorkspace(start, folder); }), "another program is writing"));
  saveWorkspace(start, 3, found.states, folder); // its own history
}

TEST_F(HistoryTest, IsReadWhileAnotherProgramSavesIt) {
  std::atomic<bool> ends{false};
  std::thread writer([&] {
    for (unsigned i = 0; !ends; ++i)
      saveWorkspace(paintedScene(0.05, 3 + i % 2, With::all), folder);
  });
  for (int i = 0; i < 200; ++i) EXPECT_EQ(errorOfOpening(), "");
  ends = true;
  writer.join();
}

TEST_F(HistoryTest, OldEditorDoesNotOverwriteAReplacedWorkspace) {
  const OpenedWorkspace found = openWorkspace(folder);
  saveWorkspace(sceneWithObjects(0.02), folder);
  EXPECT_NE(errorOf([&] { saveWorkspace(later, 2, found.states, folder); }), "");
  EXPECT_TRUE(same(openWorkspace(folder).scene, sceneWithObjects(0.02)));
}

TEST_F(HistoryTest, UpgradesVersionOne) {
  fs::remove_all(folder);
  const Scene scene = sceneWithObjects(0.05);
  saveWorkspace(scene, folder);
  // Version 1 wrote no history and 8 digits in names.
  std::string text = readFile(json());
  text.replace(text.find("\"version\": 3"), 12, "\"version\": 1");
  text.resize(text.find(",\n  \"event\""));
  for (const auto& item : fs::directory_iterator(folder / "meshes")) {
    const std::string name = item.path().filename();
    const std::string shorter = name.substr(0, name.size() - 12) + ".ply";
    text.replace(text.find(name), name.size(), shorter);
    fs::rename(item.path(), folder / "meshes" / shorter);
  }
  writeFileAtomically(json(), text + "\n}\n");
  fs::remove_all(folder / "states");
  fs::remove(journal());

  const OpenedWorkspace found = openWorkspace(folder);
  EXPECT_TRUE(same(found.scene, scene));
  EXPECT_TRUE(found.states.empty() && found.journal.empty() && found.journal_file.empty());
  saveWorkspace(found.scene, folder);
  EXPECT_TRUE(same(openWorkspace(folder).scene, scene));
  EXPECT_EQ(filesIn("meshes"), 2u);
}

// Version 2: contact had a potential in place of a proxy, and a side that could be switched off.
TEST_F(HistoryTest, OpensVersionTwoWithThePresentContact) {
  const auto asVersionTwo = [](std::string text) {
    text.replace(text.find("\"version\": 3"), 12, "\"version\": 2");
    const std::string_view key = "\"values\": {";
    text.insert(text.find(key) + key.size(), R"("contact": "potential", "history": "off", )");
    return text;
  };
  writeFileAtomically(json(), asVersionTwo(readFile(json())));
  const std::string text = asVersionTwo(readFile(folder / state));
  const std::string old_state = "states/2-" + sha256(text).substr(0, 16) + ".json";
  writeFileAtomically(folder / old_state, text);
  const OpenedWorkspace found = openWorkspace(folder);
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.scene.haptics.contact, HapticProperties::Contact::proxy);
  EXPECT_TRUE(same(loadState(folder, old_state), later));
  saveWorkspace(found.scene, found.event, found.states, folder);
  EXPECT_FALSE(says(readFile(json()), "potential"));
  EXPECT_TRUE(same(openWorkspace(folder).scene, later));
}

TEST_F(HistoryTest, PresentVersionRefusesOlderKeys) {
  std::string text = readFile(json());
  const std::string_view key = "\"values\": {";
  text.insert(text.find(key) + key.size(), R"("history": "off", )");
  writeFileAtomically(json(), text);
  EXPECT_TRUE(says(errorOfOpening(), "unknown key 'history'"));
}

class RecoverTest : public HistoryTest {
 protected:
  OpenedWorkspace recovered() const {
    const auto before = files();
    OpenedWorkspace found = openWorkspace(folder, true);
    EXPECT_EQ(files(), before); // nothing on disk is changed
    EXPECT_FALSE(found.notes.empty());
    return found;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> list;
    for (const auto& item : fs::recursive_directory_iterator(folder)) list.push_back(item.path());
    return list;
  }
};

TEST_F(RecoverTest, OpensAnIntactWorkspaceNormally) {
  const OpenedWorkspace found = openWorkspace(folder, true);
  EXPECT_TRUE(found.notes.empty());
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.journal.size(), 3u);
}

TEST_F(RecoverTest, KeepsRecordsBeforeTheDamageIfTheyIncludeTheSavedOnes) {
  const std::string text = readFile(journal());
  std::string damaged = text;
  damaged[text.find("\"undo\"")] = 'x';
  writeFileAtomically(journal(), damaged);
  const OpenedWorkspace found = recovered();
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.journal.size(), 2u);
  JournalWriter(found.journal_file, 2).append(RedoEvent{}); // appending goes on
  EXPECT_EQ(openWorkspace(folder).journal.size(), 3u);
}

TEST_F(RecoverTest, KeepsTheSavedSceneWithoutAJournal) {
  fs::remove(journal());
  const OpenedWorkspace found = recovered();
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_TRUE(found.journal.empty() && found.states.empty() && found.journal_file.empty());
  saveWorkspace(found.scene, folder);
  EXPECT_TRUE(same(openWorkspace(folder).scene, later));
}

TEST_F(RecoverTest, RebuildsABrokenSceneFromAStateAndTheJournal) {
  fs::resize_file(only("paint", "color"), 100);
  const OpenedWorkspace found = recovered();
  EXPECT_TRUE(same(found.scene, start));
  EXPECT_EQ(found.event, 0u); // all three records are to be applied
  EXPECT_EQ(found.journal.size(), 3u);
}

TEST_F(RecoverTest, KeepsIntactPartsWithoutAHistory) {
  fs::remove(journal());
  fs::resize_file(only("paint", "color"), 100);
  fs::remove(only("meshes", "crate"));
  const OpenedWorkspace found = recovered();
  ASSERT_EQ(found.scene.objects.size(), 1u);
  EXPECT_EQ(found.scene.objects[0].paint->color, nullptr);
  EXPECT_TRUE(same(*found.scene.objects[0].paint->relief, *later.objects[0].paint->relief));
  EXPECT_TRUE(same(*found.scene.objects[0].paint->material, *later.objects[0].paint->material));
}

TEST_F(RecoverTest, KeepsJournalAndStatesWithoutWorkspaceJson) {
  writeFileAtomically(json(), "{");
  const OpenedWorkspace found = recovered();
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.event, 2u);
  EXPECT_EQ(found.journal.size(), 3u);
  saveWorkspace(found.scene, 3, found.states, folder); // the history goes on
  EXPECT_EQ(openWorkspace(folder).journal.size(), 3u);
}

TEST_F(RecoverTest, KeepsTheNewestStateWithoutBoth) {
  fs::remove(json());
  fs::remove(journal());
  const OpenedWorkspace found = recovered();
  EXPECT_TRUE(same(found.scene, later));
  EXPECT_EQ(found.event, 0u);
}

TEST_F(RecoverTest, ReportsThatNothingIsReadable) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  EXPECT_TRUE(says(errorOf([&] { openWorkspace(folder, true); }), "nothing was recovered"));
}

} // namespace
} // namespace patina
