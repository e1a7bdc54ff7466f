// The scene of the window: how it comes, is edited and is shown.
#include <algorithm>

#include "app/gui/hand_device.h"
#include "app/gui/load_dialogs.h"
#include "app/gui/main_window.h"
#include "core/numbers.h"
#include "haptics/stabilisers.h"

namespace patina {
namespace {

Scene withValues(Scene scene, const HapticProperties& haptics, const DeviceChoice& device) {
  scene.haptics = haptics;
  scene.device = device.device;
  scene.device_model = device.model;
  scene.stabilisers = device.stabilisers;
  return scene;
}

bool sameDevice(const Scene& a, const Scene& b) {
  return a.device == b.device && (a.device == "mouse" || a.device_model == b.device_model);
}

// `now`, with what a person has moved and removed since it was `before`: an object that was added
// meanwhile stays.
std::vector<SceneObject> withEdits(const std::vector<SceneObject>& now,
                                   const std::vector<SceneObject>& before,
                                   const std::vector<SceneObject>& edited) {
  const auto find = [](const std::vector<SceneObject>& list, const std::string& name) {
    return std::find_if(list.begin(), list.end(),
                        [&](const SceneObject& object) { return object.name == name; });
  };
  std::vector<SceneObject> result;
  for (const SceneObject& object : now) {
    const auto known = find(edited, object.name);
    if (known != edited.end())
      result.push_back({object.name, object.mesh, known->world_from_object});
    else if (find(before, object.name) == before.end())
      result.push_back(object);
  }
  return result;
}

QString newtonsPerMetre(double value) {
  return QStringLiteral("%1 N/m").arg(value, 0, value < 1e5 ? 'f' : 'g', value < 1e5 ? 0 : 3);
}

// What follows from the device's numbers, in words.
QString stabilityNote(const Scene& scene) {
  const StabiliserPlan plan = planStabilisers(scene.haptics, scene.device_model, scene.stabilisers);
  QString words;
  if (plan.predicted_limit)
    words = MainWindow::tr("A plain wall is stable up to %1 on this device.")
                .arg(newtonsPerMetre(*plan.predicted_limit));
  if (plan.coupling)
    words += MainWindow::tr(" Coupling: %1, %2 N s/m.")
                 .arg(newtonsPerMetre(plan.coupling->stiffness))
                 .arg(plan.coupling->damping, 0, 'g', 2);
  return words.trimmed();
}

} // namespace

void MainWindow::connectLoader() {
  const auto name = [this] {
    const auto& path = loader_->request().path;
    return path.empty() ? tr("the toy dinosaur") : QString::fromStdString(path.filename().string());
  };
  connect(loader_, &SceneLoader::progressed, load_bar_, &LoadBar::report);
  connect(loader_, &SceneLoader::meshReady, this, &MainWindow::showPreview);
  connect(loader_, &SceneLoader::ready, this, &MainWindow::take);
  connect(loader_, &SceneLoader::rebuilt, this, &MainWindow::takeRebuilt);
  connect(loader_, &SceneLoader::failed, this, [this, name](const QString& message) {
    restore();
    showProblem(this, tr("%1 cannot be opened").arg(name()), message, adviceFor(message));
    emit loadFailed(message);
  });
  connect(loader_, &SceneLoader::rebuildFailed, this, [this](const QString& message) {
    restore();
    objects_edited_ = false;
    objects_->setValues(current_->scene);
    objects_->setProblem(message);
  });
  connect(loader_, &SceneLoader::cancelled, this, [this] {
    if (closing_) return;
    restore();
    objects_edited_ = false;
    if (current_ != nullptr) objects_->setValues(current_->scene);
    emit loadCancelled();
  });
  connect(loader_, &SceneLoader::needsUnit, this, [this, name](double longest) {
    restore();
    askUnit(this, name(), longest, [this](MeshUnit unit) {
      LoadRequest request = loader_->request();
      request.options.unit = unit;
      request.unit_chosen = true;
      open(request);
    });
  });
  connect(loader_, &SceneLoader::needsIso, this, [this, name](double low, double high) {
    restore();
    askIso(this, name(), low, high, [this](double iso) {
      LoadRequest request = loader_->request();
      request.options.iso = iso;
      open(request);
    });
  });
}

void MainWindow::connectPanels() {
  connect(display_, &DisplayPanel::layerToggled, this, [this](Layer layer, bool on) {
    view_->view().show(layer, on);
    if (layer == Layer::stability) askStability();
  });
  connect(display_, &DisplayPanel::sliceMoved, this,
          [this](const SlicePlace& place) { view_->view().setSlice(place); });
  connect(display_, &DisplayPanel::isoMoved, this,
          [this](double iso) { view_->view().setIso(iso); });
  const auto edited = [this] {
    values_edited_ = true;
    setWindowModified(true);
  };
  connect(haptics_, &HapticsPanel::edited, this, edited);
  connect(device_, &DevicePanel::edited, this, edited);
  connect(objects_, &ObjectList::edited, this, &MainWindow::applyObjects);
  connect(objects_, &ObjectList::addAsked, this, [this] { openDialog(true); });
  connect(stability_, &StabilityJob::said, display_, &DisplayPanel::setStabilityNote);
  connect(stability_, &StabilityJob::done, this,
          [this](std::shared_ptr<const SurfaceStability> made) {
            view_->view().setStability(made ? made->surface.get() : nullptr,
                                       made ? made->map.ratio : std::vector<float>{});
          });
}

void MainWindow::open(const LoadRequest& request) {
  const QString name = request.path.empty()
                           ? tr("the toy dinosaur")
                           : QString::fromStdString(request.path.filename().string());
  load_bar_->begin(request.onto ? tr("Adding %1").arg(name) : tr("Opening %1").arg(name), name);
  LoadRequest onto_current = request;
  if (request.onto) onto_current.onto = current_; // a question may have taken its time
  loader_->start(onto_current);
}

void MainWindow::showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name) {
  previewing_ = true;
  closeFeel();
  view_->setField(nullptr);
  view_->view().setField(nullptr);
  view_->view().setStability(nullptr, {});
  view_->view().setMesh(mesh);
  view_->view().setView(ViewPreset::iso);
  object_->showMesh(*mesh, name);
  for (QWidget* card : cards()) card->hide();
  object_->show();
  display_->setField(nullptr);
  display_->show();
  status_->showScene(nullptr);
  view_->refresh();
}

