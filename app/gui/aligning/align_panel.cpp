#include "app/gui/aligning/align_panel.h"

#include <QGroupBox>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/panels/form.h"
#include "app/gui/scanning/scan_path.h"
#include "app/gui/widgets/elided_label.h"
#include "app/gui/widgets/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

QVBoxLayout* columnIn(QGroupBox* card) {
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  return column;
}

QPushButton* buttonIn(QVBoxLayout* column, const char* name, const QString& words,
                      const QString& tip) {
  auto* button = new QPushButton(words);
  button->setObjectName(QString::fromUtf8(name));
  button->setToolTip(tip);
  column->addWidget(button);
  return button;
}

QLabel* quietIn(QVBoxLayout* column, const char* name) {
  auto* label = new QLabel;
  label->setObjectName(QString::fromUtf8(name));
  label->setWordWrap(true);
  label->setProperty("quiet", true);
  column->addWidget(label);
  return label;
}

} // namespace

AlignPanel::AlignPanel(QWidget* parent) : QWidget(parent) {
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->setSpacing(4);

  auto* path = new QGroupBox(tr("Path"));
  auto* column = columnIn(path);
  path_ = new ElidedLabel(path);
  path_->setObjectName(QStringLiteral("align_path"));
  column->addWidget(path_);
  buttonIn(column, "align_open", tr("Open path…"),
           tr("A path.csv of a scan; a scan that is open on the desk Scan brings its own"));
  connect(path->findChild<QPushButton*>(), &QPushButton::clicked, this, &AlignPanel::openAsked);
  scans_ = new QComboBox(path);
  scans_->setObjectName(QStringLiteral("align_scan"));
  scans_->setToolTip(tr("Scans of the workspace that have a path; one that was laid onto the mesh "
                        "lies where it was"));
  column->addWidget(scans_);
  store_ = buttonIn(column, "align_store", tr("Put into workspace"),
                    tr("The path and where it lies become part of the scene: saved with it, and "
                       "undone like any edit"));
  keep_ = buttonIn(column, "align_keep", tr("Keep…"),
                   tr("Writes the path in the mesh's frame, and the pose beside it as a text file "
                      "that `patina register --initial` reads"));
  all->addWidget(path);

  auto* place = new QGroupBox(tr("Place on the mesh"));
  column = columnIn(place);
  auto* form = new Form(place);
  constexpr const char* kNames[] = {"align_x", "align_y", "align_z",
                                    "align_a", "align_b", "align_c"};
  const QString words[] = {tr("Shift x"),      tr("Shift y"),      tr("Shift z"),
                           tr("Turn about x"), tr("Turn about y"), tr("Turn about z")};
  for (std::size_t i = 0; i < 6; ++i) {
    const bool turns = i >= 3;
    const RowRange range = turns ? RowRange{-180, 180, 1, 2} : RowRange{-9999, 9999, 0.5, 2};
    rows_[i] = form->addRow({kNames[i], words[i], turns ? QStringLiteral("°") : tr("mm"), range, 1,
                             turns ? tr("About the mesh's fixed axes: first x, then y, then z")
                                   : tr("Along the mesh's axis")},
                            0, [this](double) { emit edited(values()); });
  }
  column->addWidget(form);
  pick_ = buttonIn(column, "align_pick", tr("Three points"),
                   tr("Click a place on the path, then the same on the mesh, three times"));
  pick_->setCheckable(true);
  hint_ = quietIn(column, "align_hint");
  fit_ = buttonIn(column, "align_fit", tr("Fit from here"),
                  tr("Finds the nearest good fit by least squares, as `patina register` does"));
  fit_->setDefault(true);
  begin_ = buttonIn(column, "align_begin", tr("Middle on middle"),
                    tr("As at the beginning; can be undone"));
  all->addWidget(place);
  place_ = place;

  auto* error = new QGroupBox(tr("Distance from the surface"));
  column = columnIn(error);
  off_ = quietIn(column, "align_error");
  off_->setProperty("quiet", false);
  fit_words_ = quietIn(column, "align_found");
  lines_ = new QCheckBox(error);
  lines_->setObjectName(QStringLiteral("align_lines"));
  lines_->setToolTip(
      tr("From the surface towards each sample that counts, coloured by its distance; "
         "short ones are drawn longer, by the number that stands here"));
  map_ = new QCheckBox(tr("Error map"), error);
  map_->setObjectName(QStringLiteral("align_map"));
  map_->setToolTip(tr("The mean distance of the samples near each place of the mesh; grey where "
                      "none came"));
  for (QCheckBox* box : {lines_, map_}) {
    column->addWidget(box);
    connect(box, &QCheckBox::toggled, this, &AlignPanel::shownChanged);
  }
  all->addWidget(error);
  error_ = error;

  connect(store_, &QPushButton::clicked, this, &AlignPanel::storeAsked);
  connect(scans_, qOverload<int>(&QComboBox::activated), this, [this](int row) {
    if (row > 0) emit scanChosen(scans_->itemText(row));
    scans_->setCurrentIndex(0);
  });
  connect(keep_, &QPushButton::clicked, this, &AlignPanel::keepAsked);
  connect(pick_, &QPushButton::toggled, this, &AlignPanel::pickToggled);
  connect(fit_, &QPushButton::clicked, this, &AlignPanel::fitAsked);
  connect(begin_, &QPushButton::clicked, this, &AlignPanel::beginAsked);
  setScans({});
  setPath({}, 0);
  setReady(false, false);
  setPicking({});
  setFit({});
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
  path_->setText(samples == 0 ? tr("No path is open")
                              : tr("%1: %2 samples in contact")
                                    .arg(name, QString::fromStdString(formatCount(samples))));
}

void AlignPanel::setReady(bool ready, bool works) {
  place_->setVisible(ready);
  error_->setVisible(ready);
  keep_->setVisible(ready);
  store_->setVisible(ready);
  for (QWidget* each :
       {static_cast<QWidget*>(pick_), static_cast<QWidget*>(fit_), static_cast<QWidget*>(begin_),
        static_cast<QWidget*>(keep_), static_cast<QWidget*>(store_)})
    each->setEnabled(!works);
}

void AlignPanel::setValues(const PoseValues& values, double reach) {
  for (std::size_t i = 0; i < 6; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    if (i < 3) rows_[i]->setReach(1e3 * reach);
    rows_[i]->setValue(i < 3 ? values.position_mm[axis] : values.angles_deg[axis]);
  }
}

void AlignPanel::setResiduals(const Residuals& residuals) {
  off_->setText(
      tr("All samples: mean %1 · rms %2 · worst %3")
          .arg(inWords(residuals.mean), inWords(residuals.rms), inWords(residuals.worst)));
}

void AlignPanel::setStretch(double times) {
  lines_->setText(times > 1 ? tr("Lines to the surface × %1").arg(times, 0, 'g', 4)
                            : tr("Lines to the surface"));
}

void AlignPanel::setFit(const QString& words) {
  fit_words_->setText(words);
  fit_words_->setVisible(!words.isEmpty());
}

void AlignPanel::setPicking(const QString& words) {
  const QSignalBlocker quiet(pick_);
  pick_->setChecked(!words.isEmpty());
  hint_->setText(words);
  hint_->setVisible(!words.isEmpty());
}

} // namespace patina
