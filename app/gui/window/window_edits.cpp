// What the window asks of the edit thread, and what it hears back.
#include <algorithm>

#include <QEventLoop>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/window/main_window.h"
#include "core/error.h"
#include "haptics/devices/device_catalog.h"
#include "session/build/compile_warnings.h"

namespace patina {
namespace {

bool sameDevice(const Scene& a, const Scene& b) {
  return a.device == b.device &&
         (!deviceNamed(a.device).takes_numbers || a.device_model == b.device_model);
}

bool sameValues(const Scene& a, const Scene& b) {
  return a.haptics == b.haptics && deviceChoice(a) == deviceChoice(b) && a.relief == b.relief;
}

auto find(const std::vector<SceneObject>& list, const std::string& name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const SceneObject& object) { return object.name == name; });
}

bool sameObjects(const std::vector<SceneObject>& a, const std::vector<SceneObject>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SceneObject& left, const SceneObject& right) {
                      return left.name == right.name && left.mesh == right.mesh &&
                             left.world_from_object.matrix() == right.world_from_object.matrix();
                    });
}

// `now`, with what a person has moved and removed since it was `before`: an object that was added
// meanwhile, and what was painted, stays.
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

// For the history.
std::string wordsFor(const std::vector<SceneObject>& before,
                     const std::vector<SceneObject>& edited) {
  for (const SceneObject& object : before) {
    const auto now = find(edited, object.name);
    if (now == edited.end()) return "remove " + object.name;
    if (now->world_from_object.matrix() != object.world_from_object.matrix())
      return "move " + object.name;
  }
  return {};
}

// "cup", "cup-2", "cup-3": a name that the scene does not have.
std::string freeName(const Scene& scene, const std::string& name) {
  std::string free = name;
  for (int number = 2; find(scene.objects, free) != scene.objects.end(); ++number)
    free = name + "-" + std::to_string(number);
  return free;
}

} // namespace