void MainWindow::take(std::shared_ptr<const CompiledScene> scene, const QStringList& warnings) {
  current_ = std::move(scene);
  warnings_->setText(warnings.join(QStringLiteral("\n")));
  warnings_->setVisible(!warnings.isEmpty());
  const auto& path = loader_->request().path;
  setWindowTitle(path.empty()
                     ? tr("Patina[*]")
                     : tr("%1[*] – Patina").arg(QString::fromStdString(path.filename().string())));
  setWindowModified(false);
  if (!path.empty()) recent_->add(QString::fromStdString(path.string()));
  showCurrent();
  emit sceneReady();
}

void MainWindow::takeRebuilt(std::shared_ptr<const CompiledScene> scene,
                             const QStringList& warnings) {
  load_bar_->end();
  setWindowModified(true);
  if (!warnings.isEmpty()) {
    warnings_->setText(warnings.join(QStringLiteral("\n")));
    warnings_->show();
  }
  objects_->setProblem({});
  Scene wanted = scene->scene;
  if (objects_edited_)
    wanted.objects = withEdits(wanted.objects, current_->scene.objects, objects_->values().objects);
  try {
    // What was edited while the objects were on their way is felt with them.
    current_ = retuned(*scene, withValues(scene->scene, haptics_->values(), device_->values()));
  } catch (const std::exception& error) {
    current_ = std::move(scene);
    haptics_->setProblem(QString::fromStdString(error.what()));
  }
  showSurface();
  showValues();
  feel_.publish(current_->snapshot);
  objects_->setValues(wanted);
  if (objects_edited_) applyObjects();
  emit sceneReady();
}

