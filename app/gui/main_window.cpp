#include "app/gui/main_window.h"

#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QMimeData>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/gui/hand_device.h"
#include "app/gui/haptic_ramp.h"
#include "app/gui/load_dialogs.h"
#include "app/gui/window_style.h"
#include "core/error.h"
#include "workspace/workspace.h"

namespace patina {

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), view_(new SceneWidget), load_bar_(new LoadBar), warnings_(new QLabel),
      object_(new ObjectPanel), haptics_(new HapticsPanel), display_(new DisplayPanel),
      force_plot_(new ForcePlot), energy_plot_(new EnergyPlot),
      status_(new StatusLine(statusBar())), loader_(new SceneLoader(this)) {
  setWindowTitle(tr("Patina[*]"));
  setAcceptDrops(true);
  buildLayout();
  buildMenus();
  connectLoader();
  connect(view_, &SceneWidget::tipMoved, this,
          [this](const Vec3& target) { feel_.setTarget(target); });
  connect(display_, &DisplayPanel::layerToggled, this,
          [this](Layer layer, bool on) { view_->view().show(layer, on); });
  connect(display_, &DisplayPanel::sliceMoved, this,
          [this](const SlicePlace& place) { view_->view().setSlice(place); });
  connect(display_, &DisplayPanel::isoMoved, this,
          [this](double iso) { view_->view().setIso(iso); });
  connect(haptics_, &HapticsPanel::edited, this, [this] {
    haptics_edited_ = true;
    setWindowModified(true);
  });
  connect(load_bar_, &LoadBar::cancelled, loader_, &SceneLoader::cancel);
  restore();
  // One timer draws everything; what did not change is not drawn again.
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &MainWindow::tick);
  timer_.start(33);
}

MainWindow::~MainWindow() {
  feel_.close();
}

void MainWindow::buildLayout() {
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  warnings_->setWordWrap(true);
  warnings_->setContentsMargins(10, 5, 10, 5);
  warnings_->setStyleSheet(QStringLiteral("background: #fff4d6; color: #6b4e00;"));
  warnings_->hide();
  column->addWidget(load_bar_);
  column->addWidget(warnings_);
  column->addWidget(view_, 1);
  setCentralWidget(centre);

  auto* cards = new QWidget;
  cards->setStyleSheet(cardStyle());
  auto* stack = new QVBoxLayout(cards);
  stack->setContentsMargins(8, 0, 8, 8);
  stack->setSpacing(4);
  stack->addWidget(haptics_);
  stack->addWidget(display_);
  stack->addWidget(object_);
  stack->addStretch(1);
  auto* scroll = new QScrollArea;
  scroll->setWidget(cards);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Room for the scroll bar from the start, or it would cover the cards when it comes.
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  scroll->setFixedWidth(318);
  const auto dock = [this](const QString& title, const char* name, QWidget* widget,
                           Qt::DockWidgetArea area) {
    auto* made = new QDockWidget(title, this);
    made->setObjectName(QString::fromUtf8(name));
    made->setWidget(widget);
    made->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
    addDockWidget(area, made);
    panels_ << made->toggleViewAction();
    return made;
  };
  dock(tr("Scene"), "scene_dock", scroll, Qt::RightDockWidgetArea);
  QDockWidget* force =
      dock(tr("Force on the hand"), "force_dock", force_plot_, Qt::BottomDockWidgetArea);
  QDockWidget* energy = dock(tr("Energy taken by the surface"), "energy_dock", energy_plot_,
                             Qt::BottomDockWidgetArea);
  splitDockWidget(force, energy, Qt::Horizontal);
  resizeDocks({force, energy}, {1, 1}, Qt::Horizontal);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
}

void MainWindow::connectLoader() {
  const auto name = [this] {
    const auto& path = loader_->request().path;
    return path.empty() ? tr("the toy dinosaur") : QString::fromStdString(path.filename().string());
  };
  connect(loader_, &SceneLoader::progressed, load_bar_, &LoadBar::report);
  connect(loader_, &SceneLoader::meshReady, this, &MainWindow::showPreview);
  connect(loader_, &SceneLoader::ready, this, &MainWindow::take);
  connect(loader_, &SceneLoader::failed, this, [this, name](const QString& message) {
    restore();
    showProblem(this, tr("%1 cannot be opened").arg(name()), message, adviceFor(message));
    emit loadFailed(message);
  });
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
}

void MainWindow::open(const LoadRequest& request) {
  load_bar_->begin(request.path.empty() ? tr("the toy dinosaur")
                                        : QString::fromStdString(request.path.filename().string()));
  loader_->start(request);
}

