#include "session/edit/edit_thread.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <limits>
#include <thread>
#include <utility>

#include "core/error.h"
#include "session/edit/value_edit.h"

namespace patina {

template <typename Change> void EditEventBuffer::change(Change&& change) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    change();
    wakes = !std::exchange(woken_, true);
  }
  if (wakes && wake_) wake_();
}

void EditEventBuffer::addScene(std::shared_ptr<const CompiledScene> compiled, bool is_new_scene) {
  change([&] {
    events_.compiled = std::move(compiled);
    events_.is_new_scene = events_.is_new_scene || is_new_scene;
  });
}

void EditEventBuffer::setStatus(std::shared_ptr<const EditStatus> status) {
  change([&] { events_.status = std::move(status); });
}

void EditEventBuffer::setProgress(std::optional<EditProgress> progress) {
  change([&] { events_.progress = std::move(progress); });
}

void EditEventBuffer::addProblem(const std::string& line) {
  change([&] { events_.problems.push_back(line); });
}

void EditEventBuffer::addDone(std::function<void()> then) {
  change([&] { events_.done.push_back(std::move(then)); });
}

EditEvents EditEventBuffer::take() {
  const std::lock_guard lock(mutex_);
  woken_ = false;
  EditEvents taken = std::move(events_);
  events_ = {};
  events_.progress = taken.progress; // the edit is still running
  return taken;
}

namespace {

using Clock = std::chrono::steady_clock;

// Max samples per call, so that the brush stays near the hand; redundant ones are dropped.
constexpr std::size_t kMaxAtOnce = 12;
// Debounce time after which a previewed value becomes an edit.
constexpr std::chrono::milliseconds kDebounce{400};
// Interval at which the servo's ticks are read while the hand holds a brush, pressed or not.
constexpr std::chrono::milliseconds kFollowInterval{3}, kIdleInterval{15};

std::vector<StrokeSample> thinned(std::vector<StrokeSample> samples, double off) {
  if (samples.size() <= kMaxAtOnce) return samples;
  std::vector<StrokeSample> kept, way;
  for (const StrokeSample& sample : samples) {
    if (!way.empty() && !deviatesFromChord(way, sample, off)) {
      way.push_back(sample);
      continue;
    }
    kept.push_back(way.empty() ? sample : way.back());
    way = {kept.back(), sample};
  }
  kept.push_back(samples.back());
  return kept;
}

// Largest distance of a stroke from its samples [m]; strokes that accumulate need every sample.
double deviationOf(const Brush& brush) {
  const bool all = brush.mode == StrokeMode::build_up || brush.mode == StrokeMode::smooth;
  return all ? 0 : 0.005 * brush.radius;
}

bool sameField(const Scene& a, const Scene& b) {
  return a.field.resolution == b.field.resolution && a.field.voxel == b.field.voxel &&
         a.field.band == b.field.band && a.redistance == b.redistance;
}

} // namespace

struct EditThread::Impl {
  struct Painting {
    StrokeTracker::Hand hand;
    Brush brush;
  };

  // Ticks of the servo and the hand that they belong to.
  struct Part {
    std::shared_ptr<const Painting> who;
    std::vector<ToolSample> ticks;
    std::uint64_t number;
  };

  struct Task {
    std::string title;
    std::function<void(Impl&, Progress&)> work;
    Done done{};
    std::string replaces{};
    bool of_stroke = false, of_values = false; // does not end the stroke; does not commit a preview
    bool stops_painter = false;
    std::uint64_t until = 0; // the last part that came before the request
  };

  explicit Impl(Spec spec_in)
      : spec(std::move(spec_in)), events(spec.wake), thread([this] { run(); }) {}

  void push(Task task) {
    {
      const std::lock_guard lock(mutex);
      pushLocked(std::move(task));
    }
    wakes.notify_one();
  }

  // The caller holds the mutex.
  void pushLocked(Task task) {
    if (!task.replaces.empty())
      drop([&](const Task& other) { return other.replaces == task.replaces; });
    readTicks();
    task.until = parts;
    if (task.stops_painter) painter.reset();
    queue.push_back(std::move(task));
  }

  // Assigns the servo's ticks since the last call to the hand that holds the brush, or drops them
  // if there is none. The caller holds the mutex.
  void readTicks() {
    if (!spec.ticks) return;
    std::vector<ToolSample> ticks;
    spec.ticks(ticks);
    if (painter && !ticks.empty()) unread.push_back({painter, std::move(ticks), ++parts});
  }

