// Edits a scene: history, journal and compiled scene. One thread uses it (the edit thread of the
// window, or the command line's).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "authoring/brush/painter.h"
#include "session/compile/compile_scene.h"
#include "session/store/edit_history.h"

namespace patina {

struct EditorNotice {
  std::shared_ptr<const CompiledScene> compiled; // never null
  // Tiles to redraw if only paint changed. Absent: anything may have changed.
  std::optional<std::vector<PaintChange>> changes;
};

class Editor {
 public:
  // Called on the editor's thread for each new compiled scene. The listener publishes the snapshot,
  // so that nothing comes between a dab and the servo.
  using Listener = std::function<void(const EditorNotice&)>;

  // A scene without a folder: its history is in memory until saveAs().
  Editor(Scene scene, Progress& progress, Listener listener = {},
         std::size_t history_budget = kHistoryBudget);
  // Opens a workspace and applies edits that were journaled but not saved. own: the journal is
  // locked and contains every edit when its call returns. Otherwise the folder is only read, and
  // saveAs() gives the editor a folder.
  struct OpenSpec {
    bool own = true;
    bool recover = false; // see openWorkspace()
    std::size_t history_budget = kHistoryBudget;
    // Edits are journaled together by commit(), all or none, and not each when its call returns.
    bool all_or_none = false;
    std::string intent{}; // the caller's name of the command, kept in the journal
  };
  static std::unique_ptr<Editor> open(const std::filesystem::path& folder, const OpenSpec& spec,
                                      Progress& progress, Listener listener = {});
  ~Editor();

  std::shared_ptr<const CompiledScene> compiled() const;
  const Scene& scene() const; // with the stroke in progress
  const EditHistory& history() const;
  const std::vector<std::string>& notes() const; // from opening
  bool isRepeated() const; // the journal had OpenSpec::intent when it was opened
  bool unsaved() const;
  // History position of the last save before opening; absent: not in the history.
  std::optional<std::size_t> savedPosition() const;

  // A stroke. Other edits throw invalid_argument between begin and end. prepare() does the slow
  // work in advance that the first stroke with a tool needs.
  void prepare(Tool tool, Progress& progress);
  void beginStroke(const Brush& brush, Progress& progress);
  // Rendered when it returns. A sample that is not finite paints nothing and is not recorded; a
  // time before the last one's is raised to it. Throws Error and removes the whole stroke if the
  // result does not fit into a field.
  PaintReport dab(const StrokeSample& sample);
  // Journaled when it returns. Returns false if the paint is as before; then there is no edit. If the
  // journal cannot be written, it removes the stroke and throws FileError.
  bool endStroke();
  void cancelStroke(); // restores the scene before the stroke
  bool inStroke() const;

  // Each throws Error and changes nothing if the edit is invalid or cannot be journaled.
  PaintReport apply(const Stroke& stroke, Progress& progress,
                    std::vector<double>* dab_seconds = nullptr);
  void apply(const ValueEdit& edit, Progress& progress);
  void apply(const SceneEdit& edit, Progress& progress);
  std::size_t undo(std::size_t steps, Progress& progress); // returns how many were undone
  std::size_t redo(std::size_t steps, Progress& progress);

  void commit(); // see OpenSpec::all_or_none
  // Writes the workspace with its history, into its own folder (invalid_argument without one) or
  // into another, which becomes its own.
  void save();
  void saveAs(const std::filesystem::path& folder, const std::string& intent = {});
  // Returns to the workspace as it was saved, with its history and its redo steps. Throws
  // invalid_argument without a folder or in a stroke; any other throw leaves everything unchanged.
  void revert(Progress& progress);
  std::optional<std::filesystem::path> folder() const;

 private:
  struct Impl;
  explicit Editor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
