#include "app/gui/control/feel_controller.h"

#include <QFileDialog>
#include <QMessageBox>

#include "app/gui/loading/load_dialogs.h"
#include "core/error.h"
#include "haptics/devices/device_catalog.h"

namespace patina {

FeelController::FeelController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts), stability_(this) {}

FeelController::~FeelController() {
  servo_.close();
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
      entry.takes_numbers ? scene.device_model.value_or(entry.model) : entry.model;
  const DeviceSetup setup{.name = scene.device, .target = target, .model = model};
  notes_ = entry.linked ? setup.notes : nullptr;
  held_back_.clear(); // what was said of another device
  setNeedsButton(needs_button_);
  look();
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

void FeelController::setForce(bool on) {
  controls_->enabled = on;
}

void FeelController::setNeedsButton(bool on) {
  needs_button_ = on;
  if (notes_) notes_->needs_button = on;
}

void FeelController::look() {
  if (notes_) notes_->looked_at = clock_->now();
  QString held_back = notes_ ? QString::fromStdString(patina::heldBack(*notes_)) : QString();
  if (!controls_->enabled) held_back = tr("no force: it is switched off");
  if (held_back == held_back_) return;
  held_back_ = held_back;
  // The last word is what holds: a warning that is over does not stand there.
  if (held_back.isEmpty())
    emit said({tr("The device gives force again")});
  else
    emit said({held_back, true});
}

void FeelController::collect() {
  look();
  const std::vector<ToolSample> samples = servo_.drain();
  recording_.add(samples, servo_.dropped());
  log_.add(samples, servo_.dropped());
  emit collected(samples);
  if (samples.empty()) return;
  sample_ = samples.back();
  at_.force.addSamples(samples);
  at_.energy.addSamples(samples, servo_.dropped());
}

void FeelController::startLog() {
  collect();
  log_.start(servo_.dropped());
}

Recording& FeelController::log() {
  collect();
  return log_;
}

void FeelController::toggleRecording() {
  collect();
  if (!recording_.on()) {
    recording_.start(servo_.dropped());
  } else {
    recording_.pause();
    if (!saveRecording() && !settleRecording()) recording_.resume();
  }
  emit changed();
}

bool FeelController::settleRecording() {
  collect();
  while (!recording_.samples().empty()) {
    QMessageBox box(QMessageBox::Question, tr("The recording is not saved"),
                    tr("%1 recorded ticks are in no file yet.").arg(recording_.samples().size()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &at_.window);
    box.setObjectName(QStringLiteral("unsaved_recording"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard)
      recording_.clear();
    else if (answer == QMessageBox::Save)
      saveRecording();
    else
      return false;
  }
  emit changed();
  return true;
}

bool FeelController::saveRecording() {
  const QString path =
      QFileDialog::getSaveFileName(&at_.window, tr("Save the recorded forces"),
                                   QStringLiteral("feel.csv"), tr("Tables (*.csv)"));
  if (path.isEmpty()) return false;
  const std::size_t count = recording_.samples().size(), lost = recording_.lost();
  try {
    recording_.save(path.toStdString());
  } catch (const std::exception& error) {
    showProblem(&at_.window, tr("The recording cannot be saved"),
                QString::fromStdString(error.what()),
                tr("Choose a folder that you may write to. The recording is kept."));
    return false;
  }
  QString words = tr("Saved %1 ticks to %2").arg(count).arg(path);
  if (lost > 0) words += tr("; %1 ticks came too fast to be kept").arg(lost);
  emit said({words, lost > 0});
  return true;
}

} // namespace patina