  // Asks for the stroke's end without an edit. The caller holds the mutex.
  void pushCancel() {
    readTicks();
    Task task{"Painting", [until = parts](Impl& at, Progress&) { at.cancelStroke(until); }};
    task.of_stroke = task.stops_painter = true;
    pushLocked(std::move(task));
  }

  // Drops the waiting tasks selected by `meant`; the caller holds the mutex.
  template <typename Meant> void drop(Meant meant) {
    for (Task& task : queue)
      if (meant(task) && task.done)
        events.addDone([done = std::move(task.done)] { done({.problem = {}, .cancelled = true}); });
    std::erase_if(queue, meant);
  }

  // All below runs on the edit thread.

  void run() {
    while (std::optional<Task> task = next()) perform(*task);
    close();
  }

  // Waits for the next task: a request, a preview to commit, or ticks to follow. nullopt: stop.
  std::optional<Task> next() {
    std::unique_lock lock(mutex);
    working = false;
    const auto ready = [this] { return stopping || !queue.empty(); };
    while (!ready()) {
      std::optional<Clock::time_point> due;
      if (preview) due = commit_at;
      if ((painter || !unread.empty()) && (!due || follow_at < *due)) due = follow_at;
      if (!due) {
        wakes.wait(lock);
      } else if (wakes.wait_until(lock, *due) == std::cv_status::timeout && !ready()) {
        if (Clock::now() >= follow_at) followPainter(lock);
        if (preview && Clock::now() >= commit_at) return started(commitTask());
      }
    }
    if (stopping) return std::nullopt;
    Task task = std::move(queue.front());
    queue.pop_front();
    return started(std::move(task));
  }

  // Keeps an error of the scene's folder in the status until something is written there. Returns
  // false for any other error.
  bool isFolderProblem(const std::exception& error) {
    const auto* of_file = dynamic_cast<const FileError*>(&error);
    const auto folder = edited ? edited->folder() : std::nullopt;
    if (of_file == nullptr || !folder || !of_file->path().starts_with(folder->string()))
      return false;
    folder_problem = of_file->what();
    return true;
  }

  void followPainter(std::unique_lock<std::mutex>& lock) {
    readTicks();
    const bool pressed = painter && painter->hand.down;
    follow_at = Clock::now() + (pressed || painting ? kFollowInterval : kIdleInterval);
    if (unread.empty()) return;
    const std::vector<Part> all = takeParts(parts);
    progress = makeProgress("Preparing the brush");
    following = true;
    lock.unlock();
    std::string problem;
    bool reports = true;
    try {
      follow(all, *progress);
    } catch (const Cancelled&) { // cancel() has asked for the stroke's end, too
    } catch (const std::bad_alloc&) {
      problem = "there is not enough memory";
    } catch (const std::exception& error) {
      problem = error.what();
      reports = !isFolderProblem(error);
    }
    if (!problem.empty()) {
      if (reports) events.addProblem(problem);
      events.setProgress(std::nullopt);
      emitStatus();
    }
    lock.lock();
    following = false;
  }

  // The caller holds the mutex.
  std::vector<Part> takeParts(std::uint64_t until) {
    std::vector<Part> taken;
    for (; !unread.empty() && unread.front().number <= until; unread.pop_front())
      taken.push_back(std::move(unread.front()));
    return taken;
  }

  Task commitTask() const {
    Task task{"Values", [](Impl& at, Progress& p) { at.commitPreview(p); }};
    task.of_values = true;
    return task;
  }

  Task started(Task task) {
    working = true;
    progress = makeProgress(task.title);
    return task;
  }

  std::shared_ptr<Progress> makeProgress(const std::string& title) {
    return std::make_shared<Progress>(
        [this, title, shown = -1.0](double part, std::string_view what) mutable {
          if (part >= shown && part < shown + 0.01) return;
          shown = part;
          events.setProgress(EditProgress{title, part, std::string(what)});
        });
  }

  void perform(Task& task) {
    EditOutcome outcome;
    bool reports = true;
    try {
      if (!task.of_stroke) endPainting(task);
      if (!task.of_values && !task.of_stroke) commitPreview(*progress);
      task.work(*this, *progress);
    } catch (const Cancelled&) {
      outcome.cancelled = true;
    } catch (const std::bad_alloc&) {
      outcome.problem = "there is not enough memory";
    } catch (const std::exception& error) {
      outcome.problem = error.what();
      reports = !isFolderProblem(error);
    }
    if (task.of_values && preview) commit_at = Clock::now() + kDebounce;
    emitStatus();
    events.setProgress(std::nullopt);
    if (task.done)
      events.addDone([done = std::move(task.done), outcome] { done(outcome); });
    else if (!outcome.problem.empty() && reports)
      events.addProblem(outcome.problem);
  }

