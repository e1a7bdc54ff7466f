#include "app/gui/scanning/scan_desk.h"

#include <QFileDialog>
#include <QPushButton>
#include <QShortcut>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/scanning/found_files.h"
#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

// What a scan has that follows from `file` and that is found anew without it. Poses follow from the
// camera where markers were tracked; a tip is no part of them.
std::vector<std::string> foundAnew(const SceneScan& scan, const std::string& file, bool tracks) {
  std::vector<std::string> later;
  const bool camera = file == "camera.yml";
  if (camera && !tracks) return later;
  bool follows = false;
  for (const auto& [name, step] : kScanFiles) {
    follows = follows || name == (camera ? "poses.tum" : "path.csv");
    if (follows && scan.text(std::string(name))) later.emplace_back(name);
  }
  return later;
}

} // namespace

ScanDesk::ScanDesk(QWidget& window)
    : QObject(&window), window_(window), scan_(this), frame_(new FrameView(scan_)),
      panel_(new ScanPanel(scan_)), calibration_(new CalibrationCard(scan_)), recording_(this),
      findings_(new FindingList(scan_)) {
  makeEmpty();
  makeTimeline();
  across_->addWidget(frame_);
  across_->setChildrenCollapsible(false);
  across_->setHandleWidth(4);
  across_->setObjectName(QStringLiteral("scan_cells"));
  cells_->addWidget(across_);
  connectScan();
  connectScans();
  connectCalibration();
  connectRecording();
  for (QWidget* keys : {static_cast<QWidget*>(cells_), timeline_})
    for (const auto& [key, frames] : {std::pair(Qt::Key_Left, -1),
                                      {Qt::Key_Right, 1},
                                      {Qt::Key_PageUp, -10},
                                      {Qt::Key_PageDown, 10},
                                      {Qt::Key_Home, -1'000'000'000},
                                      {Qt::Key_End, 1'000'000'000}}) {
      auto* shortcut = new QShortcut(key, keys);
      shortcut->setContext(Qt::WidgetWithChildrenShortcut);
      connect(shortcut, &QShortcut::activated, &scan_,
              [this, n = frames] { scan_.cursor().step(n); });
    }
}

void ScanDesk::makeEmpty() {
  auto* empty = new QWidget;
  auto* column = new QVBoxLayout(empty);
  auto* words = new QLabel(tr("No scan is open. A scan is a folder with a camera's frames and a "
                              "probe's stream, or with poses of another program."));
  words->setWordWrap(true);
  words->setAlignment(Qt::AlignCenter);
  auto* open = new QPushButton(tr("Open scan…"));
  open->setObjectName(QStringLiteral("open_first_scan"));
  open->setToolTip(
      tr("A folder of frames, poses, a probe's stream or a path; one can be dropped on "
         "the window, too"));
  connect(open, &QPushButton::clicked, this, &ScanDesk::openDialog);
  column->addStretch(1);
  column->addWidget(words);
  column->addWidget(open, 0, Qt::AlignCenter);
  column->addStretch(1);
  cells_->addWidget(empty);
}

void ScanDesk::makeTimeline() {
  auto* column = new QVBoxLayout(timeline_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addWidget(new FrameStrip(scan_));
  column->addWidget(new ScanTraces(scan_), 1);
}

void ScanDesk::connectScan() {
  connect(&scan_, &OpenScan::opened, this, &ScanDesk::takeScan);
  connect(&scan_, &OpenScan::pathMade, this, [this] {
    drawPath();
    drawProbe();
    const ScanPath* path = scan_.path();
    if (path != nullptr && !scan_.grows() && !path->path.empty())
      emit pathMade(scan_.name(), path->path);
    emit changed();
  });
  connect(&scan_.cursor(), &ScanCursor::moved, this, &ScanDesk::drawProbe);
  connect(&scan_, &OpenScan::progressed, this, [this](double fraction, const QString& what) {
    if (!work_) return;
    work_->words = tr("Scan: %1").arg(what);
    work_->fraction = fraction;
    emit changed();
  });
  connect(&scan_, &OpenScan::finished, this, [this] {
    work_.reset();
    emit changed();
  });
  connect(&scan_, &OpenScan::failed, this, [this](const QString& message) {
    showProblem(&window_, tr("The scan cannot be read"), message,
                tr("What was open before is as it was."));
  });
  connect(panel_, &ScanPanel::openAsked, this, &ScanDesk::openDialog);
  connect(panel_, &ScanPanel::closeAsked, &scan_, &OpenScan::close);
  connect(panel_, &ScanPanel::keepAsked, this, [this] {
    try {
      keepFound(scan_);
      emit said({tr("Poses and path are in %1").arg(scan_.name())});
      open(scan_.files()->folder);
    } catch (const Error& error) {
      showProblem(&window_, tr("Poses and path cannot be kept"),
                  QString::fromStdString(error.what()), tr("Make room, or the folder writable."));
    }
  });
  connect(panel_, &ScanPanel::shownChanged, this, [this] {
    drawPath();
    drawMesh();
  });
}

void ScanDesk::connectScans() {
  panel_->layout()->addWidget(scans_);
  connect(scans_, &SceneScans::putAsked, this, [this] {
    if (isOpen()) scans_->put(foundSteps(scan_));
  });
  connect(scans_, &SceneScans::openAsked, this, qOverload<const SceneScan&>(&ScanDesk::open));
  connect(scans_, &SceneScans::said, this, &ScanDesk::said);
  connect(scans_, &SceneScans::failed, this, [this](const QString& problem) {
    showProblem(&window_, tr("The workspace's scans stay as they are"), problem,
                tr("Nothing has changed."));
  });
}

void ScanDesk::connectCalibration() {
  connect(calibration_, &CalibrationCard::picturesAsked, this, &ScanDesk::openPictures);
  connect(calibration_, &CalibrationCard::boardSeen, frame_, &FrameView::addBoard);
  connect(calibration_, &CalibrationCard::useAsked, this, &ScanDesk::use);
  connect(calibration_, &CalibrationCard::progressed, this, [this](double fraction) {
    if (work_) work_->fraction = fraction;
    emit changed();
  });
  connect(calibration_, &CalibrationCard::changed, this, [this] {
    const QString words = tr("Calibrating");
    if (calibration_->busy())
      work_ = Work{words, words};
    else if (work_ && work_->title == words)
      work_.reset();
    emit changed();
  });
}

void ScanDesk::openPictures() {
  auto* dialog = new QFileDialog(&window_, tr("Open pictures of a board"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& folder) { scan_.openPictures(folder.toStdString()); });
  dialog->open();
}

void ScanDesk::use(const QString& file, const QString& text) {
  const ScanFiles& files = *scan_.files();
  const auto calibrated = [name = file.toStdString(),
                           given = std::make_shared<const std::string>(text.toStdString()),
                           tracks = !files.markers.empty()](SceneScan scan) {
    for (const std::string& later : foundAnew(scan, name, tracks)) scan.files.erase(later);
    scan.files[name] = given;
    return scan;
  };
  SceneScan scan = files.scan;
  const SceneScan* known = scans_->scene() ? findScan(*scans_->scene(), scan.name) : nullptr;
  if (known != nullptr && (files.of_scene || known->folder == scan.folder)) {
    scan = *known;
    scans_->change(scan.name, [calibrated, scan](const SceneScan* now) {
      return calibrated(now ? *now : scan);
    });
    if (!files.of_scene) open(calibrated(scan));
    return emit said({tr("%1 of scan %2 is in the workspace").arg(file, scan_.name())});
  }
  const std::filesystem::path folder = files.folder;
  QString words = tr("%1 is in %2").arg(file, QString::fromStdString(folder.string()));
  try {
    if (folder.empty()) throw Error("the scan is not in the workspace any more, and has no folder");
    writeFileAtomically(folder / file.toStdString(), text.toStdString());
    for (const std::string& later : foundAnew(scan, file.toStdString(), !files.markers.empty())) {
      if (!std::filesystem::exists(folder / later)) continue; // the workspace's alone
      std::filesystem::rename(folder / later, folder / (later + "~"));
      words += tr(", %1 is %1~ now").arg(QString::fromStdString(later));
    }
  } catch (const std::exception& error) {
    return showProblem(&window_, tr("The calibration cannot be kept"),
                       QString::fromStdString(error.what()),
                       tr("Make room, or the folder writable."));
  }
  emit said({words});
  files.pictures ? scan_.openPictures(folder) : open(folder);
}

void ScanDesk::connectRecording() {
  connect(recorder_, &RecordPanel::recordAsked, this,
          [this] { recording_.begin(recorder_->choice()); });
  connect(recorder_, &RecordPanel::pauseAsked, &recording_, &ScanRecording::pause);
  connect(recorder_, &RecordPanel::stopAsked, &recording_, &ScanRecording::end);
  connect(&recording_, &ScanRecording::begun, this,
          [this](const ScanFiles& files) { scan_.begin(files); });
  connect(&recording_, &ScanRecording::came, this, [this](const RecordingNews& news) {
    recorder_->setState(&news.state);
    if (!scan_.grows()) return; // another scan is looked at meanwhile
    if (news.frame) frame_->showLive(*news.frame);
    if (!news.poses.empty() || !news.samples.empty()) scan_.grow(news.poses, news.samples);
  });
  connect(&recording_, &ScanRecording::ended, this,
          [this](const QString& folder, const QString& problem) {
            recorder_->setState(nullptr);
            emit openAsked(folder);
            if (!problem.isEmpty())
              showProblem(&window_, tr("The recording has ended"), problem,
                          tr("What came before it is in %1.").arg(folder));
          });
  connect(&recording_, &ScanRecording::failed, this, [this](const QString& message) {
    showProblem(&window_, tr("Nothing can be recorded"), message,
                tr("Nothing was written. The tooltips say what each line takes."));
  });
}

void ScanDesk::open(const std::filesystem::path& folder) {
  const QString words = tr("Opening %1").arg(QString::fromStdString(folder.filename().string()));
  work_ = Work{words, words};
  scan_.open(folder);
  emit changed();
}

void ScanDesk::open(const SceneScan& scan) {
  const QString words = tr("Opening %1").arg(QString::fromStdString(scan.name));
  work_ = Work{words, words};
  scan_.open(scan);
  emit changed();
}

void ScanDesk::openDialog() {
  auto* dialog = new QFileDialog(&window_, tr("Open a scan folder"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this, &ScanDesk::openAsked);
  dialog->open();
}

void ScanDesk::cancel() {
  scan_.cancel();
  calibration_->cancel();
}

void ScanDesk::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh == scene_mesh_) return;
  scene_mesh_ = std::move(mesh);
  drawMesh();
}

// What is shown of the scene's follows it, through undo too; one that is taken out stays shown.
void ScanDesk::setScene(std::shared_ptr<const Scene> scene) {
  scans_->setScene(scene);
  if (!isOpen() || !scan_.files()->of_scene || !scene) return;
  const SceneScan* now = findScan(*scene, scan_.files()->scan.name);
  if (now != nullptr && !(*now == scan_.files()->scan)) open(*now);
}

void ScanDesk::takeScan() {
  scans_->setOpen(isOpen() && !scan_.files()->scan.files.empty());
  if (isOpen() && !scan_.files()->problem.empty())
    emit said({QString::fromStdString(scan_.files()->problem), true});
  if (view_ == nullptr && isOpen()) {
    view_ = new ScanView;
    view_->setToolTip(tr("The tip's path; a click on it goes there"));
    across_->addWidget(view_);
    across_->setSizes({2000, 3000});
    connect(view_, &ScanView::timePicked, &scan_.cursor(), &ScanCursor::set);
  }
  cells_->setCurrentIndex(isOpen() ? 1 : 0);
  looked_at_ = false;
  drawMesh();
  drawPath();
  drawProbe();
  emit changed();
  if (isOpen() && !scan_.files()->folder.empty() && !scan_.files()->of_scene &&
      scan_.files()->camera && !scan_.files()->markers.empty())
    recorder_->suggestCalibration(QString::fromStdString(scan_.files()->folder.string()));
  if (isOpen()) emit opened();
}

void ScanDesk::drawMesh() {
  if (view_ == nullptr || !isOpen()) return;
  const ScanFiles& files = *scan_.files();
  std::shared_ptr<const TriangleMesh> mesh;
  if (files.mesh_from_camera) mesh = files.mesh ? files.mesh : scene_mesh_;
  panel_->setHasMesh(mesh != nullptr);
  view_->picture().setMesh(panel_->showsMesh() ? mesh : nullptr);
  view_->picture().setCamera(panel_->showsCamera() ? std::optional(drawnCamera(files))
                                                   : std::nullopt);
}

void ScanDesk::drawPath() {
  if (view_ == nullptr || !isOpen()) return;
  const ScanFiles& files = *scan_.files();
  const ScanPath* path = scan_.path();
  view_->picture().setPath(path ? drawnPath(files, *path, panel_->color()) : DrawnPath());
  view_->picture().setMarks(path ? drawnMarks(files, *path) : std::vector<DrawnMark>());
  if (looked_at_ || !(path || files.mesh)) return;
  looked_at_ = path != nullptr && (!scan_.grows() || path->path.size() > 60);
  view_->lookAtAll(upOf(files));
}

void ScanDesk::drawProbe() {
  if (view_ == nullptr || !isOpen()) return;
  const auto probe = scan_.cursor().probe();
  view_->picture().setProbe(
      probe ? std::optional(
                  DrawnProbe{pictureFromCamera(*scan_.files()) * *probe, scan_.files()->tip()})
            : std::nullopt);
}

void ScanDesk::fit() {
  if (view_ != nullptr && view_->isVisible()) view_->picture().fit();
}

void ScanDesk::setView(ViewPreset view) {
  if (view_ != nullptr && view_->isVisible()) view_->picture().setView(view);
}

void ScanDesk::refresh() {
  recording_.refresh();
  if (view_ != nullptr) view_->refresh();
}

} // namespace patina
