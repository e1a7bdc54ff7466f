#include "app/gui/panels/color_panel.h"

#include <algorithm>
#include <cmath>

#include <QFormLayout>
#include <QHBoxLayout>
#include <QPainter>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "scene/paint/channels.h"
#include "visualization/values/color_table.h"

namespace patina {
namespace {

enum RangeRule { kFree, kLocked, kPercentile };

// Caption and unit of a thing.
struct ThingWords {
  QString caption;
  DisplayUnit reading{"mm", 1e3, 3};
  bool has_map = true;
};

ThingWords wordsOfThing(const std::string& thing) {
  for (const Channel& row : kChannels)
    if (thing == row.key) return {tr(row.caption), row.reading};
  if (thing == "slice") return {tr("slice")};
  if (thing == "error") return {tr("error map")};
  if (thing == "relief") return {tr("relief")};
  return {thing == "iso" ? tr("iso-surface") : tr("mesh"), {}, false};
}

QIcon iconOfMap(ColorMap map) {
  QPixmap strip(48, 12);
  QPainter painter(&strip);
  const auto table = colorTable({.map = map}, StandardMap::diverging, {-1, 1});
  for (int x = 0; x < strip.width(); ++x) {
    double color[3];
    table->GetColor(2.0 * x / (strip.width() - 1) - 1, color);
    painter.fillRect(x, 0, 1, strip.height(), QColor::fromRgbF(color[0], color[1], color[2]));
  }
  painter.end();
  return QIcon(strip);
}

template <typename Number>
Number* quietNumber(Number* number, const char* name, const QString& tip) {
  named(number, name, tip);
  number->setKeyboardTracking(false);
  number->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  return number;
}

} // namespace

ColorPanel::ColorPanel(QWidget* parent)
    : QGroupBox(tr("Colours"), parent), map_(new QComboBox), range_(new QComboBox),
      reversed_(new QCheckBox(tr("Reversed"))), log_(new QCheckBox(tr("Log"))),
      symmetric_(new QCheckBox(tr("Symmetric"))), bands_(new QSpinBox), digits_(new QSpinBox),
      low_(new QDoubleSpinBox), high_(new QDoubleSpinBox), percentile_(new QDoubleSpinBox),
      opacity_(new ValueRow(tr("Opacity"), QStringLiteral("%"), {0, 100, 5, 0}, this)),
      map_card_(new QWidget(this)), numbers_(new QWidget) {
  auto* column = layoutIn<QVBoxLayout>(this, 4);
  auto* form = layoutIn<QFormLayout>(map_card_, 4);
  column->addWidget(map_card_);
  map_->setIconSize({48, 12});
  for (const auto& [map, words] : kColorMaps)
    map_->addItem(iconOfMap(map), map == ColorMap::standard ? tr("Standard") : shownText(words));
  form->addRow(quietLabel(tr("Map")),
               named(map_, "color_map", tr("Colour map; the standard one suits the quantity")));
  const auto line = [&](const QString& caption, std::initializer_list<QWidget*> widgets) {
    auto* row = new QHBoxLayout;
    for (QWidget* widget : widgets) row->addWidget(widget);
    form->addRow(caption.isEmpty() ? nullptr : quietLabel(caption), row);
  };
  quietNumber(bands_, "color_bands", tr("Number of colours; smooth: no bands"));
  bands_->setRange(1, 64);
  bands_->setSpecialValueText(tr("smooth"));
  line(tr("Bands"), {bands_, named(reversed_, "color_reversed", tr("Exchanges the map's ends"))});
  range_->addItems({tr("follows the values"), tr("locked"), tr("percentile")});
  line(tr("Range"),
       {named(range_, "color_range",
              tr("Range of the colours: all values, fixed, or without the share at both ends"))});
  auto* ends = layoutIn<QHBoxLayout>(numbers_);
  for (auto* number : {low_, high_}) {
    quietNumber(number, number == low_ ? "range_low" : "range_high",
                tr("End of the range; typing locks it"));
    number->setRange(-1e6, 1e6);
    ends->addWidget(number);
  }
  form->addRow(nullptr, numbers_);
  quietNumber(percentile_, "color_percentile", tr("Share of the values left out at each end"));
  percentile_->setRange(0, 49);
  percentile_->setDecimals(1);
  percentile_->setSuffix(QStringLiteral(" %"));
  form->addRow(nullptr, percentile_);
  line({}, {named(symmetric_, "color_symmetric", tr("Widens the range to be symmetric about 0")),
            named(log_, "color_log", tr("Logarithmic; needs values above 0"))});
  for (QComboBox* combo : {map_, range_}) { // The side panel is narrow.
    combo->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    combo->setMinimumContentsLength(8);
  }
  quietNumber(digits_, "color_digits", tr("Digits of the scale's numbers"));
  digits_->setRange(0, 9);
  digits_->setSpecialValueText(tr("automatic"));
  form->addRow(quietLabel(tr("Digits")), digits_);
  column->addWidget(named(opacity_, "color_opacity", tr("100 % hides what is behind")));

  connect(map_, qOverload<int>(&QComboBox::activated), this, [this](int row) {
    change([row](ColorScale& scale) { scale.map = kColorMaps[row].value; });
  });
  connect(reversed_, &QCheckBox::clicked, this,
          [this](bool on) { change([on](ColorScale& scale) { scale.reversed = on; }); });
  connect(log_, &QCheckBox::clicked, this,
          [this](bool on) { change([on](ColorScale& scale) { scale.logarithmic = on; }); });
  connect(symmetric_, &QCheckBox::clicked, this,
          [this](bool on) { change([on](ColorScale& scale) { scale.symmetric = on; }); });
  connect(bands_, qOverload<int>(&QSpinBox::valueChanged), this, [this](int count) {
    change([count](ColorScale& scale) { scale.bands = count < 2 ? 0 : count; });
  });
  connect(digits_, qOverload<int>(&QSpinBox::valueChanged), this, [this](int count) {
    change([count](ColorScale& scale) {
      scale.digits = count > 0 ? std::optional(count) : std::nullopt;
    });
  });
  const auto lock = [this](ColorScale& scale) {
    if (low_->value() < high_->value())
      scale.range = ValueRange{low_->value() / per_si_, high_->value() / per_si_};
    scale.percentile.reset();
  };
  for (auto* number : {low_, high_})
    connect(number, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
            [this, lock] { change(lock); });
  connect(range_, qOverload<int>(&QComboBox::activated), this, [this, lock](int rule) {
    change([&](ColorScale& scale) {
      scale.range.reset();
      scale.percentile.reset();
      if (rule == kLocked) lock(scale);
      if (rule == kPercentile) scale.percentile = 2;
    });
  });
  connect(percentile_, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
          [this](double share) { change([=](ColorScale& scale) { scale.percentile = share; }); });
  connect(opacity_, &ValueRow::edited, this, [this](double percent) {
    change([=](ColorScale& scale) { scale.opacity = percent / 100; });
  });
}

void ColorPanel::setThing(const std::string& thing) {
  const auto things = coloredThings();
  thing_ = std::find(things.begin(), things.end(), thing) != things.end() ? thing : "";
  if (thing_.empty()) return;
  const ThingWords words = wordsOfThing(thing_);
  setTitle(tr("Colours: %1").arg(words.caption));
  per_si_ = words.reading.display_per_si;
  decimals_ = words.reading.decimals;
  const QString unit = shownText(words.reading.unit);
  for (QDoubleSpinBox* number : {low_, high_}) {
    const QSignalBlocker quiet(number);
    number->setSuffix(unit.isEmpty() ? unit : QStringLiteral(" ") + unit);
    number->setDecimals(words.reading.decimals);
  }
  map_card_->setVisible(words.has_map);
  opacity_->setVisible(thing_ != "error");
  showScale();
}

void ColorPanel::setScales(const ColorScales& scales) {
  scales_ = scales;
  showScale();
}

void ColorPanel::showScale() {
  if (thing_.empty()) return;
  const ColorScale scale = scaleOf(scales_, thing_);
  const QSignalBlocker quiet_bands(bands_), quiet_digits(digits_), quiet_share(percentile_);
  for (std::size_t i = 0; i < std::size(kColorMaps); ++i)
    if (kColorMaps[i].value == scale.map) map_->setCurrentIndex(static_cast<int>(i));
  reversed_->setChecked(scale.reversed);
  log_->setChecked(scale.logarithmic);
  symmetric_->setChecked(scale.symmetric);
  bands_->setValue(std::max(1, scale.bands));
  digits_->setValue(scale.digits.value_or(0));
  range_->setCurrentIndex(scale.range ? kLocked : scale.percentile ? kPercentile : kFree);
  percentile_->setVisible(scale.percentile.has_value());
  percentile_->setValue(scale.percentile.value_or(2));
  if (scale.range) setNumbers(*scale.range, decimals_);
  const bool translucent = thing_ == "iso";
  opacity_->setValue(100 * scale.opacity.value_or(translucent ? 0.38 : 1));
}

void ColorPanel::setNumbers(const ValueRange& range, int decimals) {
  const QSignalBlocker quiet_low(low_), quiet_high(high_);
  for (QDoubleSpinBox* number : {low_, high_}) number->setDecimals(decimals);
  low_->setValue(range.low * per_si_);
  high_->setValue(range.high * per_si_);
}

void ColorPanel::setRange(const std::optional<ValueRange>& range) {
  // Large numbers have room for fewer digits.
  const double most = range ? per_si_ * std::max(std::abs(range->low), std::abs(range->high)) : 0;
  const int fewer = std::clamp(static_cast<int>(std::log10(std::max(most, 1.0))) - 1, 0, decimals_);
  if (!range || low_->hasFocus() || high_->hasFocus() || scaleOf(scales_, thing_).range) return;
  setNumbers(*range, decimals_ - fewer);
}

void ColorPanel::change(const std::function<void(ColorScale&)>& set) {
  if (thing_.empty()) return;
  ColorScale scale = scaleOf(scales_, thing_);
  set(scale);
  if (scale == scaleOf(scales_, thing_)) return;
  scales_[thing_] = scale;
  showScale();
  emit edited(thing_, scale);
}

} // namespace patina
