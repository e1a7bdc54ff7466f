#include "app/gui/scanning/scan_desk.h"

#include <cmath>

#include <QScrollArea>
#include <QShortcut>
#include <QSignalBlocker>
#include <QTimer>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/scanning/found_files.h"
#include "app/gui/scanning/frame_strip.h"
#include "app/gui/scanning/scan_traces.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "scene/scene_scan.h"

namespace patina {
namespace {

constexpr std::size_t kMinPoses = 10;
constexpr int kLaidOut = 50; // Time until the side panel is laid out again [ms].

QString withDeviation(double value, double deviation, int digits) {
  return QStringLiteral("%1 ± %2").arg(value, 0, 'f', digits).arg(deviation, 0, 'g', 2);
}

QString wordsOf(const CalibratedCamera& found) {
  const auto values = parametersOf(found.fit.camera);
  QString words = CalibrationCard::tr("rms %1 px, the board in %2 of %3")
                      .arg(found.fit.rms, 0, 'f', 3)
                      .arg(found.views)
                      .arg(found.frames);
  for (std::size_t i = 0; i < values.size(); ++i)
    words += QStringLiteral("\n%1 %2%3")
                 .arg(QString::fromUtf8(kCameraParameters[i]),
                      withDeviation(values[i], found.fit.deviation[i], i < 4 ? 2 : 5),
                      i < 4 ? QStringLiteral(" px") : "");
  for (const std::string& line : found.notes) words += "\n" + shownText(line);
  return words;
}

QString wordsOf(const PivotFit& fit, std::size_t poses) {
  QString words = CalibrationCard::tr("rms %1, %2 of %3 poses")
                      .arg(inWords(fit.rms))
                      .arg(poses - fit.rejected)
                      .arg(poses);
  for (int i = 0; i < 3; ++i)
    words += QStringLiteral("\n%1 %2 mm")
                 .arg(QChar('x' + i))
                 .arg(withDeviation(1e3 * fit.tip[i], 1e3 * std::sqrt(fit.covariance(i, i)), 3));
  return words;
}

// Gives a scan a new calibration, in the workspace or in its folder. No Qt.
struct Calibration {
  std::string file; // "camera.yml", "rig.json"
  std::shared_ptr<const std::string> text;
  bool tracks = false; // The scan's poses come from markers.
};

// Returns the files that depend on the calibration. Tracked poses do not depend on the tip.
std::vector<std::string> dependentFiles(const SceneScan& scan, const Calibration& found) {
  std::vector<std::string> names;
  const bool camera = found.file == "camera.yml";
  if (camera && !found.tracks) return names;
  bool follows = false;
  for (const auto& [name, step] : kScanFiles) {
    follows = follows || name == (camera ? "poses.tum" : "path.csv");
    if (follows && scan.text(std::string(name))) names.emplace_back(name);
  }
  return names;
}

// Removes poses and path that depend on the old calibration; the next load computes them.
SceneScan withCalibration(SceneScan scan, const Calibration& found) {
  for (const std::string& name : dependentFiles(scan, found)) scan.files.erase(name);
  scan.files[found.file] = found.text;
  return scan;
}

// Does the same in a folder, where dependent files are renamed to end with ~. Returns their old
// names. Throws with the reason if a file cannot be written.
std::vector<std::string> calibrateFolder(const std::filesystem::path& folder, const SceneScan& scan,
                                         const Calibration& found) {
  if (folder.empty())
    throw Error("the scan is not in the workspace any more and has no folder: open it again");
  writeFileAtomically(folder / found.file, *found.text);
  std::vector<std::string> aside;
  for (const std::string& name : dependentFiles(scan, found)) {
    if (!std::filesystem::exists(folder / name)) continue; // The file is only in the workspace.
    std::filesystem::rename(folder / name, folder / (name + "~"));
    aside.push_back(name);
  }
  return aside;
}

QWidget* timelineOf(OpenScan& scan) {
  auto* timeline = new QWidget;
  auto* column = layoutIn<QVBoxLayout>(timeline, 2);
  column->addWidget(new FrameStrip(scan));
  column->addWidget(new ScanTraces(scan), 1);
  return timeline;
}

} // namespace

CalibrationCard::CalibrationCard(OpenScan& scan, QWidget* parent)
    : QGroupBox(tr("Calibrate"), parent), scan_(scan), job_(this), board_(new QLineEdit(this)),
      source_(new QLineEdit(this)) {
  auto* column = layoutIn<QVBoxLayout>(this);
  named(board_, "calibrate_board",
        tr("chessboard:COLUMNSxROWS:SQUARE, counted in inner corners, or "
           "charuco:COLUMNSxROWS:SQUARE:MARKER:FAMILY, counted in squares"));
  board_->setText(QStringLiteral("chessboard:9x6:25mm"));
  column->addWidget(board_);
  named(source_, "calibrate_source",
        tr("Source of board pictures, instead of the open scan. Sharp frames that differ are "
           "chosen; from a camera, 60 are taken."));
  source_->setPlaceholderText(tr("a video, camera:0 or replay:FOLDER"));
  column->addWidget(source_);
  pictures_ = addButton(column, "calibrate_pictures", tr("Open pictures…"),
                        tr("A folder of pictures of the board, without times"), this,
                        &CalibrationCard::picturesRequested);
  camera_ = addButton(column, "calibrate_camera", tr("Camera from the board"),
                      tr("Finds the board in every frame and calibrates the camera, like `patina "
                         "calibrate --board`"),
                      this, &CalibrationCard::findCamera);
  tip_ =
      addButton(column, "calibrate_tip", tr("Tip from the poses"),
                tr("Finds the point that stood still while the probe was rotated about it (pivot "
                   "calibration), like `patina calibrate`"),
                this, &CalibrationCard::findTip);
  found_ = addNote(column, "calibrate_found", "");
  found_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  use_ = addButton(
      column, "calibrate_use", tr("Use it"),
      tr("Used for the scan. A scan of the workspace is changed there, with undo; otherwise "
         "its folder is changed. Poses and path that depend on it are computed again"),
      this, [this] { emit useRequested(file_, text_); });
  connect(source_, &QLineEdit::textChanged, this, &CalibrationCard::refresh);
  connect(&job_, &Background::progressed, this,
          [this](double fraction, const QString&) { emit progressed(fraction); });
  connect(&scan_, &OpenScan::opened, this, [this] {
    job_.discardResult();
    offer({}, {}, {});
  });
  for (const auto signal : {&OpenScan::pathMade, &OpenScan::finished})
    connect(&scan_, signal, this, &CalibrationCard::refresh);
  refresh();
}

void CalibrationCard::cancel() {
  if (!job_.busy()) return;
  job_.discardResult();
  refresh();
  emit changed();
}

void CalibrationCard::refresh() {
  const bool frames = scan_.files() != nullptr && !scan_.grows() && !scan_.files()->frames.empty();
  const bool poses =
      scan_.path() != nullptr && !scan_.grows() && scan_.path()->poses.size() >= kMinPoses;
  const bool seen = frames || !source_->text().trimmed().isEmpty();
  board_->setVisible(seen);
  camera_->setVisible(seen);
  tip_->setVisible(poses);
  for (QPushButton* each : {pictures_, camera_, tip_}) each->setEnabled(!job_.busy());
  use_->setVisible(!file_.isEmpty());
}

void CalibrationCard::offer(const QString& words, const QString& file, const std::string& text) {
  say(found_, words);
  file_ = file;
  text_ = shownText(text);
  refresh();
  emit changed();
  QTimer::singleShot(kLaidOut, this, &CalibrationCard::bringIntoView);
}

void CalibrationCard::bringIntoView() {
  if (found_->text().isEmpty()) return;
  QWidget* last = file_.isEmpty() ? static_cast<QWidget*>(found_) : use_;
  for (QWidget* above = parentWidget(); above != nullptr; above = above->parentWidget())
    if (auto* column = qobject_cast<QScrollArea*>(above)) return column->ensureWidgetVisible(last);
}

void CalibrationCard::findCamera() {
  const std::string words = board_->text().toStdString();
  std::optional<Board> board;
  try {
    board = parseBoard(words);
  } catch (const Error& error) {
    return refuse(shownText(error.what()));
  }
  offer({}, {}, {});
  const std::string source = source_->text().trimmed().toStdString();
  const std::string from = source.empty() ? scan_.files()->folder.string() : source;
  job_.start([this, board = *board, words, from,
              is_open = source.empty()](Progress& progress, const Background::Post& post) {
    try {
      const auto seen = [&](const BoardLook& look) {
        if (look.view && is_open)
          post(false, [this, i = look.frame, view = *look.view] { emit boardSeen(i, view); });
      };
      const CameraCalibration found = calibrateCamera({from, board, words}, progress, seen);
      post(true, [this, found] {
        if (!found.doubt.empty()) return refuse(shownText(found.doubt));
        offer(wordsOf(found), QStringLiteral("camera.yml"), found.file);
      });
    } catch (const std::exception& error) {
      post(true, [this, problem = shownText(error.what())] { refuse(problem); });
    }
  });
  refresh();
  emit changed();
}

void CalibrationCard::findTip() {
  try {
    const std::vector<CameraPose>& poses = scan_.path()->poses;
    const std::string where = scan_.name().toStdString();
    const std::string* rig = scan_.files()->scan.text("rig.json");
    const TipCalibration found = calibrateTip(poses, where, {rig ? *rig : "", where + "/rig.json"});
    offer(wordsOf(found.fit, poses.size()), QStringLiteral("rig.json"), found.file);
  } catch (const Error& error) {
    refuse(shownText(error.what()));
  }
}

FindingList::FindingList(OpenScan& scan, QWidget* parent) : QListWidget(parent), scan_(scan) {
  setUniformItemSizes(true);
  dressPage(this, "findings",
            tr("Missing or rejected parts of the scan, with the reason. Click one to go there."));
  connect(this, &QListWidget::currentRowChanged, this, [this](int row) {
    if (row < 0 || scan_.path() == nullptr) return;
    const auto& findings = scan_.path()->findings;
    if (row >= static_cast<int>(findings.size())) return; // The row that reports no findings.
    const Finding& finding = findings[static_cast<std::size_t>(row)];
    // A gap begins and ends at poses, so its middle is shown.
    const bool lasts = finding.kind == Finding::Kind::gap || finding.kind == Finding::Kind::dropout;
    scan_.cursor().set(lasts ? (finding.from + finding.to) / 2 : finding.from);
  });
  connect(&scan_, &OpenScan::opened, this, &FindingList::fill);
  connect(&scan_, &OpenScan::pathMade, this, &FindingList::fill);
  connect(&scan_.cursor(), &ScanCursor::moved, this, &FindingList::follow);
}

void FindingList::fill() {
  const QSignalBlocker quiet(this);
  clear();
  if (scan_.path() == nullptr) return;
  for (const Finding& finding : scan_.path()->findings) {
    auto* item = new QListWidgetItem(QStringLiteral("%1 s   %2   %3")
                                         .arg(finding.from, 7, 'f', 3)
                                         .arg(wordOf(finding.kind), finding.words),
                                     this);
    item->setToolTip(finding.words);
  }
  if (count() == 0)
    addItem(scan_.path()->poses.empty() ? tr("There are no poses yet.")
                                        : tr("Every frame has a pose, and the path has no gap."));
  follow();
}

void FindingList::follow() {
  const QSignalBlocker quiet(this);
  const Finding* finding = scan_.cursor().finding();
  setCurrentRow(finding == nullptr ? -1
                                   : static_cast<int>(finding - scan_.path()->findings.data()));
}

ScanDesk::ScanDesk(QWidget& window)
    : QObject(&window), window_(window), scan_(this), panel_(new ScanPanel(scan_)),
      central_views_(new ScanCentralViews(scan_, *panel_)),
      calibration_(new CalibrationCard(scan_)), recording_(this), timeline_(timelineOf(scan_)),
      findings_(new FindingList(scan_)) {
  connectScan();
  connectScans();
  connectCalibration();
  connectRecording();
  for (QWidget* keys : {static_cast<QWidget*>(central_views_), timeline_})
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

std::map<Panel, QWidget*> ScanDesk::panels() const {
  return {{Panel::scan, panel_},
          {Panel::recorder, recorder_},
          {Panel::calibration, calibration_},
          {Panel::timeline, timeline_},
          {Panel::findings, findings_}};
}

void ScanDesk::connectScan() {
  connect(&scan_, &OpenScan::opened, this, &ScanDesk::takeScan);
  connect(&scan_, &OpenScan::pathMade, this, [this] {
    const ScanPath* path = scan_.path();
    if (path != nullptr && !scan_.grows() && !path->path.empty())
      emit pathMade(scan_.name(), path->path);
    emit changed();
  });
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
                tr("What was open before stays open."));
  });
  connect(&central_views_->firstHour(), &FirstHourPage::openRequested, this, &ScanDesk::openDialog);
  connect(&central_views_->firstHour(), &FirstHourPage::scanRequested, this,
          [this](const RecordingChoice& choice) {
            recorder_->choose(choice);
            recording_.begin(recorder_->choice());
          });
  connect(panel_, &ScanPanel::openRequested, this, &ScanDesk::openDialog);
  connect(panel_, &ScanPanel::textureRequested, this, &ScanDesk::textureRequested);
  connect(panel_, &ScanPanel::closeRequested, &scan_, &OpenScan::close);
  connect(panel_, &ScanPanel::keepRequested, this, [this] {
    try {
      saveResults(scan_);
      emit notified({tr("Poses and path are in %1").arg(scan_.name())});
      open(scan_.files()->folder);
    } catch (const Error& error) {
      showProblem(&window_, tr("Poses and path cannot be saved"), shownText(error.what()),
                  tr("Make room, or the folder writable."));
    }
  });
}

