#include "app/gui/window/main_window.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <QCloseEvent>
#include <QScreen>
#include <QStatusTipEvent>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/control/proposal.h"
#include "app/gui/loading/load_dialogs.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/state/contact_offset.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/toolkit/words.h"
#include "app/gui/window/status_line.h"
#include "core/error.h"
#include "core/partial_output.h"
#include "session/store/autosave.h"

namespace patina {

RecoveryOffer::RecoveryOffer(const NoticeBar& bar, QObject* parent) : QObject(parent) {
  connect(bar.button("later"), &QPushButton::clicked, this, &RecoveryOffer::next);
  connect(bar.button("forget"), &QPushButton::clicked, this, [this] {
    try {
      Autosave::adopt(places_.front())->claim(); // The destructor deletes it.
    } catch (const Error&) {                     // Another program has taken it meanwhile.
    }
    next();
  });
  connect(bar.button("recover"), &QPushButton::clicked, this, [this] {
    const std::filesystem::path place = places_.front();
    next();
    emit taken(place);
  });
}

namespace {

// Switches to a desk that shows the scene being opened, and back if loading fails.
class LoadingMode : public QObject {
 public:
  // is_seen: the desk in front shows the scene.
  LoadingMode(DocumentController& documents, DeskController& desks, std::function<bool()> is_seen,
              QObject* parent)
      : QObject(parent), desks_(desks), is_seen_(std::move(is_seen)) {
    connect(&documents, &DocumentController::opening, this, [this] { begin(); });
    connect(&documents, &DocumentController::previewed, this, [this] { showLoading(); });
    for (const auto signal : {&DocumentController::loadFinished, &DocumentController::alreadyOpen})
      connect(&documents, signal, this, [this] {
        showLoading();
        end();
      });
    connect(&documents, &DocumentController::abandoned, this, [this] { restoreMode(); });
  }

 private:
  void begin() {
    // A load that replaces another one restores the desk on which the first one began.
    if (switched_ && desks_.desk() == Desk::feel) return;
    previous_ = desks_.desk();
    switched_ = false;
  }
  void showLoading() {
    // A desk that the user has chosen meanwhile stays.
    if (previous_ != desks_.desk() || is_seen_()) return;
    switched_ = true;
    desks_.choose(Desk::feel);
  }
  void restoreMode() {
    const std::optional<Desk> back =
        switched_ && desks_.desk() == Desk::feel ? previous_ : std::nullopt;
    end();
    if (back) desks_.choose(*back);
  }
  void end() {
    previous_.reset();
    switched_ = false;
  }

  DeskController& desks_;
  std::function<bool()> is_seen_;
  std::optional<Desk> previous_; // Desk at the start; nullopt: nothing is being opened.
  bool switched_ = false;        // Switched to Feel for the new scene.
};

constexpr int kTick = 33, kDragTick = 16; // [ms]
constexpr int kDragEnd = 200;             // Rest after which the tool is no longer dragged [ms].
constexpr int kNarrow = 1100;             // Narrower windows have no room for the side panel [px].
// Window managers report their frame only for visible windows.
constexpr QSize kManagersFrame{12, 44};

GuideFacts guideFacts(const WindowParts& parts, const CompiledScene* scene, double felt) {
  GuideFacts facts;
  facts.force = felt;
  if (const ScanFiles* files = parts.scan->scan().files()) facts.frames = files->frames.size();
  if (const ScanPath* path = parts.scan->scan().path()) facts.poses = path->poses.size();
  const Alignment& aligned = parts.align->alignment();
  facts.samples = aligned.path().size();
  if (const auto& found = parts.align->alignment().found()) {
    facts.off = found->rms;
    facts.doubt = warningText(*found);
  }
  if (scene != nullptr)
    for (const SceneObject& object : scene->scene.objects)
      if (object.paint && object.paint->textures)
        facts.faces += object.paint->textures->faces.size();
  return facts;
}

std::function<bool(const std::filesystem::path&)> opensScans(const WindowParts& parts) {
  return [scan = parts.scan](const std::filesystem::path& path) {
    if (!isScanFolder(path)) return false;
    scan->open(path);
    return true;
  };
}
} // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), parts_(layOut(*this)),
      feel_({*this, *parts_.force, *parts_.energy}, this),
      view_({*parts_.view, *parts_.display, *parts_.paint, *parts_.colors, *parts_.mesh}, this),
      edits_(
          {*parts_.haptics, *parts_.device, *parts_.objects, *parts_.relief, *parts_.history},
          [this](const CompiledScene& compiled) { feel_.servo().publish(compiled.snapshot); },
          [this](std::vector<ToolSample>& into) { feel_.servo().takePaintSamples(into); }, this),
      paint_({*parts_.tools, *parts_.brush, *parts_.tool, *parts_.view, feel_.servo(),
              edits_.thread()},
             this),
      probe_(*parts_.view, this), measure_({*parts_.view, *parts_.measure, edits_.thread()}, this),
      saving_(*this, edits_, this),
      documents_({*this, *parts_.recent, edits_, saving_, opensScans(parts_)}, this),
      recovery_(*parts_.recover, this), desks_({*parts_.tools, *parts_.across, *parts_.down,
                                                *parts_.side_panel, *parts_.bottom_panel},
                                               this) {
  addMenus();
  connectFiles();
  connectWelcome();
  connectScene();
  connectTools();
  connectScan();
  refresh();
  // One timer drives all drawing; unchanged parts are not drawn again.
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &MainWindow::tick);
  timer_.start(kTick);
}

