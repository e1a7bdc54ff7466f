#include "app/gui/panels/value_row.h"

#include <algorithm>
#include <cmath>

#include <QGridLayout>
#include <QSignalBlocker>

#include "app/gui/widgets/elided_label.h"
#include "app/gui/widgets/words.h"

namespace patina {
namespace {
constexpr int kSteps = 1000;

class NumberBox : public QDoubleSpinBox {
 public:
  using QDoubleSpinBox::QDoubleSpinBox;
  QString textFromValue(double value) const override {
    return QDoubleSpinBox::textFromValue(shownAs(value, decimals()));
  }
};

} // namespace

ValueRow::ValueRow(const QString& caption, const QString& unit, const RowRange& range,
                   QWidget* parent)
    : QWidget(parent), range_(range), slider_(new QSlider(Qt::Horizontal, this)),
      number_(new NumberBox(this)), cross_(new QToolButton(this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(6);
  layout->setVerticalSpacing(1);
  auto* label = new ElidedLabel(this);
  label->setText(caption);
  label->setProperty("quiet", true);
  auto* top = new QHBoxLayout;
  top->addWidget(label, 1);
  layout->addLayout(top, 0, 0, 1, 2);
  cross_->setText(QStringLiteral("✕"));
  cross_->setAutoRaise(true);
  cross_->setVisible(false);
  cross_->setFixedSize(18, 18);
  top->addWidget(cross_);
  layout->addWidget(slider_, 1, 0);
  layout->addWidget(number_, 1, 1);
  layout->setColumnStretch(0, 1);
  slider_->setRange(0, kSteps);
  number_->setRange(range.low, range.high);
  number_->setDecimals(range.decimals);
  number_->setSingleStep(range.step);
  number_->setSuffix(unit.isEmpty() ? QString() : QStringLiteral(" ") + unit);
  number_->setKeyboardTracking(false);
  number_->setMinimumWidth(96);
  number_->setAccessibleName(caption);
  slider_->setAccessibleName(caption);

  connect(slider_, &QSlider::valueChanged, this, [this](int position) {
    const QSignalBlocker quiet(number_);
    number_->setValue(fromSlider(position));
    emit edited(number_->value());
  });
  connect(number_, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this](double value) {
    const QSignalBlocker quiet(slider_);
    slider_->setValue(toSlider(value));
    emit edited(value);
  });
  connect(cross_, &QToolButton::clicked, this, &ValueRow::removed);
}

int ValueRow::toSlider(double value) const {
  const double v = std::clamp(value, range_.low, range_.high);
  const double fraction = range_.logarithmic
                              ? std::log(v / range_.low) / std::log(range_.high / range_.low)
                              : (v - range_.low) / (range_.high - range_.low);
  return static_cast<int>(std::lround(kSteps * fraction));
}

double ValueRow::fromSlider(int position) const {
  const double fraction = static_cast<double>(position) / kSteps;
  return range_.logarithmic ? range_.low * std::pow(range_.high / range_.low, fraction)
                            : range_.low + fraction * (range_.high - range_.low);
}

void ValueRow::setValue(double value) {
  const QSignalBlocker quiet_number(number_), quiet_slider(slider_);
  number_->setValue(value);
  slider_->setValue(toSlider(value));
}

void ValueRow::setReach(double reach) {
  range_.low = -reach;
  range_.high = reach;
}

void ValueRow::setRemovable(const QString& tip) {
  cross_->setToolTip(tip);
  cross_->setVisible(true);
}

void takeAway(QWidget* rows) {
  if (rows == nullptr) return;
  rows->hide();
  rows->setParent(nullptr);
  rows->deleteLater();
}

} // namespace patina