void ScanDesk::connectScans() {
  panel_->layout()->addWidget(scans_);
  connect(scans_, &SceneScans::putRequested, this, [this] {
    if (isOpen()) scans_->put(foundSteps(scan_));
  });
  connect(scans_, &SceneScans::openRequested, this, qOverload<const SceneScan&>(&ScanDesk::open));
  connect(scans_, &SceneScans::notified, this, &ScanDesk::notified);
  connect(scans_, &SceneScans::failed, this, [this](const QString& problem) {
    showProblem(&window_, tr("The workspace's scans stay as they are"), problem,
                tr("Nothing has changed."));
  });
}

void ScanDesk::connectCalibration() {
  connect(calibration_, &CalibrationCard::picturesRequested, this, [this] {
    askForPath(&window_, tr("Open pictures of a board"), QFileDialog::Directory, {},
               [this](const QString& folder) { scan_.openPictures(folder.toStdString()); });
  });
  connect(calibration_, &CalibrationCard::boardSeen, &central_views_->frame(),
          &FrameView::addBoard);
  connect(calibration_, &CalibrationCard::useRequested, this, &ScanDesk::use);
  connect(calibration_, &CalibrationCard::progressed, this, [this](double fraction) {
    if (work_) work_->fraction = fraction;
    emit changed();
  });
  connect(calibration_, &CalibrationCard::changed, this, [this] {
    const QString words = tr("Calibrating");
    if (calibration_->busy())
      work_ = TaskProgress{words, words};
    else if (work_ && work_->title == words)
      work_.reset();
    emit changed();
  });
}