void MainWindow::connectFiles() {
  new LoadingMode(
      documents_, desks_, [this] { return isSeen(state()); }, this);
  connect(&documents_, &DocumentController::changed, this, &MainWindow::refresh);
  connect(&documents_, &DocumentController::loadFinished, this, [this] { ++opened_; });
  connect(&documents_, &DocumentController::previewed, this, &MainWindow::showPreview);
  connect(&documents_, &DocumentController::abandoned, this, &MainWindow::showAgain);
  connect(&documents_, &DocumentController::alreadyOpen, this, &MainWindow::sceneReady);
  connect(&documents_, &DocumentController::notified, this, &MainWindow::say);
  connect(&saving_, &SaveController::notified, this, &MainWindow::say);
  connect(&recovery_, &RecoveryOffer::changed, this, &MainWindow::refresh);
  connect(&recovery_, &RecoveryOffer::taken, &documents_, [this](const auto& place) {
    if (holdsRecording(place)) return feel_.recover(place);
    documents_.openRequested({.place = place});
  });
  connect(parts_.storage->button("save_elsewhere"), &QPushButton::clicked, &saving_,
          &SaveController::saveDialog);
  connect(&feel_, &FeelController::notified, this, &MainWindow::say);
  connect(&view_, &ViewController::editRequested, &edits_, &EditController::changeLooks);
  connect(&edits_, &EditController::looksDone, &view_, &ViewController::editDone);
  connect(&measure_, &MeasureController::notified, this, &MainWindow::say);
  connect(&view_, &ViewController::notified, this, &MainWindow::say);
  connect(parts_.notice, &NoticeLine::opened, &desks_, [this] { desks_.open(Panel::messages); });
  connect(parts_.load_bar, &LoadBar::cancelled, &documents_, &DocumentController::cancel);
  connect(parts_.objects, &ObjectList::pictureRequested, &documents_,
          &DocumentController::layPictureDialog);
  connect(parts_.objects, &ObjectList::unitRequested, &documents_, &DocumentController::unitDialog);
  connect(parts_.objects, &ObjectList::addRequested, &documents_,
          [this] { documents_.openDialog(true); });
}

void MainWindow::connectWelcome() {
  WelcomePage* page = parts_.welcome;
  page->setRecent(documents_.recent());
  connect(page, &WelcomePage::openRequested, &documents_, [this] { documents_.openDialog(false); });
  connect(page, &WelcomePage::recentChosen, &documents_, &DocumentController::openFile);
  connect(page, &WelcomePage::presetChosen, &documents_, [this](const QString& name) {
    documents_.openRequested({.preset = name.toStdString()});
  });
  connect(page, &WelcomePage::guideRequested, &desks_, [this] {
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
    showProblem(this, tr("The edit has failed"), problem, tr("The scene is unchanged."));
  });
  connect(&feel_, &FeelController::changed, this, &MainWindow::refresh);
  connect(&feel_, &FeelController::collected, &paint_, &PaintController::feed);
  connect(&feel_, &FeelController::failed, parts_.haptics, &HapticsPanel::setProblem);
  connect(&feel_.stability(), &StabilityJob::notified, parts_.display,
          &DisplayPanel::setStabilityNote);
  connect(&feel_.stability(), &StabilityJob::done, &view_, &ViewController::showStability);
}

void MainWindow::connectTools() {
  connect(&desks_, &DeskController::changed, this, [this] {
    view_.setAligning(desks_.desk() == Desk::align);
    refresh();
  });
  connect(&paint_, &PaintController::chosen, this, [this](const ToolChoice& choice) {
    parts_.paint->setTool(choice);
    parts_.tool->setTool(choice);
    edits_.setTool(choice);
    measure_.setTool(choice);
    refresh();
  });
  connect(&probe_, &ProbeController::underPointer, parts_.status, &StatusLine::showPicked);
  connect(parts_.view, &SceneWidget::tipMoved, &feel_,
          [this](const Vec3& target) { feel_.servo().setTarget(target); });
  connect(parts_.view, &SceneWidget::tipMoved, this, &MainWindow::hurry);
  connect(parts_.view, &SceneWidget::pointed, this, &MainWindow::hurry);
  connect(parts_.view, &SceneWidget::placeRequested, &feel_, [this](const Vec3& surface) {
    const Vec3 tip = tipAtContact(*edits_.scene(), surface);
    parts_.view->setTarget(tip);
    feel_.place(edits_.scene()->scene, tip);
  });
  connect(parts_.display, &DisplayPanel::shownChanged, this, [this](const std::string& thing) {
    if (thing == name(Layer::stability)) askStability();
  });
  connect(&view_, &ViewController::coloredChanged, this, &MainWindow::refresh);
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
  state.colored = !parts_.colors->thing().empty();
  state.undoable = edits_.undoable();
  state.redoable = edits_.status().edits.size() - edits_.status().done;
  state.unsaved = edits_.unsaved();
  state.in_folder = edits_.status().folder.has_value();
  state.recording = feel_.recording();
  state.name = state.content == Content::preview ? documents_.nameUnderWay() : saving_.name();
  state.work = documents_.work() ? documents_.work() : edits_.work();
  state.recoverable_scenes = recovery_.present();
  state.storage_problem = documents_.storageProblem();
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
  return state;
}

