// The scene of the window: how it comes and how it is shown.
#include <algorithm>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/window/main_window.h"
#include "core/error.h"
#include "haptics/devices/device_catalog.h"
#include "haptics/stability/stabilisers.h"
#include "scene/paint/grey_relief.h"

namespace patina {
namespace {

QString newtonsPerMetre(double value) {
  return QStringLiteral("%1 N/m").arg(value, 0, value < 1e5 ? 'f' : 'g', value < 1e5 ? 0 : 3);
}

// What follows from the device's numbers, in words.
QString stabilityNote(const StabiliserPlan& plan) {
  QString words;
  if (plan.predicted_limit)
    words = MainWindow::tr("A plain wall is stable up to %1 on this device.")
                .arg(newtonsPerMetre(*plan.predicted_limit));
  if (plan.coupling)
    words += MainWindow::tr(" Coupling: %1, %2 N s/m.")
                 .arg(newtonsPerMetre(plan.coupling->stiffness))
                 .arg(plan.coupling->damping, 0, 'g', 2);
  if (plan.lateral)
    words += MainWindow::tr(" Along the texture: %1, %2 N s/m.")
                 .arg(newtonsPerMetre(plan.lateral->stiffness))
                 .arg(plan.lateral->damping, 0, 'g', 2);
  return words.trimmed();
}

bool hasRelief(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) {
    return o.paint && hasRelief(*o.paint, scene.relief.source);
  });
}

} // namespace

