#include "app/gui/main_window.h"

#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QMimeData>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/gui/load_dialogs.h"
#include "app/gui/value_focus.h"
#include "app/gui/window_style.h"
#include "core/error.h"
#include "workspace/workspace.h"

namespace patina {

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), view_(new SceneWidget), load_bar_(new LoadBar), warnings_(new QLabel),
      objects_(new ObjectList), object_(new ObjectPanel), haptics_(new HapticsPanel),
      device_(new DevicePanel), display_(new DisplayPanel), force_plot_(new ForcePlot),
      energy_plot_(new EnergyPlot), status_(new StatusLine(statusBar())),
      loader_(new SceneLoader(this)), stability_(new StabilityJob(this)) {
  setWindowTitle(tr("Patina[*]"));
  setAcceptDrops(true);
  buildLayout();
  buildMenus();
  connectLoader();
  connectPanels();
  connect(view_, &SceneWidget::tipMoved, this,
          [this](const Vec3& target) { feel_.setTarget(target); });
  connect(load_bar_, &LoadBar::cancelled, loader_, &SceneLoader::cancel);
  restore();
  // One timer draws everything; what did not change is not drawn again.
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &MainWindow::tick);
  timer_.start(33);
}

QList<QWidget*> MainWindow::cards() const {
  return {haptics_, display_, device_, objects_, object_};
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

  auto* side = new QWidget;
  side->setStyleSheet(cardStyle());
  auto* stack = new QVBoxLayout(side);
  stack->setContentsMargins(8, 0, 8, 8);
  stack->setSpacing(4);
  for (QWidget* card : cards()) stack->addWidget(card);
  stack->addStretch(1);
  new ValueFocus(*side, *view_);
  auto* scroll = new QScrollArea;
  scroll->setWidget(side);
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
  if (values_edited_) applyValues();
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
  scene.haptics = haptics_->values(); // what this tick's timer has not applied yet
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
  stability_->cancel();
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
