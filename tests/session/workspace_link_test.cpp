// An editor in a folder: another process restores its journal and states.
#include "session/store/workspace_storage.h"

#include <gtest/gtest.h>

#include <map>

#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "session/edit/editor.h"
#include "session/open/session.h"
#include "session/painted_scenes.h"
#include "session/store/journal_fold.h"
#include "session/store/replay.h"
#include "support/fresh_folder.h"
#include "support/places.h"

namespace patina {
namespace {

using namespace test;
namespace fs = std::filesystem;

class Links : public testing::Test {
 protected:
  void SetUp() override { saveWorkspace(ballScene(), folder); }
  void TearDown() override { fs::remove_all(root); }

  std::unique_ptr<Editor> open(bool own = true) {
    Editor::OpenSpec spec;
    spec.own = own;
    return Editor::open(folder, spec, progress);
  }
  Scene read(const fs::path& path) { return openScene(path, {}).scene; }

  const fs::path root = test::freshFolder("link");
  const fs::path folder = root / "ball";
  Progress progress;
};

// The history begins with the first edit, and only one program begins it.
TEST_F(Links, WorkspaceWithoutHistoryIsUnchangedUntilEdited) {
  fs::remove_all(folder);
  fs::copy(sourceFolder() / "data" / "scenes" / "pottery", folder, fs::copy_options::recursive);
  const auto contents = [&] {
    std::map<std::string, std::string> files;
    for (const auto& file : fs::recursive_directory_iterator(folder))
      files[file.path()] = file.is_regular_file() ? readFile(file.path()) : "";
    return files;
  };
  const auto before = contents();
  auto one = open();
  const auto other = open();
  EXPECT_EQ(contents(), before);
  one->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
  EXPECT_NE(contents(), before);
  EXPECT_THROW(other->apply(ValueEdit{{{"stiffness", "650"}}}, progress), FileError);
  EXPECT_THROW(other->save(), FileError);
  const Scene last = one->scene();
  one.reset();
  EXPECT_TRUE(same(read(folder), last));
}

TEST_F(Links, EditsPersistWithoutASave) {
  Scene last;
  {
    const auto editor = open();
    for (const Stroke& one : manyStrokes(6)) editor->apply(one, progress);
    editor->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
    EXPECT_TRUE(editor->unsaved());
    last = editor->scene();
  }
  EXPECT_FALSE(same(loadWorkspace(folder), last)); // without a save
  EXPECT_TRUE(same(read(folder), last));
  const auto again = open();
  EXPECT_TRUE(again->unsaved());
  EXPECT_TRUE(same(again->scene(), last));
  again->save();
  EXPECT_FALSE(again->unsaved());
  EXPECT_TRUE(same(loadWorkspace(folder), last));
}

TEST_F(Links, UndoAndRedoContinueInAnotherProcess) {
  std::vector<Scene> scenes;
  std::size_t edits = 0;
  {
    const auto editor = open();
    scenes.push_back(editor->scene());
    for (const Stroke& one : manyStrokes(10)) {
      editor->apply(one, progress);
      if (editor->history().undoable() > edits) scenes.push_back(editor->scene());
      edits = editor->history().undoable();
    }
    editor->save();
    editor->undo(2, progress);
  }
  {
    const auto editor = open();
    EXPECT_EQ(editor->history().undoable(), edits - 2);
    EXPECT_EQ(editor->history().redoable(), 2U);
    EXPECT_TRUE(same(editor->scene(), scenes[edits - 2]));
    EXPECT_EQ(editor->redo(1, progress), 1U);
    EXPECT_TRUE(same(editor->scene(), scenes[edits - 1]));
    EXPECT_EQ(editor->undo(100, progress), edits - 1);
    EXPECT_TRUE(same(editor->scene(), scenes[0]));
  }
  const auto editor = open();
  EXPECT_EQ(editor->redo(100, progress), edits);
  EXPECT_TRUE(same(editor->scene(), scenes[edits]));
}

TEST_F(Links, WholeHistoryIsWrittenIntoAnotherFolder) {
  const fs::path other = root / "other";
  const auto editor = open();
  for (const Stroke& one : manyStrokes(5)) editor->apply(one, progress);
  Scene moved = editor->scene();
  moved.objects[0].world_from_object.translation() = Vec3(0.01, 0, 0);
  editor->apply(SceneEdit{"move ball", std::make_shared<const Scene>(moved)}, progress);
  editor->apply(dabAt(Tool::material(MaterialChannel::stiffness), 300, 0.008, Vec3(0.01, 0, kBall)),
                progress);
  const std::size_t edits = editor->history().undoable();
  const Scene last = editor->scene();
  editor->undo(1, progress);
  editor->saveAs(other);
  EXPECT_EQ(editor->folder(), other);
  Editor::OpenSpec reading;
  reading.own = false;
  const auto copy = Editor::open(other, reading, progress);
  EXPECT_EQ(copy->history().undoable(), edits - 1);
  EXPECT_EQ(copy->history().redoable(), 1U);
  EXPECT_TRUE(same(copy->scene(), editor->scene()));
  EXPECT_EQ(copy->redo(1, progress), 1U);
  EXPECT_TRUE(same(copy->scene(), last));
  EXPECT_EQ(copy->undo(100, progress), edits);
  EXPECT_TRUE(same(copy->scene(), ballScene()));
  EXPECT_FALSE(copy->folder()); // read only
}

TEST_F(Links, UnrelatedFolderIsNotWritten) {
  const fs::path other = root / "other";
  fs::create_directories(other);
  writeFileAtomically(other / "thesis.txt", "mine");
  const auto editor = open();
  EXPECT_THROW(editor->saveAs(other), FileError);
  EXPECT_EQ(std::distance(fs::directory_iterator(other), {}), 1);
  EXPECT_EQ(editor->folder(), folder); // the folder stays
  editor->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
  EXPECT_EQ(read(folder).haptics.stiffness, 640);
  fs::remove(other / "thesis.txt");
  editor->saveAs(other);
  EXPECT_EQ(read(other).haptics.stiffness, 640);
}

// Each editor stores scenes of its history before a file refers to them.
TEST_F(Links, TwoHistoriesWrittenIntoOneFolderLeaveOneOfThem) {
  const fs::path other = root / "other";
  const auto write = [&](double stiffness) {
    const auto none = [](const Scene& before, const Edit&) { return before; };
    EditHistory history(ballScene(), none, kHistoryBudget);
    for (int i = 0; i < 4; ++i) {
      auto scene = std::make_shared<Scene>(ballScene());
      scene->haptics.stiffness = stiffness + i;
      history.append(SceneEdit{"change", scene}, *scene);
    }
    WorkspaceStorage::overwrite(other, history);
  };
  for (int i = 0; i < 20; ++i) {
    fs::remove_all(other);
    std::vector<pid_t> children;
    for (const double stiffness : {300.0, 700.0}) {
      const pid_t child = ::fork();
      if (child == 0) {
        try {
          write(stiffness);
        } catch (const FileError&) {
        }
        ::_exit(0);
      }
      children.push_back(child);
    }
    for (const pid_t child : children) ::waitpid(child, nullptr, 0);
    OpenedWorkspace found;
    ASSERT_NO_THROW(found = openWorkspace(other)) << i;
    ASSERT_EQ(found.journal.size(), 4U);
    for (const JournalEvent& event : found.journal)
      ASSERT_NO_THROW(loadState(other, std::get<StoredSceneEdit>(event).state)) << i;
  }
}

// The number of events reveals another program's edits: an undo keeps the number of edits.
TEST_F(Links, EveryEventOfTheJournalCounts) {
  const auto read_only = [&] {
    return WorkspaceStorage::open(folder, Replayer(), kHistoryBudget, false, false);
  };
  const auto editor = open();
  editor->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
  const auto before = read_only();
  editor->undo(1, progress);
  const auto after = read_only();
  EXPECT_EQ(before.events, 1U);
  EXPECT_EQ(after.events, 2U);
  EXPECT_EQ(after.history->undoable() + after.history->redoable(), 1U);
}

// A recovered scene is saved, and its old folder is removed.
TEST_F(Links, PastScenesAreReadFromTheNewFolder) {
  Scene moved = ballScene();
  moved.objects[0].world_from_object.translation() = Vec3(0.01, 0, 0);
  {
    const auto editor = open();
    editor->apply(SceneEdit{"move ball", std::make_shared<const Scene>(moved)}, progress);
    editor->apply(
        dabAt(Tool::material(MaterialChannel::stiffness), 300, 0.008, Vec3(0.01, 0, kBall)),
        progress);
  }
  const auto editor = open();
  editor->saveAs(root / "other");
  fs::remove_all(folder);
  EXPECT_EQ(editor->undo(1, progress), 1U);
  EXPECT_TRUE(same(editor->scene(), moved));
}

// The kept scenes move with the present, and saving removes the files of the old ones.
TEST_F(Links, StateDroppedBySavingIsReplayed) {
  const auto paint = [&](Editor& editor, double stiffness) {
    Stroke stroke =
        dabAt(Tool::material(MaterialChannel::stiffness), stiffness, 0.006, Vec3(0, 0, kBall));
    stroke.samples.resize(300, stroke.samples[0]);
    editor.apply(stroke, progress);
  };
  Scene first;
  {
    const auto editor = open();
    paint(*editor, 600);
    first = editor->scene();
    paint(*editor, 700);
    editor->save();
  }
  ASSERT_EQ(openWorkspace(folder).states.back().event, 1U);
  const auto editor = open();
  paint(*editor, 800);
  paint(*editor, 900);
  editor->save();
  ASSERT_EQ(openWorkspace(folder).states.size(), 2U);
  ASSERT_EQ(openWorkspace(folder).states.back().event, 3U);
  EXPECT_EQ(editor->undo(3, progress), 3U);
  EXPECT_TRUE(same(editor->scene(), first));
  editor->save();
}

TEST_F(Links, FolderWithUnreadableHistoryIsNotWritten) {
  {
    const auto editor = open();
    editor->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
    editor->save();
  }
  const fs::path journal = openWorkspace(folder).journal_file;
  const std::string damaged = "#" + readFile(journal);
  writeFileAtomically(journal, damaged);
  Editor::OpenSpec spec;
  spec.recover = true;
  const auto editor = Editor::open(folder, spec, progress);
  EXPECT_EQ(editor->scene().haptics.stiffness, 640);
  EXPECT_FALSE(editor->folder());
  EXPECT_EQ(readFile(journal), damaged);
  editor->saveAs(root / "other");
  EXPECT_EQ(read(root / "other").haptics.stiffness, 640);
}

TEST_F(Links, JournalHasOneWriter) {
  const auto first = open();
  first->apply(ValueEdit{{{"stiffness", "640"}}}, progress);
  EXPECT_THROW(open(), FileError);
  const auto reader = open(false);
  EXPECT_EQ(reader->scene().haptics.stiffness, 640);
}

// The folder is gone: the edit is rejected and has no effect.
TEST_F(Links, EditsThatCannotBeJournaledAreUndone) {
  const auto editor = open();
  editor->apply(dabAt(Tool::relief, 3e-4, 0.01, Vec3(0, 0, kBall)), progress);
  const Scene before = editor->scene();
  Stroke endless = dabAt(Tool::relief, 3e-4, 0.01, Vec3(0, kBall, 0));
  endless.samples.push_back({1, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), 0});
  EXPECT_THROW(editor->apply(endless, progress), Error);
  EXPECT_TRUE(same(editor->scene(), before));
  EXPECT_EQ(editor->history().undoable(), 1U);
  EXPECT_FALSE(editor->inStroke());
}

TEST(JournalFold, KeepsTheEffectiveEditsAndTheirPositions) {
  const auto value = [](const char* text) { return ValueEdit{{{"stiffness", text}}}; };
  const std::vector<JournalEvent> journal{value("1"), value("2"),   value("3"),  UndoEvent{2},
                                          value("4"), UndoEvent{1}, RedoEvent{1}};
  const FoldedJournal fold = folded(journal, "j");
  ASSERT_EQ(fold.steps.size(), 2U);
  EXPECT_EQ(fold.steps[0].number, 1U);
  EXPECT_EQ(fold.steps[1].number, 5U);
  EXPECT_EQ(fold.steps[1].event, &journal[4]);
  EXPECT_EQ(fold.position, 2U);
  EXPECT_EQ(fold.position_at, (std::vector<std::size_t>{0, 1, 2, 3, 1, 2, 1, 2}));
}

TEST(JournalFold, UndoBeyondTheJournalIsRejectedByName) {
  for (const std::vector<JournalEvent>& journal :
       {std::vector<JournalEvent>{UndoEvent{1}}, {RedoEvent{1}}, {UndoEvent{-1}}}) {
    try {
      folded(journal, "j.jsonl");
      ADD_FAILURE();
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("j.jsonl: record 1"), std::string::npos);
    }
  }
}

} // namespace
} // namespace patina