  // Ends the stroke before a request. An error of the stroke does not stop the request.
  void endPainting(const Task& task) {
    std::vector<Part> before;
    {
      const std::lock_guard lock(mutex);
      before = takeParts(task.until);
    }
    try {
      follow(before, *progress);
      const bool was_painting = tracker.painting();
      const std::shared_ptr<const Painting> who = last_painter;
      if (was_painting && who) paint(tracker.finish(), who->brush, *progress);
      endStroke();
      if (task.stops_painter)
        tracker = {};
      else if (was_painting)
        tracker.cancel(); // the rest of the gesture is no stroke of its own
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& error) {
      if (!isFolderProblem(error)) events.addProblem(error.what());
    }
    painting = tracker.painting();
  }

  void follow(const std::vector<Part>& some, Progress& p) {
    for (const Part& part : some) {
      const std::vector<StrokePiece> pieces = tracker.feed(part.ticks, part.who->hand);
      last_painter = part.who;
      painting = tracker.painting() || !pieces.empty();
      paint(pieces, part.who->brush, p);
    }
    painting = tracker.painting();
  }

  void paint(const std::vector<StrokePiece>& pieces, const Brush& brush, Progress& p) {
    for (const StrokePiece& piece : pieces) {
      if (piece.begins) {
        endStroke();
        commitPreview(p);
        off = deviationOf(brush);
        editor().beginStroke(brush, p);
        events.setProgress(std::nullopt);
      }
      if (inStroke()) // an error may have ended it
        for (const StrokeSample& sample : thinned(piece.samples, off)) edited->dab(sample);
      if (!piece.ends) continue;
      endStroke();
      emitStatus();
    }
  }

  void emitScene(std::shared_ptr<const CompiledScene> compiled, bool is_new_scene = false) {
    if (spec.publish) spec.publish(*compiled); // first: haptics is more urgent than drawing
    events.addScene(std::move(compiled), is_new_scene);
  }

  Editor& editor() const { // throws Error if there is no scene
    if (!edited) throw Error("there is no scene");
    return *edited;
  }

  bool ownsFolder() const { return edited->folder() && !autosave; }

  void adopt(std::unique_ptr<Editor> next_editor, std::unique_ptr<Autosave> place, bool unsaved) {
    edited.reset();
    autosave = std::move(place);
    if (autosave) autosave->claim();
    edited = std::move(next_editor);
    never_saved = unsaved || autosave != nullptr;
    autosaves = true;
    preview.reset();
    saved_at.reset();
    folder_problem.clear();
    tracker = {};
    if (!edited) return;
    // A scene without its own folder counts as saved until it is edited.
    saved_at = ownsFolder() ? edited->savedPosition() : std::optional(edited->history().undoable());
    emitScene(edited->compiled(), true);
  }

  // Gives a scene without a folder one before its first edit.
  void startAutosave() {
    if (!edited || edited->folder() || spec.autosave_root.empty() || !autosaves) return;
    try {
      auto place = std::make_unique<Autosave>(spec.autosave_root);
      edited->saveAs(place->workspace());
      autosave = std::move(place);
    } catch (const std::exception& error) {
      autosaves = false;
      events.addProblem(
          std::string("A crash would lose the edits, which cannot be kept on disk: ") +
          error.what());
    }
  }

  bool inStroke() const { return edited && edited->inStroke(); }

  void endStroke() { // no effect outside a stroke
    if (!inStroke()) return;
    const std::size_t before = edited->history().undoable();
    if (edited->endStroke()) appended(before);
  }

  // Removes the stroke, and ticks that came before the request.
  void cancelStroke(std::uint64_t until) {
    {
      const std::lock_guard lock(mutex);
      takeParts(until);
    }
    tracker.cancel();
    painting = false;
    if (inStroke()) edited->cancelStroke();
  }

  void previewValues(const std::function<void(Scene&)>& set) {
    Scene wanted = editor().scene();
    if (preview) setValues(wanted, preview->values);
    set(wanted);
    validate(wanted);
    const CompiledScene& compiled = *edited->compiled();
    std::optional<ValueEdit> now = valueEdit(compiled.scene, wanted);
    if (!now) {
      if (preview) emitScene(edited->compiled());
    } else if (sameField(wanted, compiled.scene)) {
      emitScene(withNewParameters(compiled, std::move(wanted)));
    } // otherwise the field must be rebuilt: commitPreview() does it
    preview = std::move(now);
  }