void MainWindow::connectLoader() {
  const auto name = [this] {
    const auto& path = loader_->request().path;
    return path.empty() ? tr("the toy dinosaur") : QString::fromStdString(path.filename().string());
  };
  connect(loader_, &SceneLoader::progressed, load_bar_, &LoadBar::report);
  connect(loader_, &SceneLoader::meshReady, this, &MainWindow::showPreview);
  connect(loader_, &SceneLoader::ready, this,
          [this](std::shared_ptr<OpenedEditor> opened) { take(*opened); });
  connect(loader_, &SceneLoader::read, this,
          [this](std::shared_ptr<OpenedScene> objects) { addObjects(*objects); });
  connect(loader_, &SceneLoader::failed, this, &MainWindow::loadProblem);
  connect(loader_, &SceneLoader::cancelled, this, [this] {
    if (closing_) return;
    restore();
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
  connect(load_bar_, &LoadBar::cancelled, this, [this] {
    if (loader_->busy()) return loader_->cancel();
    edits_->cancel();
  });
}

void MainWindow::open(const LoadRequest& request) {
  std::error_code code;
  const bool is_open = !request.adds && !request.recover && standing_.folder &&
                       std::filesystem::equivalent(request.path, *standing_.folder, code);
  if (is_open) { // its journal is ours: there is nothing in the folder that is not in the window
    QMetaObject::invokeMethod(
        this, [this] { emit sceneReady(); }, Qt::QueuedConnection);
    return;
  }
  const QString name = !request.place.empty() ? tr("the recovered scene")
                       : request.path.empty()
                           ? tr("the toy dinosaur")
                           : QString::fromStdString(request.path.filename().string());
  load_bar_->begin(request.adds ? tr("Adding %1").arg(name) : tr("Opening %1").arg(name), name);
  loader_->start(request);
}

void MainWindow::showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name) {
  previewing_ = true;
  closeFeel();
  desk_->setScene(nullptr, false);
  view_->setField(nullptr);
  view_->view().setField(nullptr);
  view_->view().setStability(nullptr, {});
  view_->view().setPaint({});
  view_->view().setMesh(mesh);
  view_->view().setView(ViewPreset::iso);
  object_->showMesh(*mesh, name);
  for (QWidget* card : cards()) card->hide();
  for (QWidget* card : {static_cast<QWidget*>(brush_), static_cast<QWidget*>(relief_)})
    card->hide();
  history_dock_->hide();
  object_->show();
  display_->setField(nullptr);
  paint_display_->setAvailable({});
  display_->show();
  status_->showScene(nullptr);
  view_->refresh();
}

void MainWindow::take(OpenedEditor& opened) {
  const auto& request = loader_->request();
  name_ = !request.place.empty() ? tr("Recovered scene")
          : request.path.empty() ? QString()
                                 : QString::fromStdString(request.path.filename().string());
  if (!request.path.empty()) recent_->add(QString::fromStdString(request.path.string()));
  showWarnings(opened.warnings);
  edits_->adopt(std::move(opened.editor), std::move(opened.autosave));
}

void MainWindow::showWarnings(const QStringList& lines) {
  warnings_->setText(lines.join(QStringLiteral("\n")));
  warnings_->setVisible(!lines.isEmpty());
}

void MainWindow::restore() {
  load_bar_->end();
  if (current_ == nullptr) {
    previewing_ = false;
    closeFeel();
    desk_->setScene(nullptr, false);
    view_->setField(nullptr);
    view_->view().setField(nullptr);
    view_->view().setMesh(nullptr);
    for (QWidget* card : cards()) card->hide();
    status_->showScene(nullptr);
    for (QAction* action :
         {save_action_, save_as_action_, record_action_, undo_action_, redo_action_})
      action->setEnabled(false);
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

void MainWindow::showPaint() {
  SceneView& view = view_->view();
  view.setPaint(current_->scene);
  std::vector<PaintQuantity> available;
  for (std::size_t i = 0; i < kPaintQuantities; ++i)
    if (view.hasPaint(static_cast<PaintQuantity>(i)))
      available.push_back(static_cast<PaintQuantity>(i));
  paint_display_->setAvailable(available);
  showRelief();
}

void MainWindow::showRelief() {
  const bool wanted = current_ && (hasRelief(current_->scene) ||
                                   tools_->choice() == ToolChoice{Handling::paint, Tool::relief});
  if (wanted) relief_->show(current_);
  relief_->setVisible(wanted && !previewing_);
}

void MainWindow::showCurrent() {
  load_bar_->end();
  view_->view().setStability(nullptr, {});
  syncPanels();
  haptics_->setProblem({});
  objects_->setProblem({});
  showSurface();
  showPaint();
  showValues();
  // A preview has set mesh and camera already; a failed load has replaced both.
  if (previewing_) view_->view().setView(ViewPreset::iso);
  previewing_ = false;
  for (QWidget* card : cards()) card->show();
  brush_->setVisible(tools_->choice().handling == Handling::paint);
  showRelief();
  history_dock_->setVisible(!standing_.edits.empty());
  for (QAction* action : {save_action_, save_as_action_, record_action_}) action->setEnabled(true);
  values_edited_ = false;
  openFeelAt(view_->restingPlace());
  desk_->setScene(current_, false);
}

void MainWindow::openFeelAt(const Vec3& start) {
  closeFeel();
  last_sample_ = {};
  force_plot_->clear();
  energy_plot_->restart();
  view_->setTarget(start);
  const Scene& scene = current_->scene;
  const DeviceEntry& entry = deviceNamed(scene.device);
  const auto target = std::make_shared<TipTarget>(start);
  const DeviceModel model =
      entry.takes_numbers ? scene.device_model.value_or(entry.model) : entry.model;
  try {
    feel_.open(openDevice(entry, {.target = target, .model = model}), target, model.rate);
  } catch (const DeviceError& error) {
    haptics_->setProblem(QString::fromUtf8(error.what()));
  }
}

void MainWindow::showValues() {
  const Scene& scene = current_->scene;
  view_->view().setTipRadius(scene.haptics.tip_radius.value_or(0));
  const auto band = touchBand(scene.haptics);
  view_->view().setBand(band);
  display_->setBand(band.has_value());
  device_->setNote(stabilityNote(current_->snapshot->stabilisers));
  status_->showScene(current_.get());
  askStability();
}

void MainWindow::askStability() {
  const bool wanted = current_ != nullptr && display_->shown(Layer::stability);
  stability_->request(wanted ? current_ : nullptr);
}

} // namespace patina
