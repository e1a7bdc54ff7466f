#include "session/edit/edit_thread.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <thread>
#include <utility>

#include "core/error.h"
#include "session/edit/edit_worker.h"

namespace patina {
namespace {

// So many samples at once keep the brush near the hand; of more those go that say nothing.
constexpr std::size_t kMostAtOnce = 12;
// Values that nobody has moved for so long have come to rest.
constexpr std::chrono::milliseconds kRest{400};

std::vector<StrokeSample> thinned(std::vector<StrokeSample> samples, double off) {
  if (samples.size() <= kMostAtOnce) return samples;
  std::vector<StrokeSample> kept, way;
  for (const StrokeSample& sample : samples) {
    if (!way.empty() && !strays(way, sample, off)) {
      way.push_back(sample);
      continue;
    }
    kept.push_back(way.empty() ? sample : way.back());
    way = {kept.back(), sample};
  }
  kept.push_back(samples.back());
  return kept;
}

} // namespace

struct EditThread::Impl {
  struct Task {
    std::string title;
    std::function<void(EditWorker&, Progress&)> work; // none: samples
    Done done{};
    std::string replaces{};
    std::vector<StrokeSample> samples{};
    bool of_stroke = false, of_values = false; // neither ends the stroke, nor settles values
  };

  explicit Impl(Spec spec)
      : events(std::move(spec.wake)),
        worker(events, std::move(spec.publish), std::move(spec.autosave_root)),
        thread([this] { run(); }) {}

  void push(Task task) {
    {
      const std::lock_guard lock(mutex);
      if (!task.replaces.empty())
        drop([&](const Task& other) { return other.replaces == task.replaces; });
      queue.push_back(std::move(task));
    }
    wakes.notify_one();
  }

  // Those that wait and are meant; the mutex is held.
  template <typename Meant> void drop(Meant meant) {
    for (Task& task : queue)
      if (meant(task) && task.done)
        events.addDone([done = std::move(task.done)] { done({.problem = {}, .cancelled = true}); });
    std::erase_if(queue, meant);
  }

  void run() {
    for (;;) {
      Task task;
      {
        std::unique_lock lock(mutex);
        working = false;
        const auto ready = [this] { return stopping || !queue.empty(); };
        if (!worker.hasValues()) {
          wakes.wait(lock, ready);
        } else if (!wakes.wait_until(lock, rests_at, ready)) {
          task.title = "Values";
          task.work = [](EditWorker& w, Progress& p) { w.settleValues(p); };
          task.of_values = true;
        }
        if (stopping) break;
        if (!task.work) {
          task = std::move(queue.front());
          queue.pop_front();
        }
        working = true;
        progress = std::make_shared<Progress>(
            [this, title = task.title, shown = -1.0](double part, std::string_view what) mutable {
              if (part >= shown && part < shown + 0.01) return;
              shown = part;
              events.setProgress(EditProgress{title, part, std::string(what)});
            });
      }
      perform(task);
    }
    worker.close(leaves);
  }

  void perform(Task& task) {
    EditOutcome outcome;
    try {
      if (!task.of_stroke) worker.endStroke();
      if (!task.of_values && !task.of_stroke) worker.settleValues(*progress);
      if (task.work)
        task.work(worker, *progress);
      else
        worker.dabs(thinned(std::move(task.samples), off));
    } catch (const Cancelled&) {
      outcome.cancelled = true;
    } catch (const std::bad_alloc&) {
      outcome.problem = "there is not enough memory";
    } catch (const std::exception& error) {
      outcome.problem = error.what();
    }
    if (task.of_values && worker.hasValues()) rests_at = std::chrono::steady_clock::now() + kRest;
    if (task.work) worker.report();
    events.setProgress(std::nullopt);
    if (task.done)
      events.addDone([done = std::move(task.done), outcome] { done(outcome); });
    else if (!outcome.problem.empty())
      events.addProblem(outcome.problem);
  }

  EditEventBuffer events;
  EditWorker worker; // the thread's own
  double off = 0;    // the same: how far a stroke may lie from its samples [m]
  std::mutex mutex;  // of what follows, but rests_at
  std::condition_variable wakes;
  std::deque<Task> queue;
  std::shared_ptr<Progress> progress;
  bool stopping = false, working = false, leaves = false;
  std::chrono::steady_clock::time_point rests_at;
  std::thread thread; // last: it uses all of these
};

EditThread::EditThread(Spec spec) : impl_(std::make_unique<Impl>(std::move(spec))) {}

EditThread::~EditThread() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    if (impl_->progress) impl_->progress->cancel();
  }
  impl_->wakes.notify_one();
  impl_->thread.join();
}

