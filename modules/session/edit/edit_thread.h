// Runs the editor on its own thread. Callers never wait; results come back as events.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "session/compile/compile_scene.h"
#include "session/edit/editor.h"
#include "session/edit/stroke_tracker.h"
#include "session/store/autosave.h"

namespace patina {

// Events of the edit thread, merged until they are taken, so that their number stays bounded.

// Undo position, and which of the edits are saved in the workspace's folder.
struct EditStatus {
  std::vector<std::string> edits; // descriptions of all edits, oldest first
  std::size_t done = 0;           // number of applied edits; the others can be redone
  bool previews = false;          // values are applied that are no edit yet: undo takes them back
  bool unsaved = false;
  std::optional<std::filesystem::path> folder{}; // absent: never saved by the user
  // Why the last step could not be written to the scene's folder, an autosave's too, and was taken
  // back; empty: it was written. Such a problem is no event.
  std::string folder_problem{};
  bool operator==(const EditStatus&) const = default;
};

struct EditProgress {
  std::string title; // "Merging the objects"
  double fraction = 0;
  std::string what;
};

// Events since the last take(), merged from any number of edits.
struct EditEvents {
  std::shared_ptr<const CompiledScene> compiled; // null: unchanged
  bool is_new_scene = false;                     // the scene was replaced: see EditThread::adopt()
  std::shared_ptr<const EditStatus> status;      // null: unchanged
  std::optional<EditProgress> progress;          // absent: no slow edit is running
  std::vector<std::string> problems;             // one line each: the failed action and the cause
  std::vector<std::function<void()>> done;       // to be called in this order
};

// Thread-safe.
class EditEventBuffer {
 public:
  explicit EditEventBuffer(std::function<void()> wake) : wake_(std::move(wake)) {}

  void addScene(std::shared_ptr<const CompiledScene> compiled, bool is_new_scene);
  void setStatus(std::shared_ptr<const EditStatus> status);
  void setProgress(std::optional<EditProgress> progress);
  void addProblem(const std::string& line);
  void addDone(std::function<void()> then);
  EditEvents take();

 private:
  template <typename Change> void change(Change&& change);

  std::function<void()> wake_;
  std::mutex mutex_;
  EditEvents events_;
  bool woken_ = false;
};

// Outcome of a request. Neither member set: it succeeded.
struct EditOutcome {
  std::string problem; // one line: why it failed
  bool cancelled = false;
};

// All calls come from one thread, the window's. Only the destructor and stop() wait.
class EditThread {
 public:
  struct Spec {
    // Called on the edit thread first after an edit, to hand the snapshot to the servo.
    std::function<void(const CompiledScene&)> publish;
    // Called on the edit thread once per batch of events, until take(); must not block.
    std::function<void()> wake;
    // Folder for autosaves of scenes without a folder, from their first edit on; empty: none.
    std::filesystem::path autosave_root;
    // Appends the servo's ticks since the last call. Called by either thread, under a lock; must
    // not wait for either. Empty: no painting.
    std::function<void(std::vector<ToolSample>&)> ticks{};
  };
  explicit EditThread(Spec spec);
  // Drops requests that have not begun. A painted stroke is kept, and journaled if there is a
  // folder.
  ~EditThread();
  void stop(); // does what the destructor does; no other call may follow

  // Listener for an editor that is made elsewhere and handed over by adopt().
  Editor::Listener listener();
  // Replaces the present editor. `autosave`: the folder of a recovered scene. `unsaved`: an editor
  // without a folder counts as unsaved even before its first edit.
  void adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave = {},
             bool unsaved = false);

  // Painting. `prepare` computes in advance what the first stroke with a tool needs.
  void prepare(Tool tool);
  // The hand paints with this brush from now on: where the servo's ticks are in contact they become
  // strokes (StrokeTracker), without the calling thread. Call it again when the hand changes. If
  // ticks come faster than they can be painted, samples that change the path by at most a hundredth
  // of the radius are dropped. Any other request ends the stroke first.
  void paint(const StrokeTracker::Hand& hand, const Brush& brush);
  void finishPainting(); // ends the stroke where the tip is; the hand paints no more
  void cancelPainting(); // removes the stroke; no edit is recorded
  bool painting() const; // a stroke is being painted

  using Done = std::function<void(const EditOutcome& outcome)>;

  // Applies values at once; they become one edit after a short rest or before the next request, so
  // that dragging a slider is one step of the history.
  void previewValues(std::function<void(Scene&)> set, Done done = {});

  // take() delivers `done`; without it problems become events.
  // Makes another scene from the present one. A newer request with `replaces` drops an older one
  // that still waits. Null: nothing to do.
  using Change = std::function<std::shared_ptr<const Scene>(const CompiledScene& present)>;
  void apply(const std::string& what, Change change, bool replaces = false, Done done = {});
  // Changes the scene's own values. `failed` is called with the problem, `done` on success, and
  // neither if cancelled.
  void edit(const std::string& what, std::function<Scene(const Scene&)> change,
            std::function<void(const std::string& problem)> failed,
            std::function<void()> done = {});
  // undoes or redoes until `position` edits are applied
  void goTo(std::size_t position, Done done = {});
  void undo(Done done = {});
  void redo(Done done = {});
  void save(Done done = {});
  void saveAs(const std::filesystem::path& folder, Done done = {});
  // Returns to the workspace as it was last saved, with its history.
  void discard(Done done = {});
  void cancel(); // cancels the running request, those that wait, and a stroke
  // Keeps unsaved edits in the autosave folder at exit. The next start offers to recover them.
  void keepForRecovery();

  EditEvents take();
  bool busy() const; // a request is running or waiting, or a stroke is being painted

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
