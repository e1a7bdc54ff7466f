#include "app/gui/window/main_window.h"

#include <utility>

#include <QCloseEvent>
#include <QScreen>

#include "app/gui/control/opening_desk.h"
#include "app/gui/control/touching.h"
#include "app/gui/loading/load_dialogs.h"
#include "app/gui/widgets/words.h"
#include "app/gui/window/window_menus.h"
#ifdef PATINA_HAS_ACQUISITION
#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#endif

namespace patina {
namespace {
constexpr int kNarrow = 1100; // without room for the column
// Of what a window manager draws about a window, which it says only of one that is seen.
constexpr QSize kManagersFrame{12, 44};

#ifdef PATINA_HAS_ACQUISITION
GuideFacts guideFacts(const WindowParts& parts, const CompiledScene* scene, double felt) {
  GuideFacts facts;
  facts.force = felt;
  if (const ScanFiles* files = parts.scan->scan().files()) facts.frames = files->frames.size();
  if (const ScanPath* path = parts.scan->scan().path()) facts.poses = path->poses.size();
  const Alignment& aligned = parts.align->alignment();
  facts.samples = aligned.path().size();
  if (const auto& found = parts.align->alignment().found()) {
    facts.off = found->rms;
    facts.doubt = doubtWords(*found);
  }
  if (scene != nullptr)
    for (const SceneObject& object : scene->scene.objects)
      if (object.paint && object.paint->textures)
        facts.faces += object.paint->textures->faces.size();
  return facts;
}
#endif

std::function<bool(const std::filesystem::path&)> opensScans(const WindowParts& parts) {
#ifdef PATINA_HAS_ACQUISITION
  return [scan = parts.scan](const std::filesystem::path& path) {
    if (!isScanFolder(path)) return false;
    scan->open(path);
    return true;
  };
#else
  static_cast<void>(parts);
  return {};
#endif
}
} // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), parts_(layOut(*this)),
      feel_({*this, *parts_.force, *parts_.energy}, this),
      view_({*parts_.view, *parts_.display, *parts_.paint, *parts_.mesh}, this),
      edits_(
          {*parts_.haptics, *parts_.device, *parts_.objects, *parts_.relief, *parts_.history},
          [this](const CompiledScene& compiled) { feel_.servo().publish(compiled.snapshot); },
          this),
      paint_({*parts_.tools, *parts_.brush, *parts_.tool, *parts_.view, feel_.servo(),
              edits_.thread()},
             this),
      saving_(*this, edits_, this),
      documents_({*this, *parts_.recent, edits_, saving_, opensScans(parts_)}, this),
      recovery_(*parts_.recover, this),
      desks_({*parts_.tools, *parts_.across, *parts_.down, *parts_.column, *parts_.drawer}, this) {
  addMenus(*this, parts_, controllers());
  connectFiles();
  connectWelcome();
  connectScene();
  connectTools();
#ifdef PATINA_HAS_ACQUISITION
  connectScan();
#endif
  refresh();
  // One timer draws everything; what did not change is not drawn again.
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &MainWindow::tick);
  timer_.start(33);
}

void MainWindow::connectFiles() {
  new OpeningDesk(
      documents_, desks_, [this] { return isSeen(state()); }, this);
  connect(&documents_, &DocumentController::changed, this, &MainWindow::refresh);
  connect(&documents_, &DocumentController::previewed, this, &MainWindow::showPreview);
  connect(&documents_, &DocumentController::abandoned, this, &MainWindow::showAgain);
  connect(&documents_, &DocumentController::openAlready, this, &MainWindow::sceneReady);
  connect(&documents_, &DocumentController::said, this, &MainWindow::say);
  connect(&saving_, &SaveController::said, this, &MainWindow::say);
  connect(&recovery_, &RecoveryOffer::changed, this, &MainWindow::refresh);
  connect(&recovery_, &RecoveryOffer::taken, &documents_, [this](const auto& place) {
    LoadRequest request;
    request.place = place;
    documents_.openAsked(request);
  });
  connect(&feel_, &FeelController::said, this, &MainWindow::say);
  connect(&view_, &ViewController::said, this, &MainWindow::say);
  connect(parts_.notice, &NoticeLine::opened, &desks_, [this] { desks_.open(Panel::messages); });
  connect(parts_.load_bar, &LoadBar::cancelled, &documents_, &DocumentController::cancel);
  connect(parts_.objects, &ObjectList::addAsked, &documents_,
          [this] { documents_.openDialog(true); });
}