Editor::Listener EditThread::listener() {
  return [this](const EditorNotice& notice) { impl_->worker.take(notice); };
}

void EditThread::adopt(std::unique_ptr<Editor> editor, std::unique_ptr<Autosave> autosave,
                       bool unsaved) {
  // std::function copies what it holds.
  auto carried = std::make_shared<std::pair<std::unique_ptr<Editor>, std::unique_ptr<Autosave>>>(
      std::move(editor), std::move(autosave));
  impl_->push({"Opening", [carried, unsaved](EditWorker& worker, Progress&) {
                 worker.adopt(std::move(carried->first), std::move(carried->second), unsaved);
               }});
}

void EditThread::leaveBehind() {
  const std::lock_guard lock(impl_->mutex);
  impl_->leaves = true;
}

void EditThread::prepare(Tool tool) {
  impl_->push({"Preparing the brush",
               [tool](EditWorker& worker, Progress& progress) { worker.prepare(tool, progress); },
               {},
               "prepare"});
}

void EditThread::beginStroke(const Brush& brush) {
  impl_->push({"Preparing the brush", [brush, this](EditWorker& worker, Progress& progress) {
                 // What is laid on again and again depends on every sample.
                 const bool all =
                     brush.mode == StrokeMode::build_up || brush.mode == StrokeMode::smooth;
                 impl_->off = all ? 0 : 0.005 * brush.radius;
                 worker.beginStroke(brush, progress);
               }});
}

void EditThread::dabs(std::vector<StrokeSample> samples) {
  if (samples.empty()) return;
  {
    const std::lock_guard lock(impl_->mutex);
    if (!impl_->queue.empty() && !impl_->queue.back().work) {
      auto& waiting = impl_->queue.back().samples;
      waiting.insert(waiting.end(), samples.begin(), samples.end());
      return;
    }
  }
  Impl::Task task{"Painting", {}};
  task.samples = std::move(samples);
  task.of_stroke = true;
  impl_->push(std::move(task));
}

void EditThread::endStroke() {
  impl_->push({"Painting", [](EditWorker& worker, Progress&) { worker.endStroke(); }});
}

void EditThread::cancelStroke() {
  Impl::Task task{"Painting", [](EditWorker& worker, Progress&) { worker.cancelStroke(); }};
  task.of_stroke = true; // it is not to be ended first
  impl_->push(std::move(task));
}

void EditThread::tryValues(std::function<void(Scene&)> set, Done done) {
  Impl::Task task{"Values",
                  [set = std::move(set)](EditWorker& worker, Progress&) { worker.tryValues(set); },
                  std::move(done)};
  task.of_values = true;
  impl_->push(std::move(task));
}

void EditThread::apply(const std::string& what, Change change, bool replaces, Done done) {
  impl_->push({what,
               [what, change = std::move(change)](EditWorker& worker, Progress& progress) {
                 auto scene = change(*worker.editor().compiled());
                 if (scene) worker.apply({what, std::move(scene)}, progress);
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
  impl_->push(
      {"History",
       [position](EditWorker& worker, Progress& progress) { worker.goTo(position, progress); },
       std::move(done)});
}

void EditThread::undo(Done done) {
  impl_->push({"Undo",
               [](EditWorker& worker, Progress& progress) {
                 const std::size_t now = worker.editor().history().undoable();
                 if (now > 0) worker.goTo(now - 1, progress);
               },
               std::move(done)});
}

void EditThread::redo(Done done) {
  impl_->push({"Redo",
               [](EditWorker& worker, Progress& progress) {
                 worker.goTo(worker.editor().history().undoable() + 1, progress);
               },
               std::move(done)});
}

void EditThread::save(Done done) {
  impl_->push({"Saving", [](EditWorker& worker, Progress&) { worker.save(); }, std::move(done)});
}

void EditThread::saveAs(const std::filesystem::path& folder, Done done) {
  impl_->push({"Saving", [folder](EditWorker& worker, Progress&) { worker.saveAs(folder); },
               std::move(done)});
}

void EditThread::discard(Done done) {
  impl_->push({"Going back to what was saved",
               [](EditWorker& worker, Progress& progress) { worker.discard(progress); },
               std::move(done)});
}

void EditThread::cancel() {
  const std::lock_guard lock(impl_->mutex);
  impl_->drop([](const Impl::Task&) { return true; });
  if (impl_->working && impl_->progress) impl_->progress->cancel();
}

EditEvents EditThread::take() {
  return impl_->events.take();
}

bool EditThread::busy() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->working || !impl_->queue.empty();
}

} // namespace patina
