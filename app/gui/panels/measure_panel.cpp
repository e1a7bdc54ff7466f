#include "app/gui/panels/measure_panel.h"

#include <algorithm>

#include <QHBoxLayout>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

constexpr double kPatchShare = 0.1; // Radius of a patch to be fitted, as a share of the scene.

} // namespace

MeasurePanel::MeasurePanel(QWidget* parent)
    : QGroupBox(parent), kind_(new QComboBox(this)),
      radius_(new ValueRow(tr("Patch radius"), QStringLiteral("mm"), {0.001, 1000, 0.5, 3, true},
                           this)) {
  auto* column = layoutIn<QVBoxLayout>(this, 4);
  kind_->addItems({tr("Distance"), tr("Angle"), tr("Radius of a sphere"),
                   tr("Radius of a cylinder"), tr("Painted area")});
  column->addWidget(named(kind_, "measure_kind", tr("What the next clicks measure")));
  column->addWidget(named(radius_, "measure_radius",
                          tr("The sphere or cylinder is fitted to the vertices this near to the "
                             "click, up to creases")));
  next_ = addNote(column, "measure_next");
  results_ = addList(column, "measurements", tr("Measurements; a new surface removes them"));
  pins_ = addList(column, "pins", tr("The scene's pins and their values"));
  auto* line = new QHBoxLayout;
  column->addLayout(line);
  clear_ = addButton(line, "measure_clear", {}, {}, this, &MeasurePanel::cleared);
  remove_ =
      addButton(line, "pin_remove", tr("Remove"), tr("Removes the selected pin"), this, [this] {
        if (pins_->currentRow() >= 0) emit pinRemoved(pins_->currentRow());
      });
  connect(pins_, &QListWidget::currentRowChanged, remove_,
          [this](int row) { remove_->setEnabled(row >= 0); });
  export_ = addButton(line, "pins_export", tr("Export…"), tr("Pins and all their values as CSV"),
                      this, &MeasurePanel::exportRequested);
  line->addStretch(1);
  connect(kind_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this] {
    setNext(0);
    arrange();
    emit kindChosen();
  });
  setBusy(false);
  setResults({});
  remove_->setEnabled(false);
  setMode(mode_);
}

void MeasurePanel::setMode(InteractionMode mode) {
  mode_ = mode;
  setTitle(mode == InteractionMode::pin ? tr("Pins") : tr("Measure"));
  setNext(0);
  arrange();
}

void MeasurePanel::setExtent(double extent) {
  radius_->setValue(1e3 * kPatchShare * extent);
}

void MeasurePanel::setNext(int done) {
  const QString points[] = {tr("Click the first point."), tr("Click the second point."),
                            tr("Click the third point; the angle is at the second.")};
  if (mode_ == InteractionMode::pin) return say(next_, tr("Click a point to pin its values."));
  if (kind() == MeasureKind::area) return say(next_, tr("Click a painted patch."));
  if (kind() > MeasureKind::angle) return say(next_, tr("Click the middle of the patch."));
  say(next_, points[done] + tr(" Near a vertex the vertex is taken."));
}

void MeasurePanel::setBusy(bool on) {
  busy_ = on;
  clear_->setText(on ? tr("Stop") : tr("Clear"));
  clear_->setToolTip(on ? tr("Stops the measurement that is being made")
                        : tr("Removes all measurements"));
  arrange();
}

void MeasurePanel::setResults(const QStringList& results) {
  fillList(results_, results);
  arrange();
}

void MeasurePanel::setPins(const QStringList& pins) {
  if (pins == shown_pins_) return;
  const auto chosen = pins_->currentRow() < 0 ? QString() : shown_pins_.at(pins_->currentRow());
  shown_pins_ = pins;
  fillList(pins_, pins);
  pins_->setCurrentRow(static_cast<int>(pins.indexOf(chosen))); // -1: it is gone
  remove_->setEnabled(pins_->currentRow() >= 0);
  arrange();
}

void MeasurePanel::arrange() {
  const bool measures = mode_ == InteractionMode::measure;
  kind_->setVisible(measures);
  radius_->setVisible(measures &&
                      (kind() == MeasureKind::sphere || kind() == MeasureKind::cylinder));
  results_->setVisible(measures && results_->count() > 0);
  clear_->setVisible(busy_ || (measures && results_->count() > 0));
  for (QWidget* widget : {static_cast<QWidget*>(pins_), static_cast<QWidget*>(remove_),
                          static_cast<QWidget*>(export_)})
    widget->setVisible(!measures && pins_->count() > 0);
}

} // namespace patina