void MainWindow::connectPanels() {
  connect(view_, &SceneWidget::tipMoved, this,
          [this](const Vec3& target) { feel_.setTarget(target); });
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

void MainWindow::connectPaint() {
  connect(desk_, &PaintController::chosen, this, &MainWindow::chooseTool);
  connect(desk_, &PaintController::underPointer, status_, &StatusLine::showPicked);
  connect(relief_, &ReliefPanel::edited, this, [this](const ReliefSettings& relief) {
    setWindowModified(true);
    edits_->tryValues([relief](Scene& scene) { scene.relief = relief; });
  });
  connect(paint_display_, &PaintDisplay::showAsked, this,
          [this](std::optional<PaintQuantity> quantity) {
            for (std::size_t i = 0; i < kPaintQuantities; ++i)
              view_->view().show(static_cast<Layer>(static_cast<std::size_t>(Layer::color) + i),
                                 quantity && static_cast<std::size_t>(*quantity) == i);
          });
  connect(paint_display_, &PaintDisplay::lockAsked, this,
          [this](PaintQuantity quantity, std::optional<ValueRange> range) {
            view_->view().lockPaintRange(quantity, range);
          });
  connect(history_, &HistoryPanel::asked, this,
          [this](std::size_t position) { edits_->goTo(position); });
  connect(recover_, &RecoverBar::recoverAsked, this, [this](const std::filesystem::path& place) {
    LoadRequest request;
    request.place = place;
    openAsked(request);
  });
}

void MainWindow::chooseTool(const ToolChoice& choice) {
  brush_->setVisible(current_ && choice.handling == Handling::paint);
  paint_display_->setTool(choice);
  showRelief();
}

void MainWindow::takeNews() {
  const EditEvents news = edits_->take();
  if (news.status) takeStanding(*news.status);
  if (news.compiled) takeScene(news);
  showDoing(news.progress);
  if (!news.problems.empty())
    showProblem(this, tr("That cannot be done"), QString::fromStdString(news.problems.back()),
                tr("The scene is as it was before."));
  for (const auto& done : news.done) done();
}

void MainWindow::takeStanding(const EditStatus& standing) {
  standing_ = standing;
  if (standing.folder) name_ = QString::fromStdString(standing.folder->filename().string());
  setWindowTitle(name_.isEmpty() ? tr("Patina[*]") : tr("%1[*] – Patina").arg(name_));
  setWindowModified(standing.unsaved || values_edited_);
  history_->show(standing);
  history_dock_->setVisible(!standing.edits.empty() && !previewing_);
  undo_action_->setEnabled(standing.done > 0);
  redo_action_->setEnabled(standing.done < standing.edits.size());
}

void MainWindow::takeScene(const EditEvents& news) {
  const auto before = std::exchange(current_, news.compiled);
  if (news.anew || !before) {
    // Whether a preview was shown or not: the camera of another scene says nothing of this one.
    previewing_ = true;
    values_asked_ = objects_asked_ = 0;
    showCurrent();
    desk_->setScene(current_, true);
    emit sceneReady();
    return;
  }
  if (previewing_) return; // seen when what is being opened has come, or has not
  const bool surface =
      before->mesh != current_->mesh || before->built.field != current_->built.field;
  if (surface) showSurface();
  showPaint();
  desk_->setScene(current_, false);
  if (!sameDevice(before->scene, current_->scene)) openFeelAt(last_sample_.tip);
  if (surface || !sameValues(before->scene, current_->scene))
    showValues();
  else
    stages_shown_ = false;
  syncPanels();
  if (surface) emit sceneReady();
}

void MainWindow::syncPanels() {
  const Scene& scene = current_->scene;
  if (values_asked_ == 0 && !values_edited_) {
    if (!(haptics_->values() == scene.haptics)) haptics_->setValues(scene.haptics);
    if (!(device_->values() == deviceChoice(scene))) device_->setValues(deviceChoice(scene));
  }
  const ObjectChoice& shown = objects_->values();
  if (objects_asked_ == 0 &&
      (!sameObjects(shown.objects, scene.objects) || shown.redistance != scene.redistance))
    objects_->setValues(scene);
}

void MainWindow::showDoing(const std::optional<EditProgress>& doing) {
  if (loader_->busy()) return; // it has the bar
  if (!doing) return load_bar_->end();
  const QString title = QString::fromStdString(doing->title);
  if (!load_bar_->showing(title)) load_bar_->begin(title, title, true);
  load_bar_->report(doing->fraction, QString::fromStdString(doing->what));
}

void MainWindow::tryValues() {
  values_edited_ = false;
  if (current_ == nullptr || previewing_) return;
  const HapticProperties haptics = haptics_->values();
  const DeviceChoice device = device_->values();
  ++values_asked_;
  edits_->tryValues(
      [haptics, device](Scene& scene) {
        scene.haptics = haptics;
        scene.device = device.device;
        scene.device_model = device.model;
        scene.stabilisers = device.stabilisers;
      },
      [this](const std::string& problem) {
        values_asked_ = std::max(0, values_asked_ - 1);
        haptics_->setProblem(QString::fromStdString(problem));
        if (values_asked_ == 0 && !values_edited_) setWindowModified(standing_.unsaved);
      });
}

void MainWindow::applyObjects() {
  if (current_ == nullptr) return;
  setWindowModified(true);
  const ObjectChoice choice = objects_->values();
  if (choice.redistance != current_->scene.redistance)
    edits_->tryValues([choice](Scene& scene) { scene.redistance = choice.redistance; });
  const auto before = current_->scene.objects;
  const std::string words = wordsFor(before, choice.objects);
  if (words.empty() && objects_asked_ == 0) return;
  ++objects_asked_;
  edits_->apply(
      words.empty() ? "move" : words,
      [before, choice](const CompiledScene& now) -> std::shared_ptr<const Scene> {
        auto scene = std::make_shared<Scene>(now.scene);
        scene->objects = withEdits(now.scene.objects, before, choice.objects);
        return sameObjects(scene->objects, now.scene.objects) ? nullptr : scene;
      },
      true,
      [this](const std::string& problem) {
        objects_asked_ = std::max(0, objects_asked_ - 1);
        if (objects_asked_ > 0) return;
        syncPanels();
        const bool cancelled = problem == Cancelled().what();
        objects_->setProblem(cancelled ? QString() : QString::fromStdString(problem));
        if (cancelled) emit loadCancelled();
      });
}

void MainWindow::addObjects(const OpenedScene& opened) {
  QStringList lines;
  for (const std::string& line : opened.warnings) lines << QString::fromStdString(line);
  const std::string what = "add " + opened.scene.objects.front().name;
  const auto objects = opened.scene.objects;
  edits_->apply(
      what,
      [objects](const CompiledScene& now) {
        auto scene = std::make_shared<Scene>(now.scene);
        for (SceneObject object : objects) {
          object.name = freeName(*scene, object.name);
          scene->objects.push_back(std::move(object));
        }
        return scene;
      },
      false,
      [this, lines](const std::string& problem) {
        if (problem == Cancelled().what()) {
          emit loadCancelled();
        } else if (!problem.empty()) {
          loadProblem(QString::fromStdString(problem));
        } else if (!lines.isEmpty()) {
          showWarnings(lines);
        }
      });
}

void MainWindow::waitFor(const std::function<void(EditThread::Done)>& ask) {
  QEventLoop loop;
  std::string problem;
  bool done = false;
  ask([&](const std::string& said) {
    problem = said;
    done = true;
    loop.quit();
  });
  if (!done) loop.exec();
  if (!problem.empty()) throw Error(problem);
}

} // namespace patina
