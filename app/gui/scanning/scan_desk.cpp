#include "app/gui/scanning/scan_desk.h"

#include <QFileDialog>
#include <QShortcut>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/scanning/calibrated_scan.h"
#include "app/gui/scanning/found_files.h"
#include "app/gui/scanning/frame_strip.h"
#include "app/gui/scanning/scan_traces.h"
#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

QWidget* timelineOf(OpenScan& scan) {
  auto* timeline = new QWidget;
  auto* column = new QVBoxLayout(timeline);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addWidget(new FrameStrip(scan));
  column->addWidget(new ScanTraces(scan), 1);
  return timeline;
}

QFileDialog* askForFolder(QWidget& window, const QString& title) {
  auto* dialog = new QFileDialog(&window, title);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  dialog->open();
  return dialog;
}

} // namespace

ScanDesk::ScanDesk(QWidget& window)
    : QObject(&window), window_(window), scan_(this), panel_(new ScanPanel(scan_)),
      cells_(new ScanCells(scan_, *panel_)), calibration_(new CalibrationCard(scan_)),
      recording_(this), timeline_(timelineOf(scan_)), findings_(new FindingList(scan_)) {
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
                tr("What was open before is as it was."));
  });
  connect(cells_, &ScanCells::openAsked, this, &ScanDesk::openDialog);
  connect(panel_, &ScanPanel::openAsked, this, &ScanDesk::openDialog);
  connect(panel_, &ScanPanel::textureAsked, this, &ScanDesk::textureAsked);
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
  connect(calibration_, &CalibrationCard::picturesAsked, this, [this] {
    connect(askForFolder(window_, tr("Open pictures of a board")), &QFileDialog::fileSelected, this,
            [this](const QString& folder) { scan_.openPictures(folder.toStdString()); });
  });
  connect(calibration_, &CalibrationCard::boardSeen, &cells_->frame(), &FrameView::addBoard);
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

void ScanDesk::use(const QString& file, const QString& text) {
  if (scan_.files() == nullptr) {
    connect(askForFolder(window_, tr("Keep %1 in").arg(file)), &QFileDialog::fileSelected, this,
            [this, file, text](const QString& folder) {
              try {
                const std::filesystem::path kept =
                    std::filesystem::path(folder.toStdString()) / file.toStdString();
                const bool was_there = std::filesystem::exists(kept);
                if (was_there) std::filesystem::rename(kept, kept.string() + "~");
                writeFileAtomically(kept, text.toStdString());
                emit said({was_there ? tr("%1 is in %2; the one before is %1~").arg(file, folder)
                                     : tr("%1 is in %2").arg(file, folder)});
              } catch (const std::exception& error) {
                showProblem(&window_, tr("The calibration cannot be kept"),
                            QString::fromStdString(error.what()),
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
    return emit said({tr("%1 of scan %2 is in the workspace").arg(file, scan_.name())});
  }
  const std::filesystem::path folder = files.folder;
  QString words = tr("%1 is in %2").arg(file, QString::fromStdString(folder.string()));
  try {
    for (const std::string& aside : calibrateFolder(folder, files.scan, found))
      words += tr(", %1 is %1~ now").arg(QString::fromStdString(aside));
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
    if (news.frame) cells_->frame().showLive(*news.frame);
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
  const auto tell = [this](const QString& line) { emit said({line, true}); };
  connect(&recording_, &ScanRecording::noted, this, tell);
  connect(&scan_, &OpenScan::noted, this, tell);
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
  connect(askForFolder(window_, tr("Open a scan folder")), &QFileDialog::fileSelected, this,
          &ScanDesk::openAsked);
}

void ScanDesk::cancel() {
  scan_.cancel();
  calibration_->cancel();
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
  if (isOpen())
    for (const std::string& line : scan_.files()->warnings)
      emit said({QString::fromStdString(line), true});
  emit changed();
  if (isOpen() && !scan_.files()->folder.empty() && !scan_.files()->of_scene &&
      scan_.files()->camera && !scan_.files()->markers.empty())
    recorder_->suggestCalibration(QString::fromStdString(scan_.files()->folder.string()));
  if (isOpen()) emit opened();
}

void ScanDesk::refresh() {
  recording_.refresh();
  cells_->refresh();
}

} // namespace patina
