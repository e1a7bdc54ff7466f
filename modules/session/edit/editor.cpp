#include "session/edit/editor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/partial_output.h"
#include "session/store/replay.h"
#include "session/store/workspace_storage.h"

namespace patina {
namespace {

bool needsImages(Tool tool) {
  return tool.kind != Tool::Kind::material;
}

bool isFinite(const StrokeSample& sample) {
  return sample.position.allFinite() && std::isfinite(sample.t) && std::isfinite(sample.force) &&
         (!sample.tip || sample.tip->allFinite());
}

// Makes a sample valid for a stroke: the clock of a restarted device begins again.
StrokeSample recordable(StrokeSample sample, const Stroke& stroke) {
  sample.force = std::abs(sample.force);
  if (stroke.brush.anchor == DabAnchor::nearest) sample.tip.reset(); // not used
  if (!stroke.samples.empty()) sample.t = std::max(sample.t, stroke.samples.back().t);
  return sample;
}

Scene withPaint(const Scene& scene, const std::vector<std::shared_ptr<const ObjectPaint>>& paint) {
  Scene result = scene;
  for (std::size_t i = 0; i < result.objects.size(); ++i) result.objects[i].paint = paint[i];
  return result;
}

// A stroke may paint what is there already, such as the same one again.
bool isUnchanged(const Scene& scene, const std::vector<std::shared_ptr<const ObjectPaint>>& paint) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto& before = scene.objects[i].paint;
    if (before != paint[i] && !(before && paint[i] && same(*before, *paint[i]))) return false;
  }
  return true;
}

} // namespace

struct Editor::Impl {
  Listener listener;
  std::shared_ptr<const CompiledScene> compiled;
  std::unique_ptr<EditHistory> history;
  std::unique_ptr<WorkspaceStorage> storage; // null while the scene has no folder
  std::vector<std::string> notes;
  bool unsaved = false;
  bool repeated = false;
  std::optional<std::size_t> opened_at;
  std::size_t budget = kHistoryBudget;
  Replayer replayer;

  std::shared_ptr<const PaintSurface> surface; // null until something is painted
  std::unique_ptr<Painter> painter;            // set during a stroke
  Stroke stroke;
  std::shared_ptr<const CompiledScene> before_stroke;
  bool touched = false;

  void require(bool holds, const char* what) const {
    if (!holds) throw std::invalid_argument(std::string("Editor: ") + what);
  }

  void notify(std::optional<std::vector<PaintChange>> changes) const {
    if (listener) listener({compiled, std::move(changes)});
  }

  std::shared_ptr<const CompiledScene> compiledFor(Scene scene, Progress& progress) const {
    if (canReuseField(*compiled, scene)) return withNewParameters(*compiled, std::move(scene));
    return recompile(*compiled, std::move(scene), progress);
  }

  // Nothing can fail after the journal was written; if writing fails, nothing has changed.
  void commit(Edit edit, std::shared_ptr<const CompiledScene> after) {
    history->append(std::move(edit), after->scene, [this](const Edit& made, std::int64_t time) {
      if (storage) storage->recordEdit(made, history->undoable() + 1, time);
    });
    compiled = std::move(after);
    unsaved = true;
  }

  std::size_t move(std::size_t steps, bool back, Progress& progress) {
    const std::size_t most = back ? history->undoable() : history->redoable();
    steps = std::min(steps, most);
    if (steps == 0) return 0;
    const std::size_t target = back ? most - steps : history->undoable() + steps;
    replayer.cacheCompiled(compiled, surface);
    Scene scene = history->sceneAt(target);
    std::vector<PaintChange> changes = paintChanges(compiled->scene, scene);
    const bool same_objects = canReuseField(*compiled, scene);
    auto after = compiledFor(scene, progress);
    if (storage) back ? storage->recordUndo(steps) : storage->recordRedo(steps);
    history->setPosition(target, std::move(scene));
    compiled = std::move(after);
    unsaved = true;
    notify(same_objects ? std::optional(std::move(changes)) : std::nullopt);
    return steps;
  }
};

Editor::Editor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Editor::~Editor() = default;

