#include "app/gui/scanning/record_panel.h"

#include <QDir>
#include <QFileDialog>
#include <QGridLayout>
#include <QMenu>
#include <QToolButton>
#include <QVBoxLayout>

namespace patina {

RecordPanel::RecordPanel(QWidget* parent)
    : QGroupBox(tr("Record"), parent), sources_(new QWidget(this)),
      record_(new QPushButton(tr("Record"), this)), pause_(new QPushButton(tr("Pause"), this)),
      stop_(new QPushButton(tr("Stop"), this)), count_(new QLabel(this)), lost_(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  auto* grid = new QGridLayout(sources_);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(3);
  column->addWidget(sources_);
  frames_ = addPath("record_frames", tr("Frames"),
                    tr("camera:0 for a live camera, a video, a scan folder, or replay: before a "
                       "scan folder for its frames at their own pace"));
  probe_ = addPath("record_probe", tr("Probe"),
                   tr("A probe.csv, stream: before a pipe or serial device, or replay: before a "
                      "scan folder; empty for none"));
  calibration_ = addPath("record_calibration", tr("Rig"),
                         tr("The folder with the camera.yml and rig.json that hold"));
  folder_ = addPath("record_folder", tr("Into"), tr("The scan folder that is made"));
  frames_->setText(QStringLiteral("camera:0"));
  suggestFolder();
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(4);
  const auto add = [&](QPushButton* button, const char* name, const QString& tip) {
    button->setObjectName(QString::fromUtf8(name));
    button->setToolTip(tip);
    buttons->addWidget(button);
  };
  add(record_, "record_scan", tr("Frames and samples go to disk as they come"));
  add(pause_, "pause_scan", tr("What is seen is shown and not kept, until it goes on"));
  add(stop_, "stop_scan", tr("Ends the recording and opens it as a scan"));
  pause_->setCheckable(true);
  column->addLayout(buttons);
  for (QLabel* label : {count_, lost_}) {
    label->setWordWrap(true);
    column->addWidget(label);
  }
  count_->setObjectName(QStringLiteral("record_count"));
  connect(record_, &QPushButton::clicked, this, &RecordPanel::recordAsked);
  connect(pause_, &QPushButton::toggled, this, &RecordPanel::pauseAsked);
  connect(stop_, &QPushButton::clicked, this, &RecordPanel::stopAsked);
  setState(nullptr);
}

QLineEdit* RecordPanel::addPath(const char* name, const QString& caption, const QString& tip) {
  auto* grid = static_cast<QGridLayout*>(sources_->layout());
  const int row = grid->rowCount();
  auto* label = new QLabel(caption, sources_);
  label->setProperty("quiet", true);
  auto* line = new QLineEdit(sources_);
  line->setObjectName(QString::fromUtf8(name));
  line->setToolTip(tip);
  auto* look = new QToolButton(sources_);
  look->setText(QStringLiteral("…"));
  look->setToolTip(tr("Choose a folder or a file"));
  look->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(look);
  const auto ask = [this, line](QFileDialog::FileMode mode) {
    auto* dialog = new QFileDialog(window());
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(mode);
    connect(dialog, &QFileDialog::fileSelected, line, &QLineEdit::setText);
    dialog->open();
  };
  menu->addAction(tr("Folder…"), this, [=] { ask(QFileDialog::Directory); });
  if (row <= 2) menu->addAction(tr("File…"), this, [=] { ask(QFileDialog::ExistingFile); });
  look->setMenu(menu);
  look->setStyleSheet(QStringLiteral("QToolButton::menu-indicator { image: none; }"));
  grid->addWidget(label, row, 0);
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

void RecordPanel::suggestCalibration(const QString& folder) {
  if (calibration_->text().isEmpty()) calibration_->setText(folder);
}

void RecordPanel::setState(const RecordingState* state) {
  // Nothing moves: a recording may end by itself under a hand that is about to end it.
  sources_->setEnabled(state == nullptr);
  record_->setEnabled(state == nullptr);
  pause_->setEnabled(state != nullptr);
  stop_->setEnabled(state != nullptr);
  count_->setVisible(state != nullptr);
  lost_->setVisible(false);
  if (state == nullptr) {
    if (QDir(folder_->text()).exists()) suggestFolder();
    pause_->setChecked(false);
    return;
  }
  pause_->setText(state->paused ? tr("Go on") : tr("Pause"));
  count_->setText(tr("%1%2 s · %3 frames · %4 poses · %5 samples")
                      .arg(state->paused ? tr("Paused, ") : QString())
                      .arg(state->seconds, 0, 'f', 1)
                      .arg(state->frames)
                      .arg(state->poses)
                      .arg(state->samples));
  QStringList lost;
  if (state->skipped > 0) lost << tr("frames not tracked meanwhile: %1").arg(state->skipped);
  if (state->unreadable > 0) lost << tr("unreadable frames: %1").arg(state->unreadable);
  if (state->dropouts > 0) lost << tr("dropouts of the probe: %1").arg(state->dropouts);
  lost_->setText(lost.join(QStringLiteral(", ")));
  lost_->setProperty("bad", true);
  lost_->setVisible(!lost.isEmpty());
}

} // namespace patina
