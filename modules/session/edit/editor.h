// The one place where a scene is edited: history, journal, and what the servo feels of it. Belongs
// to one thread (the edit thread of the window, or the command line's).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "authoring/brush/painter.h"
#include "session/build/compile_scene.h"
#include "session/edit/edit_history.h"

namespace patina {

struct EditorNotice {
  std::shared_ptr<const CompiledScene> compiled; // never null
  // Only paint changed, and only there: what to draw anew. Absent: anything may have changed.
  std::optional<std::vector<PaintChange>> changes;
};

class Editor {
 public:
  // Called on the editor's thread whenever there is something new to feel and to draw. Publishing
  // the snapshot is the listener's, so that nothing lies between a dab and the servo.
  using Listener = std::function<void(const EditorNotice&)>;

  // A scene without a folder: its history lives in memory until saveAs().
  Editor(Scene scene, Progress& progress, Listener listener = {},
         std::size_t history_budget = kHistoryBudget);
  // A workspace. Edits that were journaled but not saved are applied. Its own: the journal is
  // locked and every edit is in it when its call returns. Otherwise the folder is only read, and
  // saveAs() gives the editor a folder.
  struct OpenSpec {
    bool own = true;
    bool recover = false; // see openWorkspace()
    std::size_t history_budget = kHistoryBudget;
  };
  static std::unique_ptr<Editor> open(const std::filesystem::path& folder, const OpenSpec& spec,
                                      Progress& progress, Listener listener = {});
  ~Editor();

  std::shared_ptr<const CompiledScene> compiled() const;
  const Scene& scene() const; // as it is, a stroke in progress included
  const EditHistory& history() const;
  const std::vector<std::string>& notes() const; // what opening found
  bool unsaved() const;
  // Where in the history the workspace was saved when it was opened; absent: it is not there.
  std::optional<std::size_t> savedBefore() const;

  // A stroke. Between begin and end other edits throw invalid_argument. prepare() does beforehand
  // what the first stroke with a tool would have to wait for.
  void prepare(Tool tool, Progress& progress);
  void beginStroke(const Brush& brush, Progress& progress);
  // Felt when it returns. A sample that is not finite paints nothing and is not recorded; a time
  // before the last one's counts as that. Throws Error, and takes the whole stroke back, if what
  // would be felt does not fit into a field.
  PaintReport dab(const StrokeSample& sample);
  // Journaled when it returns; false = it touched nothing and is no edit. If it cannot be journaled
  // the stroke is taken back and FileError thrown.
  bool endStroke();
  void cancelStroke(); // as it was before
  bool inStroke() const;

  // Each throws Error and changes nothing if it makes no sense or cannot be journaled.
  PaintReport apply(const Stroke& stroke, Progress& progress,
                    std::vector<double>* dab_seconds = nullptr);
  void apply(const ValueEdit& edit, Progress& progress);
  void apply(const SceneEdit& edit, Progress& progress);
  std::size_t undo(std::size_t steps, Progress& progress); // how many were undone
  std::size_t redo(std::size_t steps, Progress& progress);

  // The workspace with its history, into its own folder (invalid_argument without one) or into
  // another, which is then its own.
  void save();
  void saveAs(const std::filesystem::path& folder);
  // Back to the workspace as it was saved: scene and history, and what was to be redone.
  // invalid_argument without a folder or in a stroke; if it throws otherwise nothing has changed.
  void revert(Progress& progress);
  std::optional<std::filesystem::path> folder() const;

 private:
  struct Impl;
  explicit Editor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