Editor::Editor(Scene scene, Progress& progress, Listener listener, std::size_t history_budget)
    : impl_(std::make_unique<Impl>()) {
  impl_->listener = std::move(listener);
  impl_->compiled = compile(scene, progress);
  impl_->history = std::make_unique<EditHistory>(std::move(scene), impl_->replayer, history_budget);
  impl_->unsaved = true;
  impl_->budget = history_budget;
}

std::unique_ptr<Editor> Editor::open(const std::filesystem::path& folder, const OpenSpec& spec,
                                     Progress& progress, Listener listener) {
  auto impl = std::make_unique<Impl>();
  impl->listener = std::move(listener);
  WorkspaceStorage::Opened opened =
      WorkspaceStorage::open(folder, impl->replayer, spec.history_budget, spec.own, spec.recover);
  impl->history = std::move(opened.history);
  impl->storage = std::move(opened.storage);
  impl->notes = std::move(opened.notes);
  for (std::string& line : takeOutputWarnings()) impl->notes.push_back(std::move(line));
  impl->repeated = opened.intents.contains(spec.intent);
  if (impl->storage) {
    impl->storage->setIntent(spec.intent);
    if (spec.all_or_none) impl->storage->hold();
  }
  impl->unsaved = opened.unsaved;
  impl->opened_at = opened.saved_at;
  impl->budget = spec.history_budget;
  impl->compiled = compile(impl->history->scene(), progress);
  return std::unique_ptr<Editor>(new Editor(std::move(impl)));
}

std::shared_ptr<const CompiledScene> Editor::compiled() const {
  return impl_->compiled;
}
const Scene& Editor::scene() const {
  return impl_->compiled->scene;
}
const EditHistory& Editor::history() const {
  return *impl_->history;
}
const std::vector<std::string>& Editor::notes() const {
  return impl_->notes;
}
bool Editor::isRepeated() const {
  return impl_->repeated;
}
bool Editor::unsaved() const {
  return impl_->unsaved;
}
std::optional<std::size_t> Editor::savedPosition() const {
  return impl_->opened_at;
}
bool Editor::inStroke() const {
  return impl_->painter != nullptr;
}

void Editor::prepare(Tool tool, Progress& progress) {
  impl_->surface = paintSurfaceOf(*impl_->compiled, impl_->compiled->scene, impl_->surface,
                                  needsImages(tool), progress);
}

void Editor::beginStroke(const Brush& brush, Progress& progress) {
  Impl& at = *impl_;
  at.require(!at.painter, "a stroke is being painted");
  validate(brush);
  at.surface =
      paintSurfaceOf(*at.compiled, at.compiled->scene, at.surface, needsImages(brush), progress);
  auto painter = std::make_unique<Painter>(at.surface, at.compiled->scene);
  painter->begin(brush);
  at.before_stroke = at.compiled;
  // A field that must grow for the stroke is built before its first dab.
  const InteractionRange reach = reachAfter(*at.compiled, brush);
  if (!fits(*at.compiled, reach)) {
    at.compiled = recompile(*at.compiled, at.compiled->scene, progress, reach);
    at.notify(std::nullopt);
  }
  at.painter = std::move(painter);
  at.stroke = {brush, {}};
  at.touched = false;
}

PaintReport Editor::dab(const StrokeSample& sample) {
  Impl& at = *impl_;
  at.require(at.painter != nullptr, "no stroke was begun");
  const StrokeSample kept = recordable(sample, at.stroke);
  const PaintReport report = at.painter->dab(kept);
  if (isFinite(kept)) at.stroke.samples.push_back(kept); // other samples paint nothing
  std::vector<PaintChange> changes = at.painter->takeChanges();
  if (changes.empty()) return report;
  at.touched = true;
  Progress progress;
  try {
    at.compiled = at.compiledFor(withPaint(at.compiled->scene, at.painter->paint()), progress);
  } catch (...) {
    // a stroke that cannot be compiled must not be journaled: the file could not be opened again
    cancelStroke();
    throw;
  }
  at.notify(std::move(changes));
  return report;
}

