#include "app/gui/control/edit_controller.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <QEventLoop>

#include "app/gui/control/object_edits.h"
#include "core/error.h"
#include "scene/paint/grey_relief.h"

namespace patina {
namespace {

bool anyRelief(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) {
    return o.paint && hasRelief(*o.paint, scene.relief.source);
  });
}

} // namespace

EditController::EditController(const Parts& parts, Publish publish, QObject* parent)
    : QObject(parent), at_(parts),
      thread_({std::move(publish),
               [this] {
                 QMetaObject::invokeMethod(
                     this, [this] { takeEvents(); }, Qt::QueuedConnection);
               },
               stateFolder()}) {
  const auto edited = [this] {
    values_edited_ = true;
    setUnsaved(true);
  };
  connect(&at_.haptics, &HapticsPanel::edited, this, edited);
  connect(&at_.device, &DevicePanel::edited, this, edited);
  connect(&at_.objects, &ObjectList::edited, this, &EditController::applyObjects);
  connect(&at_.relief, &ReliefPanel::edited, this, [this](const ReliefSettings& relief) {
    setUnsaved(true);
    thread_.tryValues([relief](Scene& scene) { scene.relief = relief; });
  });
  connect(&at_.history, &HistoryPanel::asked, this,
          [this](std::size_t position) { thread_.goTo(position); });
}

void EditController::setUnsaved(bool unsaved) {
  unsaved_ = unsaved;
  emit changed();
}

std::optional<Work> EditController::work() const {
  if (!progress_) return std::nullopt;
  const QString title = QString::fromStdString(progress_->title);
  return Work{title, title + QStringLiteral(": ") + QString::fromStdString(progress_->what),
              progress_->fraction, true};
}

void EditController::takeEvents() {
  const EditEvents events = thread_.take();
  progress_ = events.progress;
  if (events.status) {
    status_ = *events.status;
    unsaved_ = status_.unsaved || values_edited_;
    at_.history.show(status_);
  }
  if (events.compiled) takeScene(events.compiled, events.anew);
  emit changed();
  if (!events.problems.empty()) emit refused(QString::fromStdString(events.problems.back()));
  for (const auto& done : events.done) done();
}

void EditController::takeScene(std::shared_ptr<const CompiledScene> scene, bool anew) {
  const auto before = std::exchange(scene_, std::move(scene));
  if (before && !anew) return showScene(editBetween(*before, scene_));
  values_asked_ = objects_asked_ = 0;
  showScene({scene_});
}

void EditController::showAgain() {
  showScene({scene_, SceneChange::Step::again});
}

void EditController::showScene(const SceneChange& change) {
  const CompiledScene& scene = *change.scene;
  has_relief_ = anyRelief(scene.scene);
  if (change.step != SceneChange::Step::edited) {
    values_edited_ = false;
    at_.haptics.setProblem({});
    at_.objects.setProblem({});
  }
  syncPanels();
  showRelief();
  const SurfaceField& field = *scene.built.field;
  if (change.surface) at_.haptics.setReach(std::max(0.0, field.band - 3) * field.grid.voxel);
  if (change.values) at_.device.showPlan(scene.snapshot->stabilisers);
  emit sceneChanged(change);
}

// After undo and redo, too.
void EditController::syncPanels() {
  const Scene& scene = scene_->scene;
  if (values_asked_ == 0 && !values_edited_) {
    if (!(at_.haptics.values() == scene.haptics)) at_.haptics.setValues(scene.haptics);
    if (!(at_.device.values() == deviceChoice(scene))) at_.device.setValues(deviceChoice(scene));
  }
  const ObjectChoice& shown = at_.objects.values();
  if (objects_asked_ == 0 &&
      (!sameObjects(shown.objects, scene.objects) || shown.redistance != scene.redistance))
    at_.objects.setValues(scene);
}

void EditController::setTool(const ToolChoice& choice) {
  paints_relief_ = choice == ToolChoice{Handling::paint, Tool::relief};
  showRelief();
}

void EditController::showRelief() {
  if (scene_ && (has_relief_ || paints_relief_)) at_.relief.show(scene_);
}

void EditController::tryValues() {
  if (!std::exchange(values_edited_, false) || !scene_) return;
  const HapticProperties haptics = at_.haptics.values();
  const DeviceChoice device = at_.device.values();
  ++values_asked_;
  thread_.tryValues(
      [haptics, device](Scene& scene) {
        scene.haptics = haptics;
        scene.device = device.device;
        scene.device_model = device.model;
        scene.stabilisers = device.stabilisers;
      },
      [this](const EditOutcome& outcome) {
        values_asked_ = std::max(0, values_asked_ - 1);
        at_.haptics.setProblem(QString::fromStdString(outcome.problem));
        if (values_asked_ == 0 && !values_edited_) setUnsaved(status_.unsaved);
      });
}

void EditController::applyObjects() {
  if (!scene_) return;
  setUnsaved(true);
  const ObjectChoice choice = at_.objects.values();
  if (choice.redistance != scene_->scene.redistance)
    thread_.tryValues([choice](Scene& scene) { scene.redistance = choice.redistance; });
  const auto before = scene_->scene.objects;
  const std::string words = wordsFor(before, choice.objects);
  if (words.empty() && objects_asked_ == 0) return;
  ++objects_asked_;
  thread_.apply(
      words.empty() ? "move" : words,
      [before, choice](const CompiledScene& now) -> std::shared_ptr<const Scene> {
        auto scene = std::make_shared<Scene>(now.scene);
        scene->objects = withEdits(now.scene.objects, before, choice.objects);
        return sameObjects(scene->objects, now.scene.objects) ? nullptr : scene;
      },
      true,
      [this](const EditOutcome& outcome) {
        objects_asked_ = std::max(0, objects_asked_ - 1);
        if (objects_asked_ > 0) return;
        syncPanels();
        at_.objects.setProblem(QString::fromStdString(outcome.problem));
      });
}

void EditController::addObjects(const std::vector<SceneObject>& objects, EditThread::Done done) {
  thread_.apply(
      "add " + objects.front().name,
      [objects](const CompiledScene& now) {
        return std::make_shared<const Scene>(withAdded(now.scene, objects));
      },
      false, std::move(done));
}

void EditController::waitFor(const std::function<void(EditThread::Done)>& ask) {
  QEventLoop loop;
  std::optional<EditOutcome> outcome;
  ask([&](const EditOutcome& said) {
    outcome = said;
    loop.quit();
  });
  if (!outcome) loop.exec();
  if (outcome->cancelled) throw Cancelled();
  if (!outcome->problem.empty()) throw Error(outcome->problem);
}

void EditController::settle() {
  if (!scene_) return;
  if (!thread_.busy()) return takeEvents(); // of what is done and was not heard of
  try {
    waitFor([this](EditThread::Done done) {
      thread_.apply(
          "", [](const CompiledScene&) { return nullptr; }, false, std::move(done));
    });
  } catch (const Cancelled&) { // then nothing waits any more
  }
}

} // namespace patina