void MainWindow::connectWelcome() {
  WelcomePage* page = parts_.welcome;
  page->setRecent(documents_.recent());
  connect(page, &WelcomePage::openAsked, &documents_, [this] { documents_.openDialog(false); });
  connect(page, &WelcomePage::recentChosen, &documents_, &DocumentController::openFile);
  connect(page, &WelcomePage::presetChosen, &documents_, [this](const QString& name) {
    LoadRequest request;
    request.preset = name.toStdString();
    documents_.openAsked(request);
  });
  connect(page, &WelcomePage::guideAsked, &desks_, [this] {
    parts_.guide->setOpen(true);
    desks_.choose(Desk::scan);
  });
  connect(&documents_, &DocumentController::changed, page,
          [this, page] { page->setRecent(documents_.recent()); });
}

void MainWindow::connectScene() {
  connect(&edits_, &EditController::sceneChanged, this, &MainWindow::showScene);
  connect(&edits_, &EditController::changed, this, &MainWindow::refresh);
  connect(&edits_, &EditController::refused, this, [this](const QString& problem) {
    showProblem(this, tr("That cannot be done"), problem, tr("The scene is as it was before."));
  });
  connect(&feel_, &FeelController::changed, this, &MainWindow::refresh);
  connect(&feel_, &FeelController::collected, &paint_, &PaintController::feed);
  connect(&feel_, &FeelController::failed, parts_.haptics, &HapticsPanel::setProblem);
  connect(&feel_.stability(), &StabilityJob::said, parts_.display, &DisplayPanel::setStabilityNote);
  connect(&feel_.stability(), &StabilityJob::done, &view_, &ViewController::showStability);
}

void MainWindow::connectTools() {
  connect(&desks_, &DeskController::changed, this, &MainWindow::refresh);
  connect(&paint_, &PaintController::chosen, this, [this](const ToolChoice& choice) {
    parts_.paint->setTool(choice);
    parts_.tool->setTool(choice);
    edits_.setTool(choice);
    refresh();
  });
  connect(&paint_, &PaintController::underPointer, parts_.status, &StatusLine::showPicked);
  connect(parts_.view, &SceneWidget::tipMoved, &feel_,
          [this](const Vec3& target) { feel_.servo().setTarget(target); });
  connect(parts_.view, &SceneWidget::placeAsked, &feel_, [this](const Vec3& surface) {
    const Vec3 tip = touching(*edits_.scene(), surface);
    parts_.view->setTarget(tip);
    feel_.place(edits_.scene()->scene, tip);
  });
  connect(parts_.display, &DisplayPanel::layerToggled, this, [this](Layer layer) {
    if (layer == Layer::stability) askStability();
  });
}

WindowState MainWindow::state() const {
  WindowState state;
  state.content = view_.content();
  state.open = edits_.scene() != nullptr;
  state.desk = desks_.desk();
  state.tab = desks_.tab();
  state.page = desks_.page();
  state.tool = parts_.tools->choice();
  state.relief = edits_.hasRelief();
  state.paint = view_.hasPaint();
  state.undoable = edits_.status().done;
  state.redoable = edits_.status().edits.size() - edits_.status().done;
  state.unsaved = edits_.unsaved();
  state.in_folder = edits_.status().folder.has_value();
  state.recording = feel_.recording();
  state.name = state.content == Content::preview ? documents_.nameUnderWay() : saving_.name();
  state.work = documents_.work() ? documents_.work() : edits_.work();
  state.left_behind = recovery_.present();
#ifdef PATINA_HAS_ACQUISITION
  state.scan = parts_.scan->isOpen();
  if (state.name.isEmpty()) state.name = parts_.scan->scan().name();
  if (!state.work) state.work = parts_.scan->work();
  state.sequence = parts_.texture->hasBegun();
  state.texture = parts_.texture->hasTexture();
  state.chosen_texture = parts_.texture->hasChosenTexture();
  if (!state.work) state.work = parts_.texture->work();
  if (!state.work) state.work = parts_.texture->library().work();
  if (!state.work) state.work = parts_.align->work();
  const Alignment& aligned = parts_.align->alignment();
  state.path = aligned.isReady();
  state.guide = guideFacts(parts_, edits_.scene().get(), felt_);
  if (state.desk == Desk::align) {
    state.undoable = aligned.done();
    state.redoable = aligned.undone();
  }
#endif
  return state;
}

void MainWindow::refresh() {
  showState(state(), parts_, *this);
}

void MainWindow::say(const Message& message) {
  parts_.messages->add(message);
  if (!parts_.messages->isVisible()) parts_.notice->show(message); // or it would be there twice
}

