#include "app/gui/painting/paint_display.h"

#include <algorithm>
#include <cmath>

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>

namespace patina {
namespace {

QString caption(PaintQuantity quantity) {
  if (const auto channel = channelOf(quantity)) return captionOf(Tool::material(*channel));
  return captionOf(quantity == PaintQuantity::color ? Tool::color : Tool::relief);
}

// The unit that a person reads, fixed for a quantity: a field must not change it under the hand.
ChannelReading reading(PaintQuantity quantity) {
  if (const auto channel = channelOf(quantity)) return rowOf(*channel).reading;
  return quantity == PaintQuantity::relief ? ChannelReading{"mm", 1e3, 3}
                                           : ChannelReading{"", 1, 3};
}

constexpr int kFollows = 0, kNothing = 1, kFirst = 2;

} // namespace

PaintDisplay::PaintDisplay(QWidget* parent)
    : QWidget(parent), combo_(new QComboBox(this)), range_row_(new QWidget(this)),
      lock_(new QCheckBox(tr("Lock"), range_row_)), low_(new QDoubleSpinBox(range_row_)),
      high_(new QDoubleSpinBox(range_row_)) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 4, 0, 0);
  grid->setVerticalSpacing(4);
  auto* label = new QLabel(tr("Paint"), this);
  label->setProperty("quiet", true);
  grid->addWidget(label, 0, 0);
  combo_->setObjectName(QStringLiteral("paint_shown"));
  combo_->setToolTip(tr("What of the paint is seen"));
  grid->addWidget(combo_, 0, 1);
  grid->setColumnStretch(1, 1);
  auto* line = new QHBoxLayout(range_row_);
  line->setContentsMargins(0, 0, 0, 0);
  lock_->setObjectName(QStringLiteral("lock_range"));
  lock_->setToolTip(tr("Keep the colours' range as it is while painting goes on"));
  for (QDoubleSpinBox* number : {low_, high_}) {
    number->setKeyboardTracking(false);
    number->setToolTip(tr("Where the colours of the scale begin and end, while they are locked"));
    number->setRange(-1e6, 1e6);
    number->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    connect(number, qOverload<double>(&QDoubleSpinBox::valueChanged), this, [this] { sendLock(); });
  }
  low_->setObjectName(QStringLiteral("range_low"));
  high_->setObjectName(QStringLiteral("range_high"));
  line->addWidget(lock_);
  line->addWidget(low_, 1);
  line->addWidget(high_, 1);
  grid->addWidget(range_row_, 1, 0, 1, 2);
  connect(combo_, qOverload<int>(&QComboBox::activated), this, [this] { decide(); });
  connect(lock_, &QCheckBox::toggled, this, [this](bool on) {
    if (shown_) locked_[static_cast<std::size_t>(*shown_)] = on;
    low_->setEnabled(on);
    high_->setEnabled(on);
    sendLock();
  });
  setAvailable({});
}

bool PaintDisplay::has(PaintQuantity quantity) const {
  return std::find(available_.begin(), available_.end(), quantity) != available_.end();
}

void PaintDisplay::setAvailable(const std::vector<PaintQuantity>& quantities) {
  if (combo_->count() > 0 && quantities == available_) return;
  const int before = combo_->currentIndex();
  std::optional<PaintQuantity> chosen;
  if (before >= kFirst) chosen = available_[static_cast<std::size_t>(before - kFirst)];
  available_ = quantities;
  {
    const QSignalBlocker quiet(combo_);
    combo_->clear();
    combo_->addItem(tr("as the tool"));
    combo_->addItem(tr("nothing"));
    for (const PaintQuantity quantity : available_) combo_->addItem(caption(quantity));
    int now = before == kNothing ? kNothing : kFollows;
    for (std::size_t i = 0; i < available_.size(); ++i)
      if (available_[i] == chosen) now = kFirst + static_cast<int>(i);
    combo_->setCurrentIndex(now);
  }
  decide();
}

void PaintDisplay::setTool(const ToolChoice& choice) {
  tool_ = choice;
  decide();
}

void PaintDisplay::decide() {
  const int index = combo_->currentIndex();
  std::optional<PaintQuantity> now;
  if (index >= kFirst) {
    now = available_[static_cast<std::size_t>(index - kFirst)];
  } else if (index == kFollows && !available_.empty()) {
    now = quantityOf(tool_);
    // A tool that has painted nothing yet is seen as soon as it has; else what was seen stays.
    if (!now || !has(*now)) now = shown_ && has(*shown_) ? *shown_ : available_.front();
  }
  const bool scalar = now && *now != PaintQuantity::color;
  range_row_->setVisible(scalar);
  if (now == shown_) return;
  shown_ = now;
  if (scalar) {
    const ChannelReading read = reading(*now);
    const std::string suffix = read.unit.empty() ? "" : " " + std::string(read.unit);
    const QSignalBlocker quiet(lock_), quiet_low(low_), quiet_high(high_);
    per_si_ = read.per_si;
    for (QDoubleSpinBox* number : {low_, high_}) {
      number->setSuffix(QString::fromStdString(suffix));
      number->setDecimals(read.decimals);
      number->setEnabled(locked_[static_cast<std::size_t>(*now)]);
    }
    lock_->setChecked(locked_[static_cast<std::size_t>(*now)]);
  }
  emit showAsked(shown_);
}

void PaintDisplay::setRange(const ValueRange& range) {
  if (low_->isEnabled()) return; // a person's own
  const QSignalBlocker quiet_low(low_), quiet_high(high_);
  low_->setValue(range.low * per_si_);
  high_->setValue(range.high * per_si_);
}

void PaintDisplay::sendLock() {
  if (!shown_) return;
  if (!lock_->isChecked()) return emit lockAsked(*shown_, std::nullopt);
  if (low_->value() < high_->value())
    emit lockAsked(*shown_, ValueRange{low_->value() / per_si_, high_->value() / per_si_});
}

} // namespace patina
