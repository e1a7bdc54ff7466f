// patina undo and redo: bit for bit, across processes, over every kind of edit.
#include <ctime>

#include "core/utc_time.h"
#include "integration/painted.h"

namespace patina::test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

class History : public Painted {};

TEST_F(History, UndoAndRedoRestoreEverySceneBitwise) {
  std::vector<Scene> scenes{loadWorkspace(workspace)};
  const Stroke strokes[] = {
      stroke(Tool::material(MaterialChannel::stiffness), 900, 0.006, {{0, 0, kTop}}),
      stroke(Tool::relief, 5e-4, 0.008, {{0, 0, kTop}, {0.01, 0, kTop}}),
      stroke(Tool::color, 0, 0.005, {{0.02, 0, kTop}}),
      stroke(Tool::material(MaterialChannel::dynamic_friction), 0.3, 0.006, {{0, 0.01, kTop}})};
  for (const Stroke& one : strokes) {
    ASSERT_EQ(run({"paint", workspace, "--strokes", script("s.json", {one}), "-o", workspace}).exit,
              0);
    scenes.push_back(loadWorkspace(workspace));
    ASSERT_FALSE(same(scenes.back(), scenes[scenes.size() - 2]));
  }
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "stiffness=700"}).exit, 0);
  scenes.push_back(loadWorkspace(workspace));
  const std::string aside = folder.write("aside.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(run({"scene", "-o", workspace, "--add", box + "@" + aside}).exit, 0);
  scenes.push_back(loadWorkspace(workspace));
  ASSERT_EQ(scenes.back().objects.size(), 2U);

  for (std::size_t i = scenes.size() - 1; i-- > 0;) {
    const Json report = runJson({"undo", workspace});
    EXPECT_EQ(report.at("undone").asInteger(), 1);
    EXPECT_EQ(report.at("history").asInteger(), static_cast<std::int64_t>(i));
    EXPECT_EQ(report.at("redo").asInteger(), static_cast<std::int64_t>(scenes.size() - 1 - i));
    EXPECT_TRUE(same(loadWorkspace(workspace), scenes[i])) << i;
  }
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    EXPECT_EQ(runJson({"redo", workspace}).at("redone").asInteger(), 1);
    EXPECT_TRUE(same(loadWorkspace(workspace), scenes[i])) << i;
  }
  EXPECT_EQ(runJson({"undo", workspace, "--steps", "4"}).at("undone").asInteger(), 4);
  EXPECT_TRUE(same(loadWorkspace(workspace), scenes[2]));
  EXPECT_EQ(runJson({"redo", workspace, "--steps", "3"}).at("redone").asInteger(), 3);
  EXPECT_TRUE(same(loadWorkspace(workspace), scenes[5]));
}

TEST_F(History, ReportsNothingToUndoAndChangesNothing) {
  const std::string before = fingerprint(workspace);
  for (const char* command : {"undo", "redo"}) {
    const Outcome outcome = run({command, workspace, "--json"});
    EXPECT_EQ(outcome.exit, 0);
    EXPECT_NE(outcome.err.find("there is nothing to"), std::string::npos);
    const Json report = parseJson(outcome.out, "stdout");
    for (const char* key : {"history", "redo", "undone", "redone"})
      EXPECT_EQ(report.at(key).asInteger(), 0) << key;
  }
  EXPECT_EQ(fingerprint(workspace), before);
}

TEST_F(History, SurplusStepsUndoAll) {
  const Scene start = loadWorkspace(workspace);
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  EXPECT_EQ(runJson({"undo", workspace, "--steps", "99"}).at("undone").asInteger(), 3);
  EXPECT_TRUE(same(loadWorkspace(workspace), start));
  EXPECT_EQ(runJson({"redo", workspace, "--steps", "99"}).at("redone").asInteger(), 3);
  expectOneLineError(run({"undo", workspace, "--steps", "0"}), {"--steps"});
  expectOneLineError(run({"undo", workspace, "--steps", "-1"}), {"--steps"});
}

TEST_F(History, ListNamesEveryEditAndMarksUndoneOnes) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "stiffness=700"}).exit, 0);
  ASSERT_EQ(run({"undo", workspace}).exit, 0);
  const std::string before = fingerprint(workspace);
  const Json list = runJson({"undo", workspace, "--list"});
  const auto& edits = list.at("edits").asArray();
  ASSERT_EQ(edits.size(), 4U);
  EXPECT_EQ(edits[0].at("what").asString(), "stiffness 900 N/m, 6 mm");
  EXPECT_EQ(edits[1].at("what").asString(), "relief 0.5 mm, 8 mm");
  EXPECT_EQ(edits[3].at("what").asString(), "stiffness = 700");
  EXPECT_TRUE(edits[2].at("done").asBool());
  EXPECT_FALSE(edits[3].at("done").asBool());
  EXPECT_EQ(list.at("undone").asInteger(), 0);
  EXPECT_NE(run({"redo", workspace, "--list"}).out.find("stiffness = 700  (undone)"),
            std::string::npos);
  EXPECT_EQ(fingerprint(workspace), before);
}

