#include "app/gui/toolkit/form.h"

#include "app/gui/toolkit/card.h"

namespace patina {

Form::Form(QWidget* parent) : QWidget(parent), grid_(layoutIn<QGridLayout>(this)) {
  grid_->setColumnStretch(1, 1);
}

ValueRow* Form::addRow(const RowSpec& spec, double now, std::function<void(double)> set) {
  auto* row = named(new ValueRow(spec.caption, spec.unit, spec.range, this), spec.name, spec.tip);
  row->setValue(spec.display_per_si * now);
  addWidget(row);
  connect(row, &ValueRow::edited, this,
          [this, display_per_si = spec.display_per_si, set = std::move(set)](double value) {
            set(value / display_per_si);
            emit edited();
          });
  return row;
}

ValueRow* Form::addRow(const RowSpec& spec, double& value) {
  return addRow(spec, value, [&value](double now) { value = now; });
}

void Form::addCheck(const char* name, const QString& words, const QString& tip, bool now,
                    std::function<void(bool)> set) {
  auto* box = named(new QCheckBox(words, this), name, tip);
  box->setChecked(now);
  addWidget(box);
  connect(box, &QCheckBox::toggled, this, [this, set = std::move(set)](bool on) {
    set(on);
    emit edited();
  });
}

void Form::addChoice(const char* name, const QString& caption, const QStringList& words, int now,
                     std::function<void(int)> set, const QString& tip) {
  auto* combo = named(new QComboBox(this), name, tip);
  combo->setAccessibleName(caption);
  combo->addItems(words);
  combo->setCurrentIndex(now);
  const int row = grid_->rowCount();
  grid_->addWidget(quietLabel(caption), row, 0);
  grid_->addWidget(combo, row, 1);
  connect(combo, qOverload<int>(&QComboBox::activated), this,
          [this, set = std::move(set)](int index) {
            set(index);
            emit edited();
          });
}

} // namespace patina
