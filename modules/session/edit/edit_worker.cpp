#include "session/edit/edit_worker.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "session/edit/value_edit.h"

namespace patina {
namespace {

bool sameField(const Scene& a, const Scene& b) {
  return a.field.resolution == b.field.resolution && a.field.voxel == b.field.voxel &&
         a.field.band == b.field.band && a.redistance == b.redistance;
}

} // namespace

EditWorker::EditWorker(EditEventBuffer& events, std::function<void(const CompiledScene&)> publish,
                       std::filesystem::path autosave_root)
    : events_(events), publish_(std::move(publish)), autosave_root_(std::move(autosave_root)) {}

void EditWorker::show(std::shared_ptr<const CompiledScene> compiled, bool anew) {
  if (publish_) publish_(*compiled); // first: what is felt is waited for, what is seen is not
  events_.addScene(std::move(compiled), anew);
}

void EditWorker::take(const EditorNotice& notice) {
  show(notice.compiled);
}

Editor& EditWorker::editor() {
  if (!editor_) throw Error("there is no scene");
  return *editor_;
}

bool EditWorker::ownsFolder() const {
  return editor_->folder() && !autosave_;
}

void EditWorker::adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave,
                       bool unsaved) {
  editor_.reset();
  autosave_ = std::move(autosave);
  if (autosave_) autosave_->own();
  editor_ = std::move(editor);
  never_saved_ = unsaved || autosave_ != nullptr;
  keeps_ = true;
  tried_.reset();
  saved_at_.reset();
  if (!editor_) return;
  // What has no folder of ours is as it was saved until it is edited.
  saved_at_ = ownsFolder() ? editor_->savedBefore() : std::optional(editor_->history().undoable());
  show(editor_->compiled(), true);
}

void EditWorker::keep() {
  if (!editor_ || editor_->folder() || autosave_root_.empty() || !keeps_) return;
  try {
    auto place = std::make_unique<Autosave>(autosave_root_);
    editor_->saveAs(place->workspace());
    autosave_ = std::move(place);
  } catch (const std::exception& error) {
    keeps_ = false;
    events_.addProblem(std::string("A crash would lose the edits, which cannot be kept on disk: ") +
                       error.what());
  }
}

void EditWorker::prepare(Tool tool, Progress& progress) {
  editor().prepare(tool, progress);
  keep(); // before the first stroke, which must not wait for a disk
}

void EditWorker::beginStroke(const Brush& brush, Progress& progress) {
  editor().beginStroke(brush, progress);
}

void EditWorker::dabs(const std::vector<StrokeSample>& samples) {
  if (!editor_ || !editor_->inStroke()) return;
  for (const StrokeSample& sample : samples) editor_->dab(sample);
}

void EditWorker::endStroke() {
  if (!editor_ || !editor_->inStroke()) return;
  const std::size_t before = editor_->history().undoable();
  if (editor_->endStroke()) appended(before);
}

void EditWorker::cancelStroke() {
  if (editor_ && editor_->inStroke()) editor_->cancelStroke();
}

void EditWorker::tryValues(const std::function<void(Scene&)>& set) {
  Scene wanted = editor().scene();
  if (tried_) setValues(wanted, tried_->values);
  set(wanted);
  validate(wanted);
  const CompiledScene& compiled = *editor_->compiled();
  std::optional<ValueEdit> now = valueEdit(compiled.scene, wanted);
  if (!now) {
    if (tried_) show(editor_->compiled());
  } else if (sameField(wanted, compiled.scene)) {
    show(retuned(compiled, std::move(wanted)));
  } // else the field is built anew, which waits until the values rest
  tried_ = std::move(now);
}

void EditWorker::settleValues(Progress& progress) {
  if (!tried_) return;
  const ValueEdit edit = *std::exchange(tried_, std::nullopt);
  const std::size_t before = editor_->history().undoable();
  try {
    editor_->apply(edit, progress);
  } catch (...) {
    show(editor_->compiled());
    throw;
  }
  appended(before);
}

void EditWorker::appended(std::size_t done_before) {
  if (saved_at_ && done_before < *saved_at_) saved_at_.reset();
}

void EditWorker::apply(const SceneEdit& edit, Progress& progress) {
  const std::size_t before = editor().history().undoable();
  editor_->apply(edit, progress);
  appended(before);
}

void EditWorker::goTo(std::size_t position, Progress& progress) {
  const std::size_t now = editor().history().undoable();
  if (position < now) editor_->undo(now - position, progress);
  if (position > now) editor_->redo(position - now, progress);
}

void EditWorker::save() {
  if (!editor_ || !ownsFolder()) throw Error("the scene has no folder to be saved into");
  editor_->save();
  saved_at_ = editor_->history().undoable();
}

void EditWorker::saveAs(const std::filesystem::path& folder) {
  editor().saveAs(folder);
  autosave_.reset();
  never_saved_ = false;
  saved_at_ = editor_->history().undoable();
}

void EditWorker::discard(Progress& progress) {
  if (!editor_ || !ownsFolder() || !editor_->unsaved()) return;
  editor_->revert(progress);
  saved_at_ = editor_->history().undoable();
}

void EditWorker::report() {
  EditStatus status;
  if (editor_) {
    const EditHistory& history = editor_->history();
    if (history.undoable() > 0) keep();
    status.edits = history.descriptions();
    status.done = history.undoable();
    status.unsaved = tried_ || (!ownsFolder() && never_saved_) || saved_at_ != status.done;
    if (ownsFolder()) status.folder = editor_->folder();
  }
  if (status == told_) return;
  told_ = status;
  events_.setStatus(std::make_shared<const EditStatus>(std::move(status)));
}

void EditWorker::close(bool leaves) {
  try {
    endStroke();
    Progress progress;
    settleValues(progress);
    if (leaves && editor_) {
      report(); // an edit that has just come to its end is kept, too
      if (autosave_ && told_.unsaved) autosave_->leave();
    }
  } catch (const std::exception& error) {
    events_.addProblem(error.what());
  }
  editor_.reset();
  autosave_.reset();
}

} // namespace patina
