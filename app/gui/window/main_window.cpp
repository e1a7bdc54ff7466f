#include "app/gui/window/main_window.h"

#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QMimeData>
#include <QScrollArea>
#include <QVBoxLayout>

#include <utility>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/window/value_focus.h"
#include "app/gui/window/window_style.h"

namespace patina {

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), view_(new SceneWidget), load_bar_(new LoadBar), warnings_(new QLabel),
      objects_(new ObjectList), object_(new ObjectPanel), haptics_(new HapticsPanel),
      device_(new DevicePanel), display_(new DisplayPanel), paint_display_(new PaintDisplay),
      brush_(new BrushPanel), relief_(new ReliefPanel), history_(new HistoryPanel),
      tools_(new ToolBar), recover_(new RecoverBar), force_plot_(new ForcePlot),
      energy_plot_(new EnergyPlot), status_(new StatusLine(statusBar())),
      stability_(new StabilityJob(this)) {
  edits_ = std::make_unique<EditThread>(
      EditThread::Spec{[this](const CompiledScene& compiled) { feel_.publish(compiled.snapshot); },
                       [this] {
                         QMetaObject::invokeMethod(
                             this, [this] { takeNews(); }, Qt::QueuedConnection);
                       },
                       stateFolder()});
  loader_ = new SceneLoader(edits_->listener(), this);
  desk_ = new PaintController({*tools_, *brush_, *view_, feel_, *edits_}, this);
  setWindowTitle(tr("Patina[*]"));
  setAcceptDrops(true);
  buildLayout();
  buildMenus();
  connectLoader();
  connectPanels();
  connectPaint();
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
  timer_.stop();
  edits_.reset();
  feel_.close();
}

QDockWidget* MainWindow::dock(const QString& title, const char* name, QWidget* widget,
                              Qt::DockWidgetArea area) {
  auto* made = new QDockWidget(title, this);
  made->setObjectName(QString::fromUtf8(name));
  made->setWidget(widget);
  made->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
  addDockWidget(area, made);
  return made;
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
  column->addWidget(recover_);
  column->addWidget(warnings_);
  column->addWidget(view_, 1);
  setCentralWidget(centre);
  addToolBar(Qt::LeftToolBarArea, tools_);

  auto* side = new QWidget;
  side->setStyleSheet(cardStyle());
  auto* stack = new QVBoxLayout(side);
  stack->setContentsMargins(8, 0, 8, 8);
  stack->setSpacing(4);
  stack->addWidget(brush_);
  stack->addWidget(relief_);
  for (QWidget* card : cards()) stack->addWidget(card);
  stack->addStretch(1);
  for (QWidget* absent : {static_cast<QWidget*>(brush_), static_cast<QWidget*>(relief_)})
    absent->hide();
  display_->layout()->addWidget(paint_display_);
  new ValueFocus(*side, *view_);
  auto* scroll = new QScrollArea;
  scroll->setWidget(side);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Room for the scroll bar from the start, or it would cover the cards when it comes.
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  scroll->setFixedWidth(318);
  panels_ << dock(tr("Scene"), "scene_dock", scroll, Qt::RightDockWidgetArea)->toggleViewAction();
  QDockWidget* force =
      dock(tr("Force on the hand"), "force_dock", force_plot_, Qt::BottomDockWidgetArea);
  QDockWidget* energy = dock(tr("Energy taken by the surface"), "energy_dock", energy_plot_,
                             Qt::BottomDockWidgetArea);
  splitDockWidget(force, energy, Qt::Horizontal);
  resizeDocks({force, energy}, {1, 1}, Qt::Horizontal);
  for (QDockWidget* plot : {force, energy}) panels_ << plot->toggleViewAction();
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  history_dock_ = dock(tr("History"), "history_dock", history_, Qt::RightDockWidgetArea);
  history_->setMinimumHeight(60);
  resizeDocks({history_dock_}, {170}, Qt::Vertical);
  history_dock_->hide();
}

void MainWindow::collect() {
  const std::vector<ToolSample> samples = feel_.drain();
  recording_.add(samples, feel_.dropped());
  log_.add(samples, feel_.dropped());
  desk_->feed(samples);
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
  if (values_edited_) tryValues();
  collect();
  desk_->refresh();
  if (feel_.running()) view_->view().setTool(last_sample_);
  view_->refresh();
  if (const auto shown = paint_display_->shown(); shown && *shown != PaintQuantity::color)
    paint_display_->setRange(view_->view().paintRange(*shown));
  force_plot_->refresh();
  energy_plot_->refresh();
  if (ticks_++ % 10 != 0) return;
  if (!std::exchange(stages_shown_, true)) status_->showScene(current_.get());
  status_->showTiming(feel_.timing(), feel_.running());
  status_->showFault(feel_.running() && last_sample_.fault);
}

void MainWindow::setMode(SceneWidget::Mode mode) {
  tools_->choose({mode == SceneWidget::Mode::navigate ? Handling::navigate : Handling::feel, {}});
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

} // namespace patina