void ScanDesk::use(const QString& file, const QString& text) {
  if (scan_.files() == nullptr) {
    askForPath(
        &window_, tr("Keep %1 in").arg(file), QFileDialog::Directory, {},
        [this, file, text](const QString& folder) {
          try {
            const bool was_there =
                writeKeepingOld(std::filesystem::path(folder.toStdString()) / file.toStdString(),
                                text.toStdString());
            emit notified({was_there ? tr("%1 is in %2; the one before is %1~").arg(file, folder)
                                     : tr("%1 is in %2").arg(file, folder)});
          } catch (const std::exception& error) {
            showProblem(&window_, tr("The calibration cannot be kept"), shownText(error.what()),
                        tr("Make room, or the folder writable."));
          }
        });
    return;
  }
  const ScanFiles& files = *scan_.files();
  const Calibration found{file.toStdString(),
                          std::make_shared<const std::string>(text.toStdString()),
                          !files.markers.empty()};
  const SceneScan* known = scans_->scene() ? findScan(*scans_->scene(), files.scan.name) : nullptr;
  if (known != nullptr && (files.of_scene || known->folder == files.scan.folder)) {
    const SceneScan scan = *known;
    scans_->change(scan.name, [found, scan](const SceneScan* now) {
      return withCalibration(now ? *now : scan, found);
    });
    if (!files.of_scene) open(withCalibration(scan, found));
    return emit notified({tr("%1 of scan %2 is in the workspace").arg(file, scan_.name())});
  }
  const std::filesystem::path folder = files.folder;
  QString words = tr("%1 is in %2").arg(file, shownText(folder.string()));
  try {
    for (const std::string& aside : calibrateFolder(folder, files.scan, found))
      words += tr(", %1 is %1~ now").arg(shownText(aside));
  } catch (const std::exception& error) {
    return showProblem(&window_, tr("The calibration cannot be kept"), shownText(error.what()),
                       tr("Make room, or the folder writable."));
  }
  emit notified({words});
  files.pictures ? scan_.openPictures(folder) : open(folder);
}