TEST_F(History, ListShowsTheTimeOfEachEditIfTheJournalHasIt) {
  const auto paintAt = [&](const char* clock) { // builds set the clock by this variable
    const Environment fixed(Settings{{"SOURCE_DATE_EPOCH", clock}});
    ASSERT_EQ(
        run({"scene", "-o", workspace, "--set", "stiffness=70" + std::string(1, *clock)}).exit, 0);
  };
  paintAt("0"); // a record of an older version has no time
  paintAt("1795597607");
  const std::int64_t before = std::time(nullptr);
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "copy"}).exit, 0);
  const Json list = runJson({"undo", folder / "copy", "--list"}); // a copy keeps the times
  const auto& edits = list.at("edits").asArray();
  ASSERT_EQ(edits.size(), 5U);
  EXPECT_FALSE(edits[0].find("time"));
  EXPECT_EQ(list.at("untimed").asInteger(), 1);
  EXPECT_EQ(edits[1].at("time").asString(), "2026-11-25T09:06:47Z");
  EXPECT_GE(edits[2].at("time").asString(), formatUtc(before));
  EXPECT_LE(edits[4].at("time").asString(), formatUtc(std::time(nullptr)));
  const std::string text = run({"undo", folder / "copy", "--list"}).out;
  EXPECT_NE(text.find("2026-11-25T09:06:47Z  stiffness = 701"), std::string::npos) << text;
  EXPECT_NE(text.find("without a time  1"), std::string::npos) << text;
}

TEST_F(History, EditAfterUndoDropsUndoneEdits) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  ASSERT_EQ(run({"undo", workspace, "--steps", "2"}).exit, 0);
  ASSERT_EQ(run({"scene", "-o", workspace, "--set", "stiffness=700"}).exit, 0);
  const Json list = runJson({"redo", workspace, "--list"});
  EXPECT_EQ(list.at("edits").asArray().size(), 2U);
  EXPECT_EQ(list.at("redo").asInteger(), 0);
}

// The history goes with a copy, and each then has its own.
TEST_F(History, IsCopiedWithTheOutputOfPaint) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", folder / "a"}).exit, 0);
  const Scene painted = loadWorkspace(folder / "a");
  const std::string more = script(
      "more.json", {stroke(Tool::material(MaterialChannel::damping), 2, 0.006, {{0, 0, kTop}})});
  ASSERT_EQ(run({"paint", folder / "a", "--strokes", more, "-o", folder / "b"}).exit, 0);
  EXPECT_EQ(runJson({"undo", folder / "b"}).at("history").asInteger(), 3);
  EXPECT_TRUE(same(loadWorkspace(folder / "b"), painted));
  ASSERT_EQ(run({"undo", folder / "b", "--steps", "3"}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(folder / "b"), loadWorkspace(workspace)));
  EXPECT_TRUE(same(loadWorkspace(folder / "a"), painted));
}

// Version 1 had no history: it begins with the first edit.
TEST_F(History, IsAddedToAWorkspaceOfVersion1) {
  const std::string old = folder / "old";
  std::filesystem::create_directories(old + "/meshes");
  std::filesystem::copy(box, old + "/meshes/box.ply");
  folder.write("old/workspace.json",
               R"({"version": 1, "units": "SI", "objects": [{"name": "box", "mesh": )"
               R"("meshes/box.ply", "sha256": ")" +
                   sha256(readFile(box)) +
                   R"(", "world_from_object": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], )"
                   R"([0, 0, 0, 1]]}], "values": {"stiffness": 650}})");
  const Scene start = loadWorkspace(old);
  EXPECT_EQ(start.haptics.stiffness, 650);
  const std::string before = fingerprint(old);
  EXPECT_EQ(run({"undo", old}).exit, 0);
  EXPECT_EQ(run({"scene", "-o", old}).exit, 0);
  EXPECT_EQ(fingerprint(old), before);
  ASSERT_EQ(run({"scene", "-o", old, "--set", "stiffness=700"}).exit, 0);
  EXPECT_EQ(loadWorkspace(old).haptics.stiffness, 700);
  ASSERT_EQ(run({"undo", old}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(old), start));
}

TEST_F(History, NamesFoldersThatAreNoWorkspace) {
  expectOneLineError(run({"undo", box}), {"box.ply", "not a workspace"});
  expectOneLineError(run({"redo", folder / "none"}), {"none"});
}

// Damage is reported in one line and leaves the folder unchanged, and the intact part can be
// recovered elsewhere.
TEST_F(History, NamesDamagedJournalsAndTheSceneIsRecovered) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  const Scene painted = loadWorkspace(workspace);
  const std::filesystem::path journal = openWorkspace(workspace).journal_file;
  std::string text = readFile(journal);
  const std::size_t second = text.find("\"n\":2");
  ASSERT_NE(second, std::string::npos);
  text[text.find("radius", second)] = 'R';
  writeFileAtomically(journal, text);
  const std::string before = fingerprint(workspace);
  const std::string name = journal.filename().string();
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"undo", workspace},
           {"info", workspace},
           {"paint", workspace, "--strokes", three(), "-o", workspace},
           {"paint", workspace, "--strokes", journal.string(), "-o", folder / "out"},
           {"scene", "-o", workspace, "--set", "stiffness=700"}})
    expectOneLineError(run(words), {name + ":"});
  EXPECT_EQ(fingerprint(workspace), before);
  const Outcome recovered = run({"scene", "-o", folder / "whole", "--recover", workspace});
  EXPECT_EQ(recovered.exit, 1) << "the damaged steps are lost: " << recovered.err;
  EXPECT_NE(recovered.err.find(name), std::string::npos) << recovered.err;
  EXPECT_TRUE(same(loadWorkspace(folder / "whole"), painted));
  EXPECT_EQ(fingerprint(workspace), before);
  EXPECT_EQ(run({"paint", folder / "whole", "--strokes", three(), "-o", folder / "whole"}).exit, 0);
}