void MainWindow::tick() {
  edits_.tryValues();
  feel_.collect();
  // Qt draws a label no sooner after another picture than a screen can show it: this picture waits.
  if (parts_.status->showHeldBack(feel_.heldBack())) return;
  paint_.refresh();
  if (feel_.servo().running()) view_.view().setTool(feel_.sample());
  if (feel_.servo().running()) felt_ = std::max(felt_, feel_.sample().force.norm());
  view_.refresh();
  feel_.look(); // what has come while the picture was drawn does not wait for the next tick
  parts_.status->showHeldBack(feel_.heldBack());
  parts_.force->refresh();
  parts_.energy->refresh();
  parts_.status->showFault(feel_.servo().running() && feel_.sample().fault);
  if (ticks_++ % 10 != 0) return;
  const int recorded = static_cast<int>(feel_.recordedSeconds());
  parts_.commands.at(Command::record)
      ->setIconText(feel_.recording() ? tr("● Recording %1:%2")
                                            .arg(recorded / 60)
                                            .arg(recorded % 60, 2, 10, QLatin1Char('0'))
                                      : QString());
  if (!std::exchange(stages_shown_, true)) parts_.status->showScene(edits_.scene().get());
  parts_.status->showTiming(feel_.servo().timing(), feel_.servo().running());
}

void MainWindow::clear() {
  feel_.close();
  paint_.setScene(nullptr, false);
  parts_.status->showScene(nullptr);
}

void MainWindow::showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name) {
  clear();
  view_.showPreview(std::move(mesh), name);
  refresh();
  view_.refresh();
}

void MainWindow::showAgain() {
  if (edits_.scene() == nullptr) {
    clear();
    view_.clear();
  } else if (view_.content() == Content::preview) {
    edits_.showAgain();
  }
  refresh();
}

void MainWindow::showScene(const SceneChange& change) {
  const bool edited = change.step == SceneChange::Step::edited;
  if (edited && view_.content() == Content::preview) return; // seen if the preview comes to nothing
  view_.showScene(change);
#ifdef PATINA_HAS_ACQUISITION
  parts_.scan->cells()->setSceneMesh(change.scene->mesh);
  const std::shared_ptr<const Scene> scene(change.scene, &change.scene->scene);
  parts_.scan->setScene(scene);
  parts_.align->files().setScene(scene);
  parts_.texture->library().setScene(change.scene);
  if (change.step == SceneChange::Step::another)
    parts_.align->setSceneMesh(change.scene->mesh);
  else if (change.surface)
    parts_.align->changeSceneMesh(change.scene->mesh);
#endif
  if (change.surface) felt_ = 0;
  if (change.device) {
    const Vec3 start = edited ? feel_.sample().tip : parts_.view->restingPlace();
    parts_.view->setTarget(start);
    feel_.open(change.scene->scene, start);
  }
  paint_.setScene(change.scene, change.step == SceneChange::Step::another);
  if (change.values) {
    parts_.status->showScene(change.scene.get());
    askStability();
  } else {
    stages_shown_ = false;
  }
  refresh();
  if (change.surface && change.step != SceneChange::Step::again) emit sceneReady();
}

void MainWindow::askStability() {
  const bool wanted = view_.content() == Content::scene && parts_.display->shown(Layer::stability);
  view_.showStability(nullptr); // of what was
  feel_.stability().request(wanted ? edits_.scene() : nullptr);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (documents_.asks() && !closing_ && !(feel_.settleRecording() && saving_.settleEdits()))
    return event->ignore();
  closing_ = true;
  timer_.stop();
  desks_.remember(*this);
  parts_.relief->cancel();
  feel_.close();
  if (documents_.close()) return event->accept();
  connect(&documents_, &DocumentController::rested, this, &QWidget::close, Qt::UniqueConnection);
  event->ignore();
}

void MainWindow::restorePlace() {
  const WindowPlace place = rememberedPlace();
  resize(place.size.boundedTo(screen()->availableSize() - kManagersFrame));
  if (place.maximized) setWindowState(Qt::WindowMaximized);
  desks_.restore();
  comeInSight();
}

void MainWindow::comeInSight() {
  if (!isSeen(state())) desks_.choose(Desk::feel);
}

void MainWindow::resizeEvent(QResizeEvent* event) {
  QMainWindow::resizeEvent(event);
  desks_.setNarrow(width() < kNarrow);
}

void MainWindow::showEvent(QShowEvent* event) {
  QMainWindow::showEvent(event);
  desks_.arrange();
}

} // namespace patina
