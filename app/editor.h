// The one place where a scene is edited: history, journal, and what the servo feels of it. Belongs
// to one thread (the edit thread of the window, or the command line's).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/compile_scene.h"
#include "app/edit_history.h"
#include "authoring/painter.h"

namespace patina {

inline constexpr std::size_t kHistoryBudget = 512u << 20; // bytes of painted scenes kept for undo

struct EditorNotice {
  std::shared_ptr<const CompiledScene> compiled; // never null
  std::vector<PaintChange> changes; // what to draw anew; empty and !repaint: values or objects
  bool repaint = false;             // only paint changed, and only where `changes` says
};

class Editor {
 public:
  // Called on the editor's thread whenever there is something new to feel and to draw; publishing
  // the snapshot is the listener's, so that nothing lies between a dab and the servo.
  using Listener = std::function<void(const EditorNotice&)>;

  // A scene without a folder: its history lives in memory until saveAs().
  Editor(Scene scene, Progress& progress, Listener listener = {});
  // A workspace: edits that were journaled but not saved are applied. Locks its journal.
  static std::unique_ptr<Editor> open(const std::filesystem::path& folder, Progress& progress,
                                      Listener listener = {}, bool recover = false);
  ~Editor();

  std::shared_ptr<const CompiledScene> compiled() const;
  const Scene& scene() const;
  const EditHistory& history() const;
  const std::vector<std::string>& notes() const; // what opening found
  bool unsaved() const;

  // A stroke. Between begin and end other edits throw invalid_argument. prepare() does beforehand
  // what the first stroke with a tool would have to wait for.
  void prepare(Tool tool, Progress& progress);
  void beginStroke(const Brush& brush, Progress& progress);
  PaintReport dab(const StrokeSample& sample); // felt when it returns
  void endStroke();    // journaled when it returns; a stroke that touched nothing is no edit
  void cancelStroke(); // as it was before

  void apply(const Stroke& stroke, Progress& progress, PaintReport* report = nullptr,
             std::vector<double>* dab_seconds = nullptr);
  void apply(const ValueEdit& edit, Progress& progress);
  void apply(const SceneEdit& edit, Progress& progress);
  std::size_t undo(std::size_t steps, Progress& progress); // how many could be undone
  std::size_t redo(std::size_t steps, Progress& progress);

  // Into its own folder, or a new one, which is then its own: the workspace, with its history.
  void save();
  void saveAs(const std::filesystem::path& folder);
  const std::optional<std::filesystem::path>& folder() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