void MainWindow::say(Message message) {
  const auto proposal = message.warns ? proposalOf(message.words) : std::nullopt;
  if (proposal && message.action.words.isEmpty())
    message.action = {proposal->words, [this, change = proposal->change, opened = opened_] {
                        if (opened == opened_) return edits_.changeValues(change);
                        say({tr("That message was about another scene: nothing is changed")});
                      }};
  message.words = withoutCommands(message.words);
  parts_.messages->add(message);
  if (!parts_.messages->isVisible()) parts_.notice->show(message);
}

// Other widgets and the servo get the processor while nothing is dragged.
void MainWindow::hurry() {
  dragged_.start();
  if (timer_.interval() != kDragTick) timer_.setInterval(kDragTick);
}

void MainWindow::showTool() {
  const ToolSample& sample = feel_.sample();
  felt_ = std::max(felt_, sample.force.norm());
  // Other tools place the tip themselves.
  const bool is_free =
      feel_.hasOwnHand() || parts_.tools->choice().handling == InteractionMode::feel;
  view_.view().setTool(sample, is_free && parts_.display->isShown("tip") ? gap_.nearestTo(sample)
                                                                         : std::nullopt);
}

void MainWindow::tick() {
  if (timer_.interval() != kTick && dragged_.hasExpired(kDragEnd)) timer_.setInterval(kTick);
  edits_.previewValues();
  feel_.collect();
  // Qt delays a label's update until the next screen refresh, so the picture is drawn later.
  if (parts_.status->showHeldBack(feel_.inhibitText())) return;
  paint_.refresh();
  probe_.refresh();
  if (feel_.servo().running()) showTool();
  view_.refresh();
  if (desks_.desk() == Desk::align) parts_.colors->setRange(parts_.align->shownRange());
  feel_.checkDevice(); // Events that came during drawing are handled at once.
  parts_.status->showHeldBack(feel_.inhibitText());
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
  probe_.setScene(nullptr);
  gap_.setScene(nullptr);
  measure_.setScene(nullptr, true);
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
  if (edited && view_.content() == Content::preview) return; // Shown only if the preview fails.
  view_.showScene(change);
  parts_.scan->centralViews()->setSceneMesh(change.scene->mesh);
  const std::shared_ptr<const Scene> scene(change.scene, &change.scene->scene);
  parts_.scan->setScene(scene);
  parts_.align->files().setScene(scene);
  parts_.align->setColors(scaleOf(scene->colors, "error"));
  parts_.texture->library().setScene(change.scene);
  if (change.step == SceneChange::Step::another)
    parts_.align->setSceneMesh(change.scene->mesh);
  else if (change.surface)
    parts_.align->changeSceneMesh(change.scene->mesh);
  if (change.surface) felt_ = 0;
  if (change.device) {
    const Vec3 start = edited ? feel_.sample().tip : parts_.view->restingPlace();
    parts_.view->setTarget(start);
    feel_.open(change.scene->scene, start);
  }
  paint_.setScene(change.scene, change.step == SceneChange::Step::another);
  probe_.setScene(change.scene);
  gap_.setScene(change.scene);
  measure_.setScene(change.scene, change.surface);
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
  const bool wanted = view_.content() == Content::scene && parts_.display->isShown("stability");
  view_.showStability(nullptr); // The old map is invalid.
  feel_.stability().request(wanted ? edits_.scene() : nullptr);
}

// Views send the values under the pointer as status tips.
bool MainWindow::event(QEvent* event) {
  if (event->type() != QEvent::StatusTip) return QMainWindow::event(event);
  parts_.status->showPicked(static_cast<QStatusTipEvent*>(event)->tip());
  return true;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (documents_.isInteractive() && !closing_ &&
      !(feel_.confirmRecording() && saving_.confirmEdits()))
    return event->ignore();
  closing_ = true;
  timer_.stop();
  desks_.remember(*this);
  parts_.relief->cancel();
  feel_.close();
  documents_.close();
  event->accept();
}

bool MainWindow::isReading() const {
  const auto jobs = findChildren<Background*>();
  return std::any_of(jobs.begin(), jobs.end(),
                     [](const Background* job) { return !job->isIdle(); });
}

void MainWindow::finishWithoutReaders() {
  parts_.scan->finishRecording();
  edits_.thread().stop();
  removeUnfinished();
}

void MainWindow::restorePlace() {
  const WindowGeometry place = rememberedPlace();
  resize(place.size.boundedTo(screen()->availableSize() - kManagersFrame));
  if (place.maximized) setWindowState(Qt::WindowMaximized);
  desks_.restore();
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