TEST_F(History, LeavesOutATornLastRecordWithANote) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  const Scene painted = loadWorkspace(workspace);
  const std::filesystem::path journal = openWorkspace(workspace).journal_file;
  writeFileAtomically(journal, readFile(journal) + "{\"n\":4,\"stro");
  const Outcome info = run({"info", workspace});
  EXPECT_EQ(info.exit, 0);
  EXPECT_NE(info.err.find("warning"), std::string::npos) << info.err;
  EXPECT_EQ(run({"scene", "-o", workspace, "--set", "stiffness=700"}).exit, 0);
  ASSERT_EQ(run({"undo", workspace}).exit, 0);
  EXPECT_TRUE(same(loadWorkspace(workspace), painted));
}

TEST_F(History, RefusesWrongHashesAndOutsidePathsWithoutChanges) {
  ASSERT_EQ(run({"paint", workspace, "--strokes", three(), "-o", workspace}).exit, 0);
  const std::string manifest = workspace + "/workspace.json", whole = readFile(manifest);
  const auto tryWith = [&](const std::string& text, const std::vector<std::string>& parts) {
    writeFileAtomically(manifest, text);
    const std::string before = fingerprint(workspace);
    for (const auto& words : std::vector<std::vector<std::string>>{
             {"undo", workspace},
             {"info", workspace},
             {"paint", workspace, "--strokes", three(), "-o", workspace}})
      expectOneLineError(run(words), parts);
    EXPECT_EQ(fingerprint(workspace), before);
  };
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  tryWith(replaced("\"version\": 3", "\"version\": 77"), {"version", "77"});
  tryWith(replaced("meshes/", "../meshes/"), {"../meshes"});
  tryWith(replaced("\"sha256\": \"", "\"sha256\": \"0"), {"workspace.json"});
  writeFileAtomically(manifest, whole);
  for (const auto& item : std::filesystem::directory_iterator(workspace + "/paint")) {
    std::string bytes = readFile(item.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    writeFileAtomically(item.path(), bytes);
  }
  expectOneLineError(run({"info", workspace}), {"SHA-256"});
  // The history does not need the painted files: they are painted again.
  const Outcome recovered = run({"scene", "-o", folder / "whole", "--recover", workspace});
  EXPECT_EQ(recovered.exit, 1) << "files were damaged: " << recovered.err;
  EXPECT_EQ(recovered.err.find("left out"), std::string::npos) << recovered.err;
}

// A list shows the edits; it does not need pictures and meshes, readable or not.
TEST_F(History, ListReadsNoPicture) {
  const std::string strokes = script("s.json", {stroke(Tool::color, 0, 0.005, {{0.02, 0, kTop}})});
  ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
  const std::string before = run({"undo", workspace, "--list"}).out;
  EXPECT_NE(before.find("1  "), std::string::npos);
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(workspace) / "paint"))
    std::filesystem::resize_file(file.path(), 1);
  const Outcome list = run({"undo", workspace, "--list"});
  EXPECT_EQ(list.exit, 0) << list.err;
  EXPECT_EQ(list.out, before);
  EXPECT_EQ(run({"undo", workspace}).exit, 2);
}

// The same strokes on the same mesh: every file, byte for byte.
TEST_F(History, TwoReplaysOfAJournalGiveTheSameFiles) {
  const Environment fixed(
      Settings{{"SOURCE_DATE_EPOCH", "1795597607"}}); // the journal contains the time
  const std::string strokes = script(
      "s.json", {stroke(Tool::color, 0, 0.005, {{0.02, 0, kTop}}),
                 stroke(Tool::relief, 5e-4, 0.008, {{0, 0, kTop}, {0.01, 0, kTop}}),
                 stroke(Tool::material(MaterialChannel::stiffness), 900, 0.006, {{0, 0, kTop}})});
  ASSERT_EQ(run({"paint", box, "--strokes", strokes, "-o", folder / "first"}).exit, 0);
  const std::string journal = folder / "first/journal-1.jsonl";
  for (const char* replay : {"a", "b"})
    ASSERT_EQ(run({"paint", box, "--strokes", journal, "-o", folder / replay}).exit, 0);
  EXPECT_EQ(fingerprint(folder / "a"), fingerprint(folder / "b"));
  EXPECT_EQ(fingerprint(folder / "a"), fingerprint(folder / "first"));
}

} // namespace
} // namespace patina::test
