#include "app/gui/control/feel_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QDir>
#include <QFileDialog>
#include <QMessageBox>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/toolkit/card.h"
#include "core/error.h"
#include "haptics/catalog/device_catalog.h"

namespace patina {
namespace {

constexpr int kTimeout = 300; // [ms]

QString summary(const SurfaceStability& stability, bool device_given) {
  const StabilityMap& map = stability.map;
  const auto percent = [&](std::size_t count) {
    const double part = 100.0 * static_cast<double>(count) / static_cast<double>(map.ratio.size());
    return QString::number(part, 'f', part < 10 ? 1 : 0);
  };
  QString words =
      map.buzzing == 0
          ? StabilityJob::tr("Stable everywhere; lowest K*/K = %1").arg(map.worst_ratio, 0, 'g', 3)
          : StabilityJob::tr("%1 % of the surface is unstable; lowest K*/K = %2")
                .arg(percent(map.buzzing))
                .arg(map.worst_ratio, 0, 'g', 3);
  const auto add = [&](std::size_t count, const QString& what) {
    if (count > 0) words += StabilityJob::tr("; %1 % %2").arg(percent(count), what);
  };
  const auto untouched =
      std::count_if(map.least.begin(), map.least.end(), [](float l) { return std::isnan(l); });
  add(map.unstable_count, StabilityJob::tr("pushes the tip aside (violet, unless unstable)"));
  add(map.discontinuous_count, StabilityJob::tr("has a force jump (dark)"));
  add(static_cast<std::size_t>(untouched), StabilityJob::tr("cannot be touched (grey)"));
  if (!device_given)
    words += StabilityJob::tr(". Assumes a device of 100 g and 0.5 N s/m at 1 kHz, because the "
                              "scene has no device parameters.");
  return words;
}

} // namespace

StabilityJob::StabilityJob(QObject* parent) : QObject(parent) {
  timer_.setSingleShot(true);
  timer_.setInterval(kTimeout);
  connect(&timer_, &QTimer::timeout, this, &StabilityJob::begin);
  connect(&jobs_, &Background::progressed, this, [this](double fraction) {
    emit notified(tr("Computing stability: %1 %").arg(100 * fraction, 0, 'f', 0));
  });
}

void StabilityJob::request(std::shared_ptr<const CompiledScene> scene) {
  cancel();
  scene_ = std::move(scene);
  if (scene_ == nullptr) return emit notified({});
  emit notified(tr("Computing stability…"));
  timer_.start();
}

void StabilityJob::begin() {
  jobs_.start([this, scene = scene_](Progress& progress, const Background::Post& post) {
    std::shared_ptr<const SurfaceStability> made;
    QString words;
    try {
      if (auto stability = surfaceStability(*scene, progress)) {
        made = std::make_shared<const SurfaceStability>(std::move(*stability));
        words = summary(*made, scene->scene.device_model.has_value());
      } else {
        words = tr("No point of this surface can be pressed, so there is no map");
      }
    } catch (const Cancelled&) {
      return;
    } catch (const std::exception& error) {
      words = QString::fromUtf8(error.what());
    }
    post(true, [this, made, words] {
      emit done(made);
      emit notified(words);
    });
  });
}

void FeelController::open(const Scene& scene, const Vec3& start) {
  close();
  sample_ = {};
  at_.force.clear();
  at_.energy.restart();
  place(scene, start);
}

void FeelController::place(const Scene& scene, const Vec3& start) {
  const DeviceEntry& entry = deviceNamed(scene.device);
  const auto target = std::make_shared<TipTarget>(start);
  const DeviceModel model =
      entry.uses_device_model ? scene.device_model.value_or(entry.model) : entry.model;
  const DeviceSetup setup{.name = scene.device, .target = target, .model = model};
  notes_ = entry.linked ? setup.notes : nullptr;
  held_back_.clear(); // It belonged to another device.
  setNeedsButton(needs_button_);
  checkDevice();
  try {
    servo_.open(openDevice(entry, setup, mountAt(entry, start), controls_), target, model.rate);
  } catch (const DeviceError& error) {
    notes_ = nullptr;
    emit failed(QString::fromUtf8(error.what()));
  }
}

void FeelController::close() {
  stability_.request(nullptr);
  servo_.close();
  collect();
}

void FeelController::checkDevice() {
  if (notes_) notes_->heartbeat_at = clock_->now();
  QString held_back = notes_ ? QString::fromStdString(patina::inhibitText(*notes_)) : QString();
  if (!controls_->enabled) held_back = tr("no force: it is switched off");
  if (held_back == held_back_) return;
  held_back_ = held_back;
  // A message replaces the warning when it no longer holds.
  Message message{held_back, true};
  if (held_back.isEmpty()) message = {tr("The device gives force again")};
  if (!controls_->enabled) message.action = {tr("Switch on"), [this] { setForce(true); }};
  emit notified(message);
}

void FeelController::collect() {
  checkDevice();
  const std::vector<ToolSample> samples = servo_.drain();
  recording_.add(samples, servo_.dropped());
  if (log_) log_->add(samples, servo_.dropped());
  checkDisk();
  emit collected(samples);
  if (samples.empty()) return;
  sample_ = samples.back();
  at_.force.addSamples(samples);
  at_.energy.addSamples(samples, servo_.dropped());
}

void FeelController::checkDisk() {
  QString problem;
  for (const SampleLog* table : {recording_.log(), log()})
    if (table != nullptr && problem.isEmpty()) problem = QString::fromStdString(table->problem());
  if (problem.isEmpty() == disk_problem_.isEmpty()) return;
  disk_problem_ = problem;
  if (problem.isEmpty())
    emit notified({tr("The recorded ticks are written again")});
  else
    emit notified(
        {tr("Recorded ticks wait in memory, and later ones will be lost: %1").arg(problem), true});
}

void FeelController::startLog(const std::filesystem::path& path) {
  collect();
  log_.emplace(path, servo_.dropped());
}

void FeelController::startRecording() {
  try {
    recording_.start(servo_.dropped());
    emit notified({tr("Recording the forces; Record forces again stops and saves them")});
  } catch (const std::exception& error) {
    showProblem(&at_.window, tr("The recording cannot be started"),
                QString::fromStdString(error.what()), tr("Free some disk space."));
  }
}

void FeelController::toggleRecording() {
  collect();
  if (SampleLog* log = recording_.log(); log == nullptr) {
    startRecording();
  } else {
    log->pause();
    if (!saveRecording() && !confirmRecording()) log->resume();
  }
  emit changed();
}

bool FeelController::confirmRecording() {
  collect();
  while (recording_.log() != nullptr && recording_.log()->rows() > 0) {
    const int answer =
        askToSave(&at_.window, "unsaved_recording", tr("The recording is not saved"),
                  tr("%1 recorded samples are not saved yet.").arg(recording_.log()->rows()));
    if (answer == QMessageBox::Discard)
      recording_.clear();
    else if (answer == QMessageBox::Save)
      saveRecording();
    else
      return false;
  }
  recording_.clear();
  emit changed();
  return true;
}

bool FeelController::saveTable(const std::function<void(const std::filesystem::path&)>& save) {
  const QString path = QFileDialog::getSaveFileName(
      &at_.window, tr("Save the recorded forces"),
      QDir(lastFolder()).filePath(QStringLiteral("feel.csv")), tr("Tables (*.csv)"));
  if (path.isEmpty()) return false;
  rememberFolder(path);
  try {
    save(path.toStdString());
  } catch (const std::exception& error) {
    showProblem(&at_.window, tr("The recording cannot be saved"),
                QString::fromStdString(error.what()),
                tr("Choose a folder with write permission. The recording is still available."));
    return false;
  }
  return true;
}

bool FeelController::saveRecording() {
  return saveTable([this](const std::filesystem::path& path) {
    const std::size_t count = recording_.log()->rows(), lost = recording_.log()->lost();
    recording_.save(path);
    QString words =
        tr("Saved %1 samples to %2").arg(count).arg(QString::fromStdString(path.string()));
    if (lost > 0) words += tr("; %1 samples were lost because the buffer was full").arg(lost);
    emit notified({words, lost > 0});
  });
}

void FeelController::recover(const std::filesystem::path& place) {
  saveTable([&](const std::filesystem::path& path) {
    const auto left = Autosave::adopt(place);
    saveRecovered(*left, path);
    left->claim();
    emit notified({tr("Saved the recording to %1").arg(QString::fromStdString(path.string()))});
  });
}

} // namespace patina
