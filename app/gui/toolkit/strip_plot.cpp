#include "app/gui/toolkit/strip_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/drawn_icon.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

constexpr double kSpan = 5;        // [s]
constexpr double kStoredSpan = 60; // Stored for a held plot [s].
constexpr double kMinSpan = 0.05;  // [s]
constexpr double kEvery = 0.004;   // Enough for the number of pixels [s].
constexpr float kZero = 1e-6F;     // In the unit of the plot.

} // namespace

StripPlot::StripPlot(const QString& unit, std::vector<StripCurve> curves, double min_top,
                     QWidget* parent)
    : PlotWidget(parent), unit_(unit), curves_(std::move(curves)), min_top_(min_top),
      corner_(new QHBoxLayout), holds_(new QToolButton(this)), top_(min_top) {
  setFocusPolicy(Qt::StrongFocus);
  named(holds_, "hold",
        tr("<b>Hold</b> (Space)<br>Holds the picture while recording goes on. The wheel zooms, a "
           "drag shifts, a double click follows again."));
  holds_->setIcon(drawnIcon("line 7 5 7 15; line 13 5 13 15"));
  holds_->setCheckable(true);
  connect(holds_, &QToolButton::toggled, this, &StripPlot::hold);
  connect(this, &PlotWidget::viewChanged, this, [this](bool chosen) {
    hold(chosen);
    describe();
  });
  corner_->addStretch(1);
  corner_->addWidget(holds_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 1, 12, 0);
  column->addLayout(corner_);
  column->addStretch(1);
  column->setSizeConstraint(QLayout::SetNoConstraint);
  describe();
}

void StripPlot::hold(bool holds) {
  holds_->setChecked(holds);
  if (holds == held_.has_value()) return;
  held_now_ = latest_;
  held_ = holds ? std::optional(points_) : std::nullopt;
  if (!holds) resetView();
  quiet_ = false;
  describe();
}

bool StripPlot::event(QEvent* event) {
  // Elsewhere the camera takes the key.
  const bool asks = event->type() == QEvent::ShortcutOverride;
  if ((asks || event->type() == QEvent::KeyPress) &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space) {
    asks ? event->accept() : hold(!held_);
    return true;
  }
  return PlotWidget::event(event);
}

void StripPlot::clear() {
  hold(false);
  points_.clear();
  dirty_ = true;
}

void StripPlot::add(double t, const Values& values) {
  latest_ = t;
  dirty_ = dirty_ || !held_;
  if (points_.empty() || t >= points_.back().t + kEvery) {
    points_.push_back({t, values});
  } else {
    for (std::size_t c = 0; c < curves_.size(); ++c)
      if (curves_[c].keeps_peak)
        points_.back().value[c] = std::max(points_.back().value[c], values[c]);
  }
  while (points_.front().t < latest_ - kStoredSpan) points_.pop_front();
}

float StripPlot::size(const Point& point) const {
  float largest = 0;
  for (std::size_t c = 0; c < curves_.size(); ++c)
    largest = std::max(largest, std::abs(point.value[c]));
  return largest;
}

void StripPlot::refresh() {
  if (!dirty_ || !isVisible()) return;
  dirty_ = false;
  // A constant zero line needs no repaint.
  const double from = latest_ - kSpan;
  const bool full = !points_.empty() && points_.front().t < from + 2 * kEvery;
  const bool quiet = full && std::all_of(points_.rbegin(), points_.rend(), [&](const Point& p) {
                       return p.t < from || size(p) < kZero;
                     });
  if (quiet && quiet_) return;
  quiet_ = quiet;
  describe();
}

// Steps of 1, 2 and 5. A following plot shrinks only if less than a quarter is used.
double StripPlot::top(const AxisSpan& span) const {
  double highest = 0;
  for (const Point& point : shown())
    if (point.t >= span.from && point.t <= span.to)
      highest = std::max(highest, static_cast<double>(size(point)));
  double step = min_top_;
  while (step < 1.05 * highest) {
    const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    step *= digit > 1.9 && digit < 2.1 ? 2.5 : 2;
  }
  return !held_ && step < top_ && highest > 0.25 * top_ ? top_ : step;
}

// Times are relative to the newest one.
void StripPlot::describe() {
  const double now = held_ ? held_now_ : latest_;
  PlotAxes axes{QStringLiteral("s"), unit_};
  axes.zero_words = held_ ? tr("held") : tr("now");
  axes.x = AxisSpan{shown().empty() ? -kSpan : std::min(shown().front().t - now, -kSpan), 0};
  axes.first_view = AxisSpan{-kSpan, 0};
  axes.min_view = kMinSpan;
  const AxisSpan view = chosenView().value_or(*axes.first_view);
  const AxisSpan span{now + view.from, now + view.to};
  top_ = top(span);
  axes.y = AxisSpan{-top_, top_};
  const double margin = 20 * kEvery; // Draws beyond the edge.
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const double newest = shown().empty() ? 0 : static_cast<double>(shown().back().value[c]);
    PlotCurve curve{curves_[c].name, curves_[c].color, {}, curves_[c].width};
    curve.value = withMinus(QStringLiteral("%1 %2").arg(shownAs(newest, 2), 0, 'f', 2).arg(unit_));
    curve.max_value = QStringLiteral("−00.00 ") + unit_;
    for (const Point& point : shown())
      if (point.t > span.from - margin && point.t < span.to + margin)
        curve.points << QPointF(point.t - now, static_cast<double>(point.value[c]));
    axes.curves.push_back(curve);
  }
  setContent({{axes}}, true);
}

} // namespace patina
