#include "app/gui/aligning/align_panel.h"

#include <QGroupBox>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/scanning/scan_path.h"
#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/form.h"
#include "app/gui/toolkit/words.h"
#include "core/numbers.h"

namespace patina {

AlignPanel::AlignPanel(QWidget* parent) : QWidget(parent) {
  auto* all = layoutIn<QVBoxLayout>(this, 4);

  auto* path = new QGroupBox(tr("Path"));
  auto* column = layoutIn<QVBoxLayout>(path);
  path_ = named(new ElidedLabel, "align_path");
  column->addWidget(path_);
  addButton(column, "align_open", tr("Open path…"),
            tr("A path.csv of a scan. The path of a scan that is open on the desk Scan is used "
               "automatically."),
            this, &AlignPanel::openRequested);
  scans_ = named(new QComboBox, "align_scan",
                 tr("Scans of the workspace that have a path, with their saved poses"));
  column->addWidget(scans_);
  store_ = addButton(column, "align_store", tr("Put into workspace"),
                     tr("Stores the path and its pose in the scene. They are saved with it and can "
                        "be undone like any edit."),
                     this, &AlignPanel::storeRequested);
  keep_ = addButton(column, "align_keep", tr("Keep…"),
                    tr("Writes the path in the mesh's frame, and the pose to a text file for "
                       "`patina register --initial`"),
                    this, &AlignPanel::keepRequested);
  all->addWidget(path);

  auto* place = new QGroupBox(tr("Place on the mesh"));
  column = layoutIn<QVBoxLayout>(place);
  auto* form = new Form(place);
  constexpr const char* kNames[] = {"align_x", "align_y", "align_z",
                                    "align_a", "align_b", "align_c"};
  const QString words[] = {tr("Shift x"),      tr("Shift y"),      tr("Shift z"),
                           tr("Turn about x"), tr("Turn about y"), tr("Turn about z")};
  for (std::size_t i = 0; i < 6; ++i) {
    const bool turns = i >= 3;
    const RowRange range = turns ? RowRange{-180, 180, 1, 2} : RowRange{-9999, 9999, 0.5, 2};
    rows_[i] =
        form->addRow(RowSpec(kNames[i], words[i], turns ? QStringLiteral("°") : tr("mm"), range,
                             turns ? tr("About the mesh's fixed axes: first x, then y, then z")
                                   : tr("Along the mesh's axis")),
                     0, [this](double) { emit edited(values()); });
  }
  column->addWidget(form);
  pick_ = addButton(column, "align_pick", tr("Three points"),
                    tr("Click a point on the path, then the same point on the mesh, three times"));
  pick_->setCheckable(true);
  hint_ = addNote(column, "align_hint");
  fit_ = addButton(column, "align_fit", tr("Fit from here"),
                   tr("Finds the nearest good fit by least squares, as `patina register` does"),
                   this, &AlignPanel::fitRequested);
  fit_->setDefault(true);
  begin_ = addButton(column, "align_begin", tr("Middle on middle"),
                     tr("Moves the centre of the path to the centre of the mesh; can be undone"),
                     this, &AlignPanel::beginRequested);
  all->addWidget(place);
  place_ = place;

  auto* error = new QGroupBox(tr("Distance from the surface"));
  column = layoutIn<QVBoxLayout>(error);
  off_ = addNote(column, "align_error", "");
  fit_words_ = addNote(column, "align_found");
  lines_ = addButton<QCheckBox>(
      column, "align_lines", {},
      tr("Lines from the surface to the samples of the fit, coloured by distance. Short lines are "
         "enlarged by the factor shown here."));
  map_ = addButton<QCheckBox>(
      column, "align_map", tr("Error map"),
      tr("Mean distance of nearby samples, shown on the mesh. Grey: no samples."));
  next_ = addButton<QCheckBox>(
      column, "align_next", tr("Next stroke"),
      tr("Where to scan next: the stroke that would add most to what the fit knows of pose and "
         "heights. Without the error map the mesh shows how exactly its heights are known."));
  next_words_ = addNote(column, "align_next_words");
  for (QCheckBox* box : {lines_, map_, next_})
    connect(box, &QCheckBox::toggled, this, &AlignPanel::shownChanged);
  all->addWidget(error);
  error_ = error;

  connect(scans_, qOverload<int>(&QComboBox::activated), this, [this](int row) {
    if (row > 0) emit scanChosen(scans_->itemText(row));
    scans_->setCurrentIndex(0);
  });
  connect(pick_, &QPushButton::toggled, this, &AlignPanel::pickToggled);
  setScans({});
  setPath({}, 0);
  setReady(false, false);
  setPicking({});
  setFit({});
  setNext({});
  setStretch(0);
}

PoseValues AlignPanel::values() const {
  return {{rows_[0]->value(), rows_[1]->value(), rows_[2]->value()},
          {rows_[3]->value(), rows_[4]->value(), rows_[5]->value()}};
}

void AlignPanel::setScans(const QStringList& names) {
  scans_->clear();
  scans_->addItem(tr("From the workspace…"));
  scans_->addItems(names);
  scans_->setVisible(!names.isEmpty());
}

void AlignPanel::setPath(const QString& name, std::size_t samples) {
  path_->setText(samples == 0
                     ? tr("No path is open")
                     : tr("%1: %2 samples in contact").arg(name, shownText(formatCount(samples))));
}

void AlignPanel::setReady(bool ready, bool works) {
  place_->setVisible(ready);
  error_->setVisible(ready);
  keep_->setVisible(ready);
  store_->setVisible(ready);
  for (QPushButton* each : {pick_, fit_, begin_, keep_, store_}) each->setEnabled(!works);
}

void AlignPanel::setValues(const PoseValues& values, double reach) {
  for (std::size_t i = 0; i < 6; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    if (i < 3) rows_[i]->setReach(1e3 * reach);
    rows_[i]->setValue(i < 3 ? values.position_mm[axis] : values.angles_deg[axis]);
  }
}

void AlignPanel::setResiduals(const Residuals& residuals) {
  say(off_, tr("All samples: mean %1 · rms %2 · worst %3")
                .arg(inWords(residuals.mean), inWords(residuals.rms), inWords(residuals.worst)));
}

void AlignPanel::setStretch(double times) {
  lines_->setText(times > 1 ? tr("Lines to the surface × %1").arg(times, 0, 'g', 4)
                            : tr("Lines to the surface"));
}

void AlignPanel::setPicking(const QString& words) {
  const QSignalBlocker quiet(pick_);
  pick_->setChecked(!words.isEmpty());
  say(hint_, words);
}

} // namespace patina
