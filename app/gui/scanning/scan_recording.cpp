#include "app/gui/scanning/scan_recording.h"

#include "acquisition/files/camera_file.h"
#include "core/error.h"

namespace patina {

ScanRecording::ScanRecording(QObject* parent) : QObject(parent), job_(this) {}

void ScanRecording::begin(const RecordingChoice& choice) {
  if (job_.busy() || running()) return;
  job_.start([this, choice](Progress&, const Background::Deliver& deliver) {
    try {
      if (choice.folder.isEmpty()) throw Error("say which folder to record into");
      if (choice.calibration.isEmpty())
        throw Error("say which folder camera.yml and rig.json are in");
      const std::filesystem::path known = choice.calibration.toStdString();
      RecordingSetup setup;
      setup.folder = choice.folder.toStdString();
      setup.camera = known / "camera.yml";
      setup.rig = known / "rig.json";
      ScanFiles files;
      files.folder = setup.folder;
      files.camera = readCamera(setup.camera);
      files.rig = readRig(setup.rig);
      files.markers = readMarkers(setup.rig);
      auto frames = openFrames(choice.frames.toStdString(), 0);
      std::unique_ptr<ProbeSource> probe;
      if (!choice.probe.isEmpty()) probe = openProbe(choice.probe.toStdString());
      auto made = std::make_shared<Recorder>(std::move(frames), std::move(probe), setup);
      deliver(true, [this, made, files] {
        recorder_ = made;
        folder_ = files.folder;
        emit begun(files);
      });
    } catch (const std::exception& error) {
      deliver(true, [this, words = QString::fromStdString(error.what())] { emit failed(words); });
    }
  });
}

void ScanRecording::pause(bool pauses) {
  if (!running()) return;
  pauses ? recorder_->pause() : recorder_->resume();
}

void ScanRecording::end() {
  if (!running()) return;
  job_.start([this, recorder = std::move(recorder_),
              folder = folder_](Progress&, const Background::Deliver& deliver) {
    recorder->stop();
    const RecordingState state = recorder->poll().state;
    deliver(true, [this, folder, problem = state.error, notes = state.notes] {
      for (const std::string& line : notes) emit noted(QString::fromStdString(line));
      emit ended(QString::fromStdString(folder.string()), QString::fromStdString(problem));
    });
  });
  recorder_.reset();
}

void ScanRecording::refresh() {
  if (!running()) return;
  const RecordingNews news = recorder_->poll();
  emit came(news);
  if (!news.state.running) end();
}

} // namespace patina
