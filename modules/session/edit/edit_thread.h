// The editor on a thread of its own: whoever asks never waits, and hears of what was done.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/edit/edit_events.h"
#include "session/edit/editor.h"
#include "session/store/autosave.h"

namespace patina {

// How what was asked for came out; neither: it was done.
struct EditOutcome {
  std::string problem; // one line, why it could not be
  bool cancelled = false;
};

// All calls come from one thread, the window's, and none waits but the destructor.
class EditThread {
 public:
  struct Spec {
    // On the edit thread, first thing after an edit: the snapshot goes to the servo.
    std::function<void(const CompiledScene&)> publish;
    // On the edit thread: there are events. Once until they are taken; must not wait.
    std::function<void()> wake;
    // Where a scene without a folder is kept from its first edit on; empty: nowhere.
    std::filesystem::path autosave_root;
  };
  explicit EditThread(Spec spec);
  // What is asked for and not begun is dropped; what was painted is kept, journaled where there is
  // a folder.
  ~EditThread();

  // How an editor that is made elsewhere reports to this thread; adopt() takes it over.
  Editor::Listener listener();
  // Takes the place of the editor that there is. `autosave`: the place of what is recovered.
  // unsaved: of an editor without a folder, though nothing was edited yet.
  void adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave = {},
             bool unsaved = false);

  // A stroke; samples may come in pieces of any size. When more of them come than can be painted,
  // those are left out that change the path by no more than a hundredth of the radius. Anything
  // else that is asked for ends the stroke first.
  void prepare(Tool tool);
  void beginStroke(const Brush& brush);
  void dabs(std::vector<StrokeSample> samples);
  void endStroke();
  void cancelStroke(); // nothing of it stays, and it is no edit

  using Done = std::function<void(const EditOutcome& outcome)>;

  // Felt at once, and one edit as soon as they rest or something else is asked for: so that a
  // slider that is dragged is one step of the history.
  void tryValues(std::function<void(Scene&)> set, Done done = {});

  // Done is called by way of take(); without it problems are events.
  // Another scene, made of the present one; one that waits is replaced by a newer one that
  // `replaces` it. Null: nothing to do.
  using Change = std::function<std::shared_ptr<const Scene>(const CompiledScene& present)>;
  void apply(const std::string& what, Change change, bool replaces = false, Done done = {});
  // The same of the scene's own values; `failed` hears why it could not be, `done` that it is, and
  // neither of a cancel.
  void edit(const std::string& what, std::function<Scene(const Scene&)> change,
            std::function<void(const std::string& problem)> failed,
            std::function<void()> done = {});
  void goTo(std::size_t position, Done done = {}); // undo or redo until so many edits are done
  void undo(Done done = {});
  void redo(Done done = {});
  void save(Done done = {});
  void saveAs(const std::filesystem::path& folder, Done done = {});
  // To the workspace as it was last saved, its history too; then nothing is unsaved.
  void discard(Done done = {});
  void cancel(); // what is under way, and what waits
  // Nobody can be asked what becomes of edits that are not saved: the next start offers them.
  void leaveBehind();

  EditEvents take();
  bool busy() const; // something is under way or waits

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
