// What the edit thread does, one thing after another. Knows no threads.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/edit/edit_events.h"
#include "session/edit/editor.h"
#include "session/store/autosave.h"

namespace patina {

class EditWorker {
 public:
  EditWorker(EditEventBuffer& events, std::function<void(const CompiledScene&)> publish,
             std::filesystem::path autosave_root);

  void take(const EditorNotice& notice); // the editor's listener
  void adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave, bool unsaved);
  Editor& editor(); // throws Error without a scene

  void prepare(Tool tool, Progress& progress);
  void beginStroke(const Brush& brush, Progress& progress);
  void dabs(const std::vector<StrokeSample>& samples); // nothing outside a stroke
  void endStroke();                                    // nothing outside a stroke
  void cancelStroke();                                 // the same

  void tryValues(const std::function<void(Scene&)>& set); // felt, and no edit before settleValues()
  void settleValues(Progress& progress);
  bool hasValues() const { return tried_.has_value(); }

  void apply(const SceneEdit& edit, Progress& progress);
  void goTo(std::size_t position, Progress& progress);
  void save();
  void saveAs(const std::filesystem::path& folder);
  void discard(Progress& progress);
  void report(); // where the history stands, if that has changed
  // Ends the stroke, settles values and lets the scene go; leaves: what is unsaved, for the next
  // start.
  void close(bool leaves);

 private:
  void show(std::shared_ptr<const CompiledScene> compiled, bool anew = false);
  void keep(); // a scene without a folder has one from its first edit on
  void appended(std::size_t done_before);
  bool ownsFolder() const;

  EditEventBuffer& events_;
  std::function<void(const CompiledScene&)> publish_;
  std::filesystem::path autosave_root_;
  std::unique_ptr<Autosave> autosave_; // the editor's folder, as long as it has no other
  std::unique_ptr<Editor> editor_;     // destroyed before its folder
  bool never_saved_ = false;           // by a person: unsaved, edited or not
  bool keeps_ = true;                  // until it failed: a full disk is told of once
  std::optional<ValueEdit> tried_;
  std::optional<std::size_t> saved_at_; // or opened; position in the history; absent: not in it
  EditStatus told_;
};

} // namespace patina