  void commitPreview(Progress& p) {
    if (!preview) return;
    const ValueEdit edit = *std::exchange(preview, std::nullopt);
    const std::size_t before = edited->history().undoable();
    try {
      edited->apply(edit, p);
    } catch (...) {
      emitScene(edited->compiled());
      throw;
    }
    appended(before);
  }

  void appended(std::size_t done_before) {
    if (saved_at && done_before < *saved_at) saved_at.reset();
    folder_problem.clear();
  }

  void goTo(std::size_t position, Progress& p) {
    const std::size_t now = editor().history().undoable();
    std::size_t steps = 0;
    if (position < now) steps = edited->undo(now - position, p);
    if (position > now) steps = edited->redo(position - now, p);
    if (steps > 0) folder_problem.clear();
  }

  void emitStatus() { // emits the status if it has changed
    EditStatus status;
    if (edited) {
      const EditHistory& history = edited->history();
      if (history.undoable() > 0) startAutosave();
      status.edits = history.descriptions();
      status.done = history.undoable();
      status.previews = preview.has_value();
      status.unsaved = preview || (!ownsFolder() && never_saved) || saved_at != status.done;
      if (ownsFolder()) status.folder = edited->folder();
      status.folder_problem = folder_problem;
    }
    if (status == reported_status) return;
    reported_status = status;
    events.setStatus(std::make_shared<const EditStatus>(std::move(status)));
  }

  void close() {
    try {
      Progress p;
      readTicks();
      progress = std::make_shared<Progress>();
      Task last;
      last.stops_painter = true;
      last.until = parts;
      endPainting(last);
      commitPreview(p);
      if (leaves && edited) {
        emitStatus(); // includes an edit that has just ended
        if (autosave && reported_status.unsaved) autosave->keepForRecovery();
      }
    } catch (const std::exception& error) {
      events.addProblem(error.what());
    }
    edited.reset();
    autosave.reset();
  }

  const Spec spec;
  EditEventBuffer events;
  std::atomic<bool> painting{false};

  // Used by the edit thread only.
  std::unique_ptr<Autosave> autosave; // the editor's folder until the user saves it elsewhere
  std::unique_ptr<Editor> edited;     // destroyed before its folder
  bool never_saved = false;           // the user has not saved it: unsaved, edited or not
  bool autosaves = true;              // false after a failure: a full disk is reported once
  std::optional<ValueEdit> preview;
  Clock::time_point commit_at;
  std::optional<std::size_t> saved_at; // last saved or opened position; absent: not in the history
  EditStatus reported_status;
  std::string folder_problem; // see EditStatus
  StrokeTracker tracker;
  std::shared_ptr<const Painting> last_painter; // painter of the last ticks
  double off = 0;                               // max deviation of the stroke from its samples [m]

  std::mutex mutex; // guards all below
  std::condition_variable wakes;
  std::deque<Task> queue;
  std::shared_ptr<const Painting> painter; // null: no hand holds a brush
  std::deque<Part> unread;
  std::uint64_t parts = 0; // number of the newest part
  Clock::time_point follow_at;
  std::shared_ptr<Progress> progress;
  bool stopping = false, working = false, following = false, leaves = false;
  std::thread thread; // last: it uses all of the above
};

EditThread::EditThread(Spec spec) : impl_(std::make_unique<Impl>(std::move(spec))) {}

EditThread::~EditThread() {
  stop();
}

void EditThread::stop() {
  if (!impl_->thread.joinable()) return;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    if (impl_->progress) impl_->progress->cancel();
  }
  impl_->wakes.notify_one();
  impl_->thread.join();
}

Editor::Listener EditThread::listener() {
  return [this](const EditorNotice& notice) { impl_->emitScene(notice.compiled); };
}

void EditThread::adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave,
                       bool unsaved) {
  // std::function needs a copyable capture.
  auto carried = std::make_shared<std::pair<std::unique_ptr<Editor>, std::unique_ptr<Autosave>>>(
      std::move(editor), std::move(autosave));
  impl_->push({"Opening", [carried, unsaved](Impl& at, Progress&) {
                 at.adopt(std::move(carried->first), std::move(carried->second), unsaved);
               }});
}

void EditThread::keepForRecovery() {
  const std::lock_guard lock(impl_->mutex);
  impl_->leaves = true;
}