bool Editor::endStroke() {
  Impl& at = *impl_;
  at.require(at.painter != nullptr, "no stroke was begun");
  try {
    at.painter->end();
    if (!at.touched || isUnchanged(at.before_stroke->scene, at.painter->paint())) {
      cancelStroke();
      return false;
    }
    auto after = std::make_shared<CompiledScene>(*at.compiled);
    after->scene = withPaint(at.compiled->scene, at.painter->paint());
    at.commit(std::move(at.stroke), std::move(after));
  } catch (...) {
    cancelStroke();
    throw;
  }
  at.painter.reset();
  at.before_stroke.reset();
  return true;
}

void Editor::cancelStroke() {
  Impl& at = *impl_;
  if (!at.painter) return;
  at.painter.reset();
  const std::vector<PaintChange> changes =
      paintChanges(at.compiled->scene, at.before_stroke->scene);
  at.compiled = std::move(at.before_stroke);
  at.before_stroke.reset();
  if (!changes.empty()) at.notify(changes);
}

PaintReport Editor::apply(const Stroke& stroke, Progress& progress,
                          std::vector<double>* dab_seconds) {
  validate(stroke);
  beginStroke(stroke.brush, progress);
  PaintReport sum;
  try {
    for (const StrokeSample& sample : stroke.samples) {
      progress.throwIfCancelled();
      const auto start = std::chrono::steady_clock::now();
      const PaintReport report = dab(sample);
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      sum += report;
      if (dab_seconds) dab_seconds->push_back(seconds);
    }
  } catch (...) {
    cancelStroke();
    throw;
  }
  endStroke();
  return sum;
}

void Editor::apply(const ValueEdit& edit, Progress& progress) {
  Impl& at = *impl_;
  at.require(!at.painter, "a stroke is being painted");
  Scene scene = at.compiled->scene;
  setValues(scene, edit.values);
  at.commit(edit, at.compiledFor(std::move(scene), progress));
  at.notify(std::nullopt);
}

void Editor::apply(const SceneEdit& edit, Progress& progress) {
  Impl& at = *impl_;
  at.require(!at.painter, "a stroke is being painted");
  at.require(edit.scene != nullptr, "an edit without its scene");
  validate(*edit.scene);
  at.commit(edit, at.compiledFor(*edit.scene, progress));
  at.notify(std::nullopt);
}

std::size_t Editor::undo(std::size_t steps, Progress& progress) {
  impl_->require(!impl_->painter, "a stroke is being painted");
  return impl_->move(steps, true, progress);
}

std::size_t Editor::redo(std::size_t steps, Progress& progress) {
  impl_->require(!impl_->painter, "a stroke is being painted");
  return impl_->move(steps, false, progress);
}

void Editor::commit() {
  impl_->require(impl_->storage != nullptr, "no folder to commit to");
  impl_->storage->commit();
}

void Editor::save() {
  impl_->require(impl_->storage != nullptr, "no folder to save into");
  impl_->replayer.cacheCompiled(impl_->compiled, impl_->surface);
  impl_->storage->save(*impl_->history);
  impl_->unsaved = false;
}

void Editor::saveAs(const std::filesystem::path& folder, const std::string& intent) {
  std::error_code code;
  if (impl_->storage && std::filesystem::equivalent(folder, impl_->storage->folder(), code))
    return save();
  impl_->replayer.cacheCompiled(impl_->compiled, impl_->surface);
  impl_->storage = WorkspaceStorage::create(folder, *impl_->history, intent);
  impl_->unsaved = false;
}

void Editor::revert(Progress& progress) {
  Impl& at = *impl_;
  at.require(at.storage != nullptr, "no folder to go back to");
  at.require(!at.painter, "a stroke is being painted");
  auto saved = at.compiledFor(loadWorkspace(at.storage->folder()), progress);
  WorkspaceStorage::Opened opened = at.storage->revert(at.replayer, at.budget);
  at.history = std::move(opened.history);
  at.storage = std::move(opened.storage);
  at.compiled = std::move(saved);
  at.surface.reset();
  at.unsaved = false;
  at.notify(std::nullopt);
}

std::optional<std::filesystem::path> Editor::folder() const {
  if (!impl_->storage) return std::nullopt;
  return impl_->storage->folder();
}

} // namespace patina