void ScanDesk::connectRecording() {
  connect(recorder_, &RecordPanel::recordRequested, this,
          [this] { recording_.begin(recorder_->choice()); });
  connect(recorder_, &RecordPanel::pauseRequested, &recording_, &ScanRecording::pause);
  connect(recorder_, &RecordPanel::stopRequested, &recording_, &ScanRecording::end);
  connect(&recording_, &ScanRecording::begun, this,
          [this](const ScanFiles& files) { scan_.begin(files); });
  connect(&recording_, &ScanRecording::updated, this, [this](const RecordingUpdate& news) {
    recorder_->setState(&news.state);
    if (!scan_.grows()) return; // Another scan was opened meanwhile.
    if (news.frame) central_views_->frame().showLive(*news.frame);
    if (!news.poses.empty() || !news.samples.empty()) scan_.grow(news.poses, news.samples);
  });
  connect(&recording_, &ScanRecording::ended, this,
          [this](const QString& folder, const QString& problem) {
            recorder_->setState(nullptr);
            emit openRequested(folder);
            if (!problem.isEmpty())
              showProblem(&window_, tr("The recording has ended"), problem,
                          tr("The data recorded until then is in %1.").arg(folder));
          });
  const auto tell = [this](const QString& line) { emit notified({line, true}); };
  connect(&recording_, &ScanRecording::noted, this, tell);
  connect(&scan_, &OpenScan::noted, this, tell);
  connect(&recording_, &ScanRecording::failed, this, [this](const QString& message) {
    showProblem(&window_, tr("Nothing can be recorded"), message,
                tr("Nothing was written. The tooltips explain each line."));
  });
}

