#include "app/gui/control/edit_controller.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <QEventLoop>

#include "core/error.h"
#include "core/numbers.h"
#include "pictures/picture_file.h"
#include "scene/paint/grey_relief.h"
#include "scene/scene.h"

namespace patina {
namespace {

// Turns changes of the object list into edits of a scene that may have changed meanwhile.

auto find(const std::vector<SceneObject>& list, const std::string& name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const SceneObject& object) { return object.name == name; });
}

// "turn cup by 30° about z", "move cup by 12 mm"; a combined motion is called a move.
std::string wordsFor(const SceneObject& object, const Pose& now) {
  const Pose& before = object.world_from_object;
  const double way = (now.translation() - before.translation()).norm();
  if (way > 0) return "move " + object.name + " by " + formatLength(way);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(now.linear() * before.linear().transpose()));
  std::string words = "turn " + object.name + " by " +
                      formatNumber(std::round(turn.angle() * 1800 / M_PI) / 10) + "°";
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(turn.axis()[axis]) > 0.9999) words += std::string(" about ") + "xyz"[axis];
  return words;
}

// Compares names, meshes and poses, not paint.
bool sameObjects(const std::vector<SceneObject>& a, const std::vector<SceneObject>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SceneObject& left, const SceneObject& right) {
                      return left.name == right.name && left.mesh == right.mesh &&
                             left.world_from_object.matrix() == right.world_from_object.matrix();
                    });
}

// Applies moves and removals between `before` and `edited` to `now`; the rest of it stays.
std::vector<SceneObject> withEdits(const std::vector<SceneObject>& now,
                                   const std::vector<SceneObject>& before,
                                   const std::vector<SceneObject>& edited) {
  std::vector<SceneObject> result;
  for (const SceneObject& object : now) {
    const auto known = find(edited, object.name);
    if (known == edited.end() && find(before, object.name) != before.end()) continue;
    result.push_back(object);
    if (known != edited.end()) result.back().world_from_object = known->world_from_object;
  }
  return result;
}

// "move cup by 12 mm", for the history; empty: nothing moved or removed.
std::string wordsFor(const std::vector<SceneObject>& before,
                     const std::vector<SceneObject>& edited) {
  for (const SceneObject& object : before) {
    const auto now = find(edited, object.name);
    if (now == edited.end()) return "remove " + object.name;
    if (now->world_from_object.matrix() != object.world_from_object.matrix())
      return wordsFor(object, now->world_from_object);
  }
  return {};
}

// Adds objects under unique names: "cup", "cup-2", "cup-3".
Scene withAdded(Scene scene, const std::vector<SceneObject>& objects) {
  for (SceneObject object : objects) {
    const std::string name = object.name;
    for (int number = 2; find(scene.objects, object.name) != scene.objects.end(); ++number)
      object.name = name + "-" + std::to_string(number);
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

bool anyRelief(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) {
    return o.paint && hasRelief(*o.paint, scene.relief.source);
  });
}

} // namespace

EditController::EditController(const Parts& parts, Publish publish, Ticks ticks, QObject* parent)
    : QObject(parent), at_(parts),
      thread_({std::move(publish),
               [this] {
                 QMetaObject::invokeMethod(
                     this, [this] { takeEvents(); }, Qt::QueuedConnection);
               },
               stateFolder(), std::move(ticks)}) {
  const auto edited = [this] {
    values_edited_ = true;
    setUnsaved(true);
  };
  connect(&at_.haptics, &HapticsPanel::edited, this, edited);
  connect(&at_.device, &DevicePanel::edited, this, edited);
  connect(&at_.objects, &ObjectList::edited, this, &EditController::applyObjects);
  connect(&at_.relief, &ReliefPanel::edited, this, [this](const ReliefSettings& relief) {
    setUnsaved(true);
    thread_.previewValues([relief](Scene& scene) { scene.relief = relief; });
  });
  connect(&at_.history, &HistoryPanel::positionRequested, this,
          [this](std::size_t position) { thread_.goTo(position); });
}

