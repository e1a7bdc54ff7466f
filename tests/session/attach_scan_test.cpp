// A scan folder becomes part of a scene: each step is an edit with undo, and frames of another scan
// are detected.
#include "session/store/attach_scan.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "session/edit_desk.h"
#include "support/fresh_folder.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class AttachScan : public testing::Test {
 protected:
  AttachScan() : root_(test::freshFolder("attach")) {
    fs::create_directories(scan() / "frames");
    write("frames/000000.png", "one");
    write("frames/000001.png", "two");
    write("frames.csv", "frame,t [s]\n0,0\n1,0.03\n");
    write("rig.json", "{\"tip\": [0, 0, -0.1]}\n");
    write("notes.txt", "mine");
  }
  ~AttachScan() override { fs::remove_all(root_); }
  fs::path scan() const { return root_ / "rim"; }
  void write(const std::string& file, const std::string& text) const {
    writeFileAtomically(scan() / file, text);
  }
  std::string errorOf(const SceneScan& of) const {
    try {
      requireFrames(of);
      return "";
    } catch (const FileError& error) {
      return error.what();
    }
  }
  SceneEdit edit(const Editor& editor, const SceneScan& after) const {
    return {describeChange(findScan(editor.scene(), after.name), after),
            std::make_shared<const Scene>(withScan(editor.scene(), after))};
  }

  fs::path root_;
  Progress progress_;
};

TEST_F(AttachScan, CopiesFilesAndReferencesFrames) {
  const SceneScan found = readScanFiles(scan(), "rim");
  EXPECT_EQ(found.files.size(), 2u);
  EXPECT_EQ(*found.text("rig.json"), readFile(scan() / "rig.json"));
  EXPECT_EQ(found.folder, scan());
  EXPECT_EQ(errorOf(found), "");
  EXPECT_THROW(readScanFiles(root_ / "none", "x"), FileError);
  EXPECT_THROW(readScanFiles(scan() / "frames", "x"), FileError); // pictures alone
}

TEST_F(AttachScan, ReportsOtherFramesAndAMissingFolderInOneLine) {
  const SceneScan found = readScanFiles(scan(), "rim");
  const auto isOneLine = [](const std::string& line, const char* part) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_NE(line.find("'rim'"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  };
  write("frames/000001.png", "longer");
  isOneLine(errorOf(found), "other frames");
  write("frames/000001.png", "two");
  EXPECT_EQ(errorOf(found), "");
  write("frames.csv", "frame,t [s]\n0,0\n1,0.04\n");
  isOneLine(errorOf(found), "other frames");
  fs::rename(scan(), root_ / "away");
  isOneLine(errorOf(found), "is gone");
}

TEST_F(AttachScan, EveryStepIsAnEditWithoutHapticEffect) {
  const fs::path workspace = root_ / "workspace";
  saveWorkspace(test::oneBall(), workspace);
  const auto editor = Editor::open(workspace, {}, progress_);
  const auto field = editor->compiled()->built.field;
  std::vector<SceneScan> steps{readScanFiles(scan(), "rim")};
  for (const char* file : {"poses.tum", "path.csv", "registered.txt"}) {
    write(file, std::string("text of ") + file);
    steps.push_back(readScanFiles(scan(), "rim"));
  }
  for (const SceneScan& step : steps) editor->apply(edit(*editor, step), progress_);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < editor->history().undoable(); ++i)
    words.push_back(describe(editor->history().edit(i)));
  EXPECT_EQ(words, (std::vector<std::string>{"attach scan rim", "track scan rim", "filter scan rim",
                                             "register scan rim"}));
  for (std::size_t i = steps.size(); i-- > 1;) {
    EXPECT_EQ(editor->scene().scans, std::vector<SceneScan>{steps[i]});
    ASSERT_EQ(editor->undo(1, progress_), 1u);
  }
  editor->undo(1, progress_);
  EXPECT_TRUE(editor->scene().scans.empty());
  editor->redo(4, progress_);
  EXPECT_EQ(editor->scene().scans, std::vector<SceneScan>{steps.back()});
  EXPECT_EQ(editor->compiled()->built.field, field); // identical, not only equal
}

TEST_F(AttachScan, JournalRestoresTheScanAndRemovalCanBeUndone) {
  const fs::path workspace = root_ / "workspace";
  saveWorkspace(test::oneBall(), workspace);
  const SceneScan found = readScanFiles(scan(), "rim");
  {
    const auto editor = Editor::open(workspace, {}, progress_);
    editor->apply(edit(*editor, found), progress_); // ends without saving
  }
  const auto editor = Editor::open(workspace, {}, progress_);
  EXPECT_EQ(editor->scene().scans, std::vector<SceneScan>{found});
  editor->apply(SceneEdit{"remove scan rim",
                          std::make_shared<const Scene>(withoutScan(editor->scene(), "rim"))},
                progress_);
  editor->save();
  EXPECT_TRUE(loadWorkspace(workspace).scans.empty());
  editor->undo(1, progress_);
  editor->save();
  EXPECT_EQ(loadWorkspace(workspace).scans, std::vector<SceneScan>{found});
  EXPECT_TRUE(fs::exists(scan() / "frames" / "000000.png"));
}

} // namespace
} // namespace patina