void ScanDesk::open(const std::filesystem::path& folder) {
  begin(tr("Opening %1").arg(shownText(folder.filename().string())));
  scan_.open(folder);
}

void ScanDesk::open(const SceneScan& scan) {
  begin(tr("Opening %1").arg(shownText(scan.name)));
  scan_.open(scan);
}

void ScanDesk::openDialog() {
  askForPath(&window_, tr("Open a scan folder"), QFileDialog::Directory, {},
             [this](const QString& folder) { emit openRequested(folder); });
}

// An open scan of the scene follows edits and undo. A removed one stays open.
void ScanDesk::setScene(std::shared_ptr<const Scene> scene) {
  scans_->setScene(scene);
  if (!isOpen() || !scan_.files()->of_scene || !scene) return;
  const SceneScan* now = findScan(*scene, scan_.files()->scan.name);
  if (now != nullptr && !(*now == scan_.files()->scan)) open(*now);
}

void ScanDesk::takeScan() {
  scans_->setOpen(isOpen() && !scan_.files()->scan.files.empty());
  if (isOpen() && !scan_.files()->problem.empty())
    emit notified({shownText(scan_.files()->problem), true});
  if (isOpen())
    for (const std::string& line : scan_.files()->warnings) emit notified({shownText(line), true});
  emit changed();
  if (isOpen() && !scan_.files()->folder.empty() && !scan_.files()->of_scene &&
      scan_.files()->camera && !scan_.files()->markers.empty())
    recorder_->suggestCalibration(shownText(scan_.files()->folder.string()));
  if (isOpen()) emit opened();
}

} // namespace patina