void MainWindow::showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name) {
  previewing_ = true;
  closeFeel();
  view_->setField(nullptr);
  view_->view().setField(nullptr);
  view_->view().setMesh(mesh);
  view_->view().setView(ViewPreset::iso);
  object_->showMesh(*mesh, name);
  object_->show();
  haptics_->hide();
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

void MainWindow::restore() {
  load_bar_->end();
  if (current_ == nullptr) {
    previewing_ = false;
    closeFeel();
    view_->setField(nullptr);
    view_->view().setField(nullptr);
    view_->view().setMesh(nullptr);
    for (QWidget* card : {static_cast<QWidget*>(object_), static_cast<QWidget*>(haptics_),
                          static_cast<QWidget*>(display_)})
      card->hide();
    status_->showScene(nullptr);
    save_action_->setEnabled(false);
    record_action_->setEnabled(false);
  } else if (previewing_) {
    showCurrent();
  }
}

void MainWindow::showCurrent() {
  load_bar_->end();
  const CompiledScene& scene = *current_;
  // A preview has set mesh and camera already; a failed load has replaced both.
  view_->view().setMesh(scene.mesh);
  view_->view().setField(scene.built.field);
  view_->view().setTipRadius(scene.scene.haptics.tip_radius.value_or(0));
  view_->setField(scene.built.field);
  if (previewing_) view_->view().setView(ViewPreset::iso);
  previewing_ = false;
  object_->showScene(scene);
  haptics_->setValues(scene.scene.haptics);
  display_->setField(scene.built.field.get());
  showBand();
  for (QWidget* card : {static_cast<QWidget*>(object_), static_cast<QWidget*>(haptics_),
                        static_cast<QWidget*>(display_)})
    card->show();
  status_->showScene(&scene);
  save_action_->setEnabled(true);
  record_action_->setEnabled(true);
  haptics_edited_ = false;
  closeFeel();
  last_sample_ = {};
  force_plot_->clear();
  energy_plot_->restart();
  const Vec3 start = view_->restingPlace();
  view_->setTarget(start);
  feel_.open(scene.snapshot,
             scene.scene.device == "simulated" ? makeHandDevice(start) : makeMouseDevice(start));
}

void MainWindow::applyHaptics() {
  if (current_ == nullptr) return;
  try {
    Scene wanted = current_->scene;
    wanted.haptics = haptics_->values();
    validate(wanted);
    const HapticProperties next = steppedTowards(current_->scene.haptics, wanted.haptics);
    current_ = recompile(*current_, next);
    haptics_edited_ = !same(next, wanted.haptics);
    haptics_->setProblem({});
  } catch (const std::exception& error) {
    haptics_edited_ = false;
    haptics_->setProblem(QString::fromStdString(error.what()));
    return;
  }
  feel_.publish(current_->snapshot);
  view_->view().setTipRadius(current_->scene.haptics.tip_radius.value_or(0));
  showBand();
  status_->showScene(current_.get());
}

void MainWindow::showBand() {
  const auto band = touchBand(current_->scene.haptics);
  view_->view().setBand(band);
  display_->setBand(band.has_value());
}

void MainWindow::collect() {
  const std::vector<ToolSample> samples = feel_.drain();
  recording_.add(samples, feel_.dropped());
  log_.add(samples, feel_.dropped());
  if (samples.empty()) return;
  last_sample_ = samples.back();
  force_plot_->addSamples(samples);
  energy_plot_->addSamples(samples, feel_.dropped());
}

void MainWindow::closeFeel() {
  feel_.close();
  collect();
}

void MainWindow::tick() {
  if (haptics_edited_) applyHaptics();
  collect();
  if (feel_.running()) view_->view().setTool(last_sample_);
  view_->refresh();
  force_plot_->refresh();
  energy_plot_->refresh();
  if (ticks_++ % 10 == 0) {
    status_->showTiming(feel_.timing(), feel_.running());
    status_->showFault(feel_.running() && last_sample_.fault);
  }
}

void MainWindow::setMode(SceneWidget::Mode mode) {
  view_->setMode(mode);
  feel_action_->setChecked(mode == SceneWidget::Mode::feel);
  navigate_action_->setChecked(mode == SceneWidget::Mode::navigate);
}

void MainWindow::startRecording() {
  collect();
  recording_.start(feel_.dropped());
}

std::vector<ToolSample> MainWindow::takeRecording() {
  collect();
  std::vector<ToolSample> samples = recording_.samples();
  recording_.clear();
  return samples;
}

void MainWindow::startLog() {
  collect();
  log_.start(feel_.dropped());
}

Recording& MainWindow::log() {
  collect();
  return log_;
}

void MainWindow::saveWorkspaceTo(const QString& folder) {
  if (current_ == nullptr) throw Error("there is no scene to save");
  Scene scene = current_->scene;
  scene.haptics = haptics_->values(); // where the servo may still be on its way to
  saveWorkspace(scene, folder.toStdString());
  setWindowModified(false);
  recent_->add(folder);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().front().isLocalFile())
    event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  LoadRequest request;
  request.path = event->mimeData()->urls().front().toLocalFile().toStdString();
  // A question must not hold up the program that the file is dragged from.
  QMetaObject::invokeMethod(
      this, [this, request] { openAsked(request); }, Qt::QueuedConnection);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (asks_ && !closing_ && !(settleRecording() && settleEdits())) return event->ignore();
  closing_ = true;
  timer_.stop();
  loader_->cancel();
  closeFeel();
  if (!loader_->resting()) {
    // A reader cannot be stopped within a file: the window says so and goes when it is done.
    load_bar_->showClosing();
    connect(loader_, &SceneLoader::rested, this, &QWidget::close, Qt::UniqueConnection);
    return event->ignore();
  }
  event->accept();
}

} // namespace patina