void EditThread::prepare(Tool tool) {
  impl_->push({"Preparing the brush",
               [tool](Impl& at, Progress& progress) {
                 at.editor().prepare(tool, progress);
                 at.startAutosave(); // before the first stroke, which must not wait for a disk
               },
               {},
               "prepare"});
}

void EditThread::paint(const StrokeTracker::Hand& hand, const Brush& brush) {
  Impl& at = *impl_;
  {
    const std::lock_guard lock(at.mutex);
    at.readTicks(); // those are the former hand's
    if (hand.down && !(at.painter && at.painter->hand.down)) at.follow_at = {};
    at.painter = std::make_shared<const Impl::Painting>(Impl::Painting{hand, brush});
  }
  at.wakes.notify_one();
}

void EditThread::finishPainting() {
  Impl::Task task{"Painting", [](Impl&, Progress&) {}};
  task.stops_painter = true;
  impl_->push(std::move(task));
}

void EditThread::cancelPainting() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->pushCancel();
  }
  impl_->wakes.notify_one();
}

bool EditThread::painting() const {
  return impl_->painting;
}

void EditThread::previewValues(std::function<void(Scene&)> set, Done done) {
  Impl::Task task{"Values", [set = std::move(set)](Impl& at, Progress&) { at.previewValues(set); },
                  std::move(done)};
  task.of_values = true;
  impl_->push(std::move(task));
}

void EditThread::apply(const std::string& what, Change change, bool replaces, Done done) {
  impl_->push({what,
               [what, change = std::move(change)](Impl& at, Progress& progress) {
                 auto scene = change(*at.editor().compiled());
                 if (!scene) return;
                 const std::size_t before = at.edited->history().undoable();
                 at.edited->apply(SceneEdit{what, std::move(scene)}, progress);
                 at.appended(before);
               },
               std::move(done), replaces ? what : std::string()});
}

void EditThread::edit(const std::string& what, std::function<Scene(const Scene&)> change,
                      std::function<void(const std::string&)> failed, std::function<void()> done) {
  apply(
      what,
      [change = std::move(change)](const CompiledScene& now) {
        return std::make_shared<const Scene>(change(now.scene));
      },
      false,
      [failed = std::move(failed), done = std::move(done)](const EditOutcome& outcome) {
        if (!outcome.problem.empty()) return failed(outcome.problem);
        if (!outcome.cancelled && done) done();
      });
}

void EditThread::goTo(std::size_t position, Done done) {
  impl_->push({"History", [position](Impl& at, Progress& progress) { at.goTo(position, progress); },
               std::move(done)});
}

void EditThread::undo(Done done) {
  impl_->push({"Undo",
               [](Impl& at, Progress& progress) {
                 const std::size_t now = at.editor().history().undoable();
                 if (now > 0) at.goTo(now - 1, progress);
               },
               std::move(done)});
}

void EditThread::redo(Done done) {
  impl_->push({"Redo",
               [](Impl& at, Progress& progress) {
                 at.goTo(at.editor().history().undoable() + 1, progress);
               },
               std::move(done)});
}

void EditThread::save(Done done) {
  impl_->push({"Saving",
               [](Impl& at, Progress&) {
                 if (!at.edited || !at.ownsFolder())
                   throw Error("the scene has no folder to be saved into");
                 at.edited->save();
                 at.folder_problem.clear();
                 at.saved_at = at.edited->history().undoable();
               },
               std::move(done)});
}

void EditThread::saveAs(const std::filesystem::path& folder, Done done) {
  impl_->push({"Saving",
               [folder](Impl& at, Progress&) {
                 at.editor().saveAs(folder);
                 at.autosave.reset();
                 at.never_saved = false;
                 at.folder_problem.clear();
                 at.saved_at = at.edited->history().undoable();
               },
               std::move(done)});
}

void EditThread::discard(Done done) {
  impl_->push({"Going back to what was saved",
               [](Impl& at, Progress& progress) {
                 if (!at.edited || !at.ownsFolder() || !at.edited->unsaved()) return;
                 at.edited->revert(progress);
                 at.saved_at = at.edited->history().undoable();
               },
               std::move(done)});
}

void EditThread::cancel() {
  Impl& at = *impl_;
  {
    const std::lock_guard lock(at.mutex);
    at.drop([](const Impl::Task&) { return true; });
    if ((at.working || at.following) && at.progress) at.progress->cancel();
    at.pushCancel();
  }
  at.wakes.notify_one();
}

EditEvents EditThread::take() {
  return impl_->events.take();
}

bool EditThread::busy() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->working || impl_->painting || !impl_->queue.empty();
}

} // namespace patina
