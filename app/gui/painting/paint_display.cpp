#include "app/gui/painting/paint_display.h"

#include <algorithm>

#include <QGridLayout>
#include <QSignalBlocker>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

QString caption(PaintQuantity quantity) {
  if (const auto channel = channelOf(quantity)) return captionOf(Tool::material(*channel));
  return captionOf(quantity == PaintQuantity::color ? Tool::color : Tool::relief);
}

constexpr int kFollows = 0, kFirst = 1;

} // namespace

PaintDisplay::PaintDisplay(QWidget* parent) : QWidget(parent), combo_(new QComboBox(this)) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(quietLabel(tr("Paint")), 0, 0);
  grid->addWidget(named(combo_, "paint_shown", tr("The paint that is shown")), 0, 1);
  grid->setColumnStretch(1, 1);
  connect(combo_, qOverload<int>(&QComboBox::activated), this, [this] { decide(); });
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
    for (const PaintQuantity quantity : available_) combo_->addItem(caption(quantity));
    int now = kFollows;
    for (std::size_t i = 0; i < available_.size(); ++i)
      if (available_[i] == chosen) now = kFirst + static_cast<int>(i);
    combo_->setCurrentIndex(now);
  }
  decide();
}

void PaintDisplay::decide() {
  const int index = combo_->currentIndex();
  std::optional<PaintQuantity> now;
  if (on_ && index >= kFirst) {
    now = available_[static_cast<std::size_t>(index - kFirst)];
  } else if (on_ && !available_.empty()) {
    now = quantityOf(tool_);
    // The display keeps what it shows, or takes the first kind, if there is no paint of the tool's.
    if (!now || !has(*now)) now = shown_ && has(*shown_) ? *shown_ : available_.front();
  }
  if (now == shown_) return;
  shown_ = now;
  emit showRequested(shown_);
}

} // namespace patina
