#include "app/gui/scanning/scan_recording.h"

#include <QDir>
#include <QGridLayout>
#include <QMenu>
#include <QToolButton>
#include <QVBoxLayout>

#include "acquisition/files/camera_file.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"

namespace patina {

RecordPanel::RecordPanel(QWidget* parent)
    : QGroupBox(tr("Record"), parent), sources_(new QWidget(this)) {
  auto* column = layoutIn<QVBoxLayout>(this);
  layoutIn<QGridLayout>(sources_, 3);
  column->addWidget(sources_);
  // The buttons are made before the lines of text. Else the focus of a button of the card above
  // that hides would pass to a line, which takes the keys of undo.
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(4);
  column->addLayout(buttons);
  record_ = addButton(buttons, "record_scan", tr("Record"),
                      tr("Writes frames and samples to disk at once"), this,
                      &RecordPanel::recordRequested);
  pause_ =
      addButton(buttons, "pause_scan", tr("Pause"), tr("Pauses writing; the picture stays live"));
  stop_ =
      addButton(buttons, "stop_scan", tr("Stop"), tr("Ends the recording and opens it as a scan"),
                this, &RecordPanel::stopRequested);
  pause_->setCheckable(true);
  frames_ = addPath("record_frames", tr("Frames"),
                    tr("camera:0 for a live camera, a video, a scan folder, or replay: before a "
                       "scan folder to play its frames in real time"));
  probe_ = addPath("record_probe", tr("Probe"),
                   tr("A probe.csv, stream: before a pipe or serial device, or replay: before a "
                      "scan folder; empty for none"));
  calibration_ = addPath("record_calibration", tr("Rig"),
                         tr("The folder with the valid camera.yml and rig.json; empty before there "
                            "are any: then frames are recorded and not tracked"));
  folder_ = addPath("record_folder", tr("Into"), tr("The new scan folder"));
  frames_->setText(QStringLiteral("camera:0"));
  suggestFolder();
  count_ = addNote(column, "record_count", "");
  lost_ = addNote(column, "record_lost", "bad");
  connect(pause_, &QPushButton::toggled, this, &RecordPanel::pauseRequested);
  setState(nullptr);
}

QLineEdit* RecordPanel::addPath(const char* name, const QString& caption, const QString& tip) {
  auto* grid = static_cast<QGridLayout*>(sources_->layout());
  const int row = grid->rowCount();
  auto* line = named(new QLineEdit(sources_), name, tip);
  auto* look = new QToolButton(sources_);
  look->setText(QStringLiteral("…"));
  look->setToolTip(tr("Choose a folder or a file"));
  look->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(look);
  const auto ask = [this, line](QFileDialog::FileMode mode) {
    askForPath(window(), {}, mode, {}, [line](const QString& path) { line->setText(path); });
  };
  menu->addAction(tr("Folder…"), this, [=] { ask(QFileDialog::Directory); });
  if (row <= 2) menu->addAction(tr("File…"), this, [=] { ask(QFileDialog::ExistingFile); });
  look->setMenu(menu);
  look->setStyleSheet(QStringLiteral("QToolButton::menu-indicator { image: none; }"));
  grid->addWidget(quietLabel(caption), row, 0);
  grid->addWidget(line, row, 1);
  grid->addWidget(look, row, 2);
  return line;
}

void RecordPanel::suggestFolder() {
  int number = 1;
  const auto named = [&] { return QDir::home().filePath(QStringLiteral("scan-%1").arg(number)); };
  while (QDir(named()).exists()) ++number;
  folder_->setText(named());
}

RecordingChoice RecordPanel::choice() const {
  return {frames_->text().trimmed(), probe_->text().trimmed(), calibration_->text().trimmed(),
          folder_->text().trimmed()};
}

void RecordPanel::choose(const RecordingChoice& choice) {
  frames_->setText(choice.frames);
  if (!choice.probe.isEmpty()) probe_->setText(choice.probe);
  calibration_->setText(choice.calibration);
  folder_->setText(choice.folder);
}

void RecordPanel::setState(const RecordingState* state) {
  // The layout stays, because a recording may end by itself just before a click on the button.
  sources_->setEnabled(state == nullptr);
  record_->setEnabled(state == nullptr);
  pause_->setEnabled(state != nullptr);
  stop_->setEnabled(state != nullptr);
  for (QLabel* note : {count_, lost_}) say(note, {});
  if (state == nullptr) {
    if (QDir(folder_->text()).exists()) suggestFolder();
    pause_->setChecked(false);
    return;
  }
  pause_->setText(state->paused ? tr("Go on") : tr("Pause"));
  say(count_, tr("%1%2 s · %3 frames · %4 · %5 samples")
                  .arg(state->paused ? tr("Paused, ") : QString())
                  .arg(state->seconds, 0, 'f', 1)
                  .arg(state->frames)
                  .arg(state->tracks ? tr("%1 poses").arg(state->poses) : tr("not tracked"))
                  .arg(state->samples));
  QStringList lost;
  if (state->skipped > 0) lost << tr("frames not tracked meanwhile: %1").arg(state->skipped);
  if (state->unreadable > 0) lost << tr("unreadable frames: %1").arg(state->unreadable);
  if (state->dropouts > 0) lost << tr("dropouts of the probe: %1").arg(state->dropouts);
  say(lost_, lost.join(QStringLiteral(", ")));
}

ScanRecording::ScanRecording(QObject* parent) : QObject(parent), job_(this) {}

void ScanRecording::begin(const RecordingChoice& choice) {
  if (job_.busy() || running()) return;
  ends_ = false;
  job_.start([this, choice](Progress&, const Background::Post& post) {
    try {
      if (choice.folder.isEmpty()) throw Error("no scan folder: choose where to record");
      RecordScanOptions options{.frames = choice.frames.toStdString(),
                                .probe = choice.probe.toStdString()};
      RecordingSetup& setup = options.setup;
      setup.folder = choice.folder.toStdString();
      ScanFiles files;
      files.folder = setup.folder;
      if (!choice.calibration.isEmpty()) {
        const std::filesystem::path known = choice.calibration.toStdString();
        if (std::filesystem::exists(known / "camera.yml")) setup.camera = known / "camera.yml";
        if (std::filesystem::exists(known / "rig.json")) setup.rig = known / "rig.json";
        if (setup.camera.empty() && setup.rig.empty())
          throw FileError(known.string(), 0, "has neither a camera.yml nor a rig.json");
        if (!setup.camera.empty()) files.camera = readCamera(setup.camera);
        if (!setup.rig.empty()) {
          files.rig = readRig(setup.rig);
          files.markers = readMarkers(setup.rig);
        }
      }
      const std::shared_ptr<Recorder> made = startRecording(options);
      post(true, [this, made, files] {
        recorder_ = made;
        folder_ = files.folder;
        emit begun(files);
      });
    } catch (const std::exception& error) {
      post(true, [this, words = shownText(error.what())] { emit failed(words); });
    }
  });
}

void ScanRecording::pause(bool pauses) {
  if (!running()) return;
  pauses ? recorder_->pause() : recorder_->resume();
}

void ScanRecording::end() {
  if (!running()) return;
  ends_ = true;
  job_.start([this, recorder = std::move(recorder_),
              folder = folder_](Progress&, const Background::Post& post) {
    recorder->stop();
    const RecordingState state = recorder->poll().state;
    post(true, [this, folder, problem = state.error, notes = state.notes] {
      for (const std::string& line : notes) emit noted(shownText(line));
      emit ended(shownText(folder.string()), shownText(problem));
    });
  });
  recorder_.reset();
}

void ScanRecording::finish() {
  if (const auto recorder = std::exchange(recorder_, nullptr)) recorder->stop();
  if (ends_) job_.wait();
}

void ScanRecording::refresh() {
  if (!running()) return;
  const RecordingUpdate news = recorder_->poll();
  emit updated(news);
  if (!news.state.running) end();
}

} // namespace patina