std::optional<TaskProgress> EditController::work() const {
  if (!progress_) return std::nullopt;
  const QString title = QString::fromStdString(progress_->title);
  return TaskProgress{title, title + QStringLiteral(": ") + QString::fromStdString(progress_->what),
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
  if (events.compiled) takeScene(events.compiled, events.is_new_scene);
  emit changed();
  if (!events.problems.empty()) emit refused(QString::fromStdString(events.problems.back()));
  for (const auto& done : events.done) done();
}

void EditController::takeScene(std::shared_ptr<const CompiledScene> scene, bool is_new) {
  const auto before = std::exchange(scene_, std::move(scene));
  if (before && !is_new) return showScene(editBetween(*before, scene_));
  values_pending_ = objects_pending_ = 0;
  showScene({scene_});
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

// Also called after undo and redo.
void EditController::syncPanels() {
  const Scene& scene = scene_->scene;
  if (values_pending_ == 0 && !values_edited_) {
    if (!(at_.haptics.values() == scene.haptics)) at_.haptics.setValues(scene.haptics);
    if (!(at_.device.values() == deviceChoice(scene))) at_.device.setValues(deviceChoice(scene));
  }
  const ObjectChoice& shown = at_.objects.values();
  if (objects_pending_ == 0 &&
      (!sameObjects(shown.objects, scene.objects) || shown.redistance != scene.redistance))
    at_.objects.setValues(scene);
}

void EditController::previewValues() {
  if (!std::exchange(values_edited_, false) || !scene_) return;
  const HapticProperties haptics = at_.haptics.values();
  const DeviceChoice device = at_.device.values();
  ++values_pending_;
  thread_.previewValues(
      [haptics, device](Scene& scene) {
        scene.haptics = haptics;
        scene.device = device.device;
        scene.device_model = device.model;
        scene.stabilisers = device.stabilisers;
      },
      [this](const EditOutcome& outcome) {
        values_pending_ = std::max(0, values_pending_ - 1);
        at_.haptics.setProblem(QString::fromStdString(outcome.problem));
        if (values_pending_ == 0 && !values_edited_) setUnsaved(status_.unsaved);
      });
}

void EditController::undo() {
  previewValues(); // Includes changes since the last tick.
  thread_.undo();
}

void EditController::applyObjects() {
  if (!scene_) return;
  setUnsaved(true);
  const ObjectChoice choice = at_.objects.values();
  if (choice.redistance != scene_->scene.redistance)
    thread_.previewValues([choice](Scene& scene) { scene.redistance = choice.redistance; });
  const auto before = scene_->scene.objects;
  const std::string words = wordsFor(before, choice.objects);
  if (words.empty() && objects_pending_ == 0) return;
  ++objects_pending_;
  thread_.apply(
      words.empty() ? "move" : words,
      [before, choice](const CompiledScene& now) -> std::shared_ptr<const Scene> {
        auto scene = std::make_shared<Scene>(now.scene);
        scene->objects = withEdits(now.scene.objects, before, choice.objects);
        return sameObjects(scene->objects, now.scene.objects) ? nullptr : scene;
      },
      true,
      [this](const EditOutcome& outcome) {
        objects_pending_ = std::max(0, objects_pending_ - 1);
        if (objects_pending_ > 0) return;
        syncPanels();
        at_.objects.setProblem(QString::fromStdString(outcome.problem));
      });
}

// The empty request ends the collecting of values.
void EditController::changeValues(std::function<void(Scene&)> change) {
  previewValues();
  thread_.previewValues(std::move(change));
  thread_.apply("", [](const CompiledScene&) { return nullptr; });
}

void EditController::changeLooks(std::function<void(Scene&)> change) {
  setUnsaved(true);
  thread_.previewValues(std::move(change), [this](const EditOutcome& outcome) {
    emit looksDone();
    if (!outcome.problem.empty()) emit refused(QString::fromStdString(outcome.problem));
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

void EditController::layPicture(const std::filesystem::path& file, const std::string& object,
                                PictureEdit edit, EditThread::Done done) {
  thread_.apply(
      "lay " + file.filename().string(),
      [file, object, edit](const CompiledScene& now) mutable {
        const Picture picture = readPicture(file);
        auto scene = std::make_shared<Scene>(now.scene);
        const auto named = std::find_if(scene->objects.begin(), scene->objects.end(),
                                        [&](const SceneObject& o) { return o.name == object; });
        if (named == scene->objects.end()) throw Error(object + " is no longer in the scene");
        edit.object = static_cast<std::size_t>(named - scene->objects.begin());
        std::shared_ptr<const PaintSurface> surface;
        Progress progress;
        patina::layPicture(*scene, now, edit, picture, surface, progress);
        return scene;
      },
      false, std::move(done));
}

void EditController::rereadObject(const std::string& object,
                                  std::shared_ptr<const TriangleMesh> mesh, MeshUnit was,
                                  MeshUnit now, UpAxis up, EditThread::Done done) {
  if (was == now && up == UpAxis::z) return;
  thread_.apply(
      "read " + object + " in " + std::string(name(now)) + (up == UpAxis::y ? ", y up" : ""),
      [=](const CompiledScene& present) {
        return std::make_shared<const Scene>(
            withReread(present.scene, object, mesh.get(), was, now, up));
      },
      false, std::move(done));
}

void EditController::waitFor(const std::function<void(EditThread::Done)>& ask) {
  QEventLoop loop;
  std::optional<EditOutcome> outcome;
  ask([&](const EditOutcome& notified) {
    outcome = notified;
    loop.quit();
  });
  if (!outcome) loop.exec();
  if (outcome->cancelled) throw Cancelled();
  if (!outcome->problem.empty()) throw Error(outcome->problem);
}

void EditController::waitForEdits() {
  if (!scene_) return;
  if (!thread_.busy()) return takeEvents(); // Takes the events of edits that are already done.
  try {
    waitFor([this](EditThread::Done done) {
      thread_.apply(
          "", [](const CompiledScene&) { return nullptr; }, false, std::move(done));
    });
  } catch (const Cancelled&) { // The queue is empty then.
  }
}

} // namespace patina
