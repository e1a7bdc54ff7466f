#include "app/gui/panels/form.h"

#include <utility>

#include <QLabel>

namespace patina {

Form::Form(QWidget* parent) : QWidget(parent), grid_(new QGridLayout(this)) {
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setVerticalSpacing(6);
  grid_->setColumnStretch(1, 1);
}

ValueRow* Form::addRow(const RowSpec& spec, double now, std::function<void(double)> set) {
  auto* row = new ValueRow(spec.caption, spec.unit, spec.range, this);
  row->setObjectName(QString::fromUtf8(spec.name));
  row->setValue(spec.per_si * now);
  row->setToolTip(spec.tip);
  addWidget(row);
  connect(row, &ValueRow::edited, this,
          [this, per_si = spec.per_si, set = std::move(set)](double value) {
            set(value / per_si);
            emit edited();
          });
  return row;
}

ValueRow* Form::addRow(const RowSpec& spec, double& value) {
  return addRow(spec, value, [&value](double now) { value = now; });
}

void Form::addCheck(const char* name, const QString& words, const QString& tip, bool now,
                    std::function<void(bool)> set) {
  auto* box = new QCheckBox(words, this);
  box->setObjectName(QString::fromUtf8(name));
  box->setToolTip(tip);
  box->setChecked(now);
  addWidget(box);
  connect(box, &QCheckBox::toggled, this, [this, set = std::move(set)](bool on) {
    set(on);
    emit edited();
  });
}

void Form::addChoice(const char* name, const QString& caption, const QStringList& words, int now,
                     std::function<void(int)> set, const QString& tip) {
  auto* label = new QLabel(caption, this);
  label->setProperty("quiet", true);
  auto* combo = new QComboBox(this);
  combo->setObjectName(QString::fromUtf8(name));
  combo->setAccessibleName(caption);
  combo->addItems(words);
  combo->setCurrentIndex(now);
  combo->setToolTip(tip);
  const int row = grid_->rowCount();
  grid_->addWidget(label, row, 0);
  grid_->addWidget(combo, row, 1);
  connect(combo, qOverload<int>(&QComboBox::activated), this,
          [this, set = std::move(set)](int index) {
            set(index);
            emit edited();
          });
}

} // namespace patina