void MainWindow::restore() {
  load_bar_->end();
  if (current_ == nullptr) {
    previewing_ = false;
    closeFeel();
    view_->setField(nullptr);
    view_->view().setField(nullptr);
    view_->view().setMesh(nullptr);
    for (QWidget* card : cards()) card->hide();
    status_->showScene(nullptr);
    for (QAction* action : {save_action_, record_action_}) action->setEnabled(false);
  } else if (previewing_) {
    showCurrent();
  }
}

void MainWindow::showSurface() {
  const CompiledScene& scene = *current_;
  view_->view().setMesh(scene.mesh);
  view_->view().setField(scene.built.field);
  view_->setField(scene.built.field);
  object_->showScene(scene);
  const SurfaceField& field = *scene.built.field;
  haptics_->setReach(std::max(0.0, field.band - 3) * field.grid.voxel);
  display_->setField(&field);
}

void MainWindow::showCurrent() {
  load_bar_->end();
  const CompiledScene& scene = *current_;
  view_->view().setStability(nullptr, {});
  haptics_->setValues(scene.scene.haptics);
  haptics_->setProblem({});
  device_->setValues(deviceChoice(scene.scene));
  objects_->setValues(scene.scene);
  objects_->setProblem({});
  showSurface();
  showValues();
  // A preview has set mesh and camera already; a failed load has replaced both.
  if (previewing_) view_->view().setView(ViewPreset::iso);
  previewing_ = false;
  for (QWidget* card : cards()) card->show();
  for (QAction* action : {save_action_, record_action_}) action->setEnabled(true);
  values_edited_ = objects_edited_ = false;
  openFeelAt(view_->restingPlace());
}

void MainWindow::openFeelAt(const Vec3& start) {
  closeFeel();
  last_sample_ = {};
  force_plot_->clear();
  energy_plot_->restart();
  view_->setTarget(start);
  const Scene& scene = current_->scene;
  const bool simulated = scene.device == "simulated";
  HandSpec hand;
  hand.device = scene.device_model.value_or(DeviceModel{});
  feel_.open(current_->snapshot, simulated ? makeHandDevice(start, hand) : makeMouseDevice(start),
             simulated ? hand.device.rate : DeviceModel{}.rate);
}

void MainWindow::showValues() {
  const Scene& scene = current_->scene;
  view_->view().setTipRadius(scene.haptics.tip_radius.value_or(0));
  const auto band = touchBand(scene.haptics);
  view_->view().setBand(band);
  display_->setBand(band.has_value());
  device_->setNote(stabilityNote(scene));
  status_->showScene(current_.get());
  askStability();
}

void MainWindow::askStability() {
  const bool wanted = current_ != nullptr && display_->shown(Layer::stability);
  stability_->request(wanted ? current_ : nullptr);
}

void MainWindow::applyValues() {
  values_edited_ = false;
  if (current_ == nullptr) return;
  const auto before = current_;
  try {
    current_ = retuned(*before, withValues(before->scene, haptics_->values(), device_->values()));
    haptics_->setProblem({});
  } catch (const std::exception& error) {
    haptics_->setProblem(QString::fromStdString(error.what()));
    return;
  }
  if (sameDevice(before->scene, current_->scene))
    feel_.publish(current_->snapshot);
  else
    openFeelAt(last_sample_.tip);
  showValues();
}

void MainWindow::applyObjects() {
  if (current_ == nullptr) return;
  setWindowModified(true);
  objects_edited_ = loader_->busy();
  if (objects_edited_) return;
  Scene scene = current_->scene;
  scene.objects = objects_->values().objects;
  scene.redistance = objects_->values().redistance;
  load_bar_->begin(tr("Merging the objects"), tr("Objects"), true);
  loader_->rebuild(current_, std::move(scene));
}

} // namespace patina
