#include "app/gui/panels/strip_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QMouseEvent>
#include <QPainter>
#include <QVBoxLayout>
#include <QWheelEvent>

#include "app/gui/widgets/drawn_icon.h"
#include "app/gui/widgets/graph.h"
#include "app/gui/widgets/words.h"
#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr double kSpan = 5;         // [s]
constexpr double kStripKept = 60;   // [s], to be looked at when it is held
constexpr double kLeastSpan = 0.05; // [s]
constexpr double kEvery = 0.004;    // [s]: 250 points a second are more than pixels
constexpr float kNothing = 1e-6F;   // in the unit of the plot

QIcon pauseIcon() {
  return drawnIcon([](QPainter& painter) {
    painter.drawLine(QPointF(7, 5), QPointF(7, 15));
    painter.drawLine(QPointF(13, 5), QPointF(13, 15));
  });
}

QString withMinus(QString words) {
  return words.replace('-', QStringLiteral("−"));
}

} // namespace

StripPlot::StripPlot(const QString& unit, std::vector<StripCurve> curves, double least_top,
                     QWidget* parent)
    : QWidget(parent), unit_(unit), curves_(std::move(curves)), least_top_(least_top),
      corner_(new QHBoxLayout), holds_(new QToolButton(this)), top_(least_top) {
  setMinimumHeight(110);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setFocusPolicy(Qt::StrongFocus);
  holds_->setObjectName(QStringLiteral("hold"));
  holds_->setIcon(pauseIcon());
  holds_->setCheckable(true);
  holds_->setToolTip(
      tr("<b>Hold</b> (Space)<br>What comes meanwhile is kept and recorded. The wheel "
         "zooms, a drag shifts, a double click follows again."));
  connect(holds_, &QToolButton::toggled, this, &StripPlot::hold);
  corner_->addStretch(1);
  corner_->addWidget(holds_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 1, 12, 0);
  column->addLayout(corner_);
  column->addStretch(1);
  column->setSizeConstraint(QLayout::SetNoConstraint);
}

void StripPlot::addToCorner(QWidget* widget) {
  corner_->insertWidget(corner_->count() - 1, widget);
}

void StripPlot::hold(bool holds) {
  holds_->setChecked(holds);
  if (holds == held_.has_value()) return;
  held_now_ = latest_;
  held_ = holds ? std::optional(points_) : std::nullopt;
  seen_.reset();
  dirty_ = true;
  quiet_ = false;
}

AxisSpan StripPlot::seen() const {
  return seen_.value_or(AxisSpan{now() - kSpan, now()});
}

AxisSpan StripPlot::whole() const {
  const double first = shown().empty() ? now() : shown().front().t;
  return {std::min(first, now() - kSpan), now()};
}

QRectF StripPlot::area() const {
  const int line = QFontMetrics(font()).height();
  return {58., line + 10., width() - 74., height() - 2. * line - 20};
}

bool StripPlot::wheel(const QWheelEvent& event) {
  hold(true);
  const QRectF place = area();
  const double part = std::clamp((event.position().x() - place.left()) / place.width(), 0., 1.);
  const AxisSpan now = seen();
  seen_ = zoomed(whole(), now, now.from + part * now.length(), event.angleDelta().y() / 120.,
                 kLeastSpan);
  update();
  return true;
}

bool StripPlot::drag(const QMouseEvent& event) {
  const int by = event.x() - *dragged_from_;
  if (by == 0) return true;
  hold(true);
  seen_ = shifted(whole(), seen(), -by * seen().length() / area().width());
  dragged_from_ = event.x();
  update();
  return true;
}

bool StripPlot::event(QEvent* event) {
  switch (event->type()) {
  case QEvent::Wheel:
    event->accept();
    return wheel(*static_cast<QWheelEvent*>(event));
  case QEvent::MouseButtonPress:
    if (static_cast<QMouseEvent*>(event)->button() != Qt::LeftButton) break;
    dragged_from_ = static_cast<QMouseEvent*>(event)->x();
    return true;
  case QEvent::MouseMove:
    if (!dragged_from_) break;
    return drag(*static_cast<QMouseEvent*>(event));
  case QEvent::MouseButtonRelease:
    dragged_from_.reset();
    return true;
  case QEvent::MouseButtonDblClick:
    hold(false);
    return true;
  case QEvent::ShortcutOverride: // it is the camera's elsewhere
    if (static_cast<QKeyEvent*>(event)->key() != Qt::Key_Space) break;
    event->accept();
    return true;
  case QEvent::KeyPress:
    if (static_cast<QKeyEvent*>(event)->key() != Qt::Key_Space) break;
    hold(!held_);
    return true;
  default:
    break;
  }
  return QWidget::event(event);
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
  while (points_.front().t < latest_ - kStripKept) points_.pop_front();
}

float StripPlot::size(const Point& point) const {
  float largest = 0;
  for (std::size_t c = 0; c < curves_.size(); ++c)
    largest = std::max(largest, std::abs(point.value[c]));
  return largest;
}

void StripPlot::refresh() {
  if (!dirty_) return;
  dirty_ = false;
  if (held_) return update();
  // Once a line without news goes from edge to edge.
  const double from = latest_ - kSpan;
  const bool full = !points_.empty() && points_.front().t < from + 2 * kEvery;
  const bool quiet = full && std::all_of(points_.rbegin(), points_.rend(), [&](const Point& p) {
                       return p.t < from || size(p) < kNothing;
                     });
  if (quiet && quiet_) return;
  quiet_ = quiet;
  update();
}

// Steps of 1, 2, 5, held until the plot would be less than a quarter full while it follows: what a
// person looks up has one scale, however it was come to.
double StripPlot::top() const {
  double highest = 0;
  const AxisSpan span = seen();
  for (const Point& point : shown())
    if (point.t >= span.from && point.t <= span.to)
      highest = std::max(highest, static_cast<double>(size(point)));
  double step = least_top_;
  while (step < 1.05 * highest) {
    const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    step *= digit > 1.9 && digit < 2.1 ? 2.5 : 2;
  }
  return !seen_ && step < top_ && highest > 0.25 * top_ ? top_ : step;
}

double StripPlot::toX(const QRectF& area, double t) const {
  const AxisSpan span = seen();
  return area.left() + (t - span.from) / span.length() * area.width();
}

double StripPlot::toY(const QRectF& area, double value) const {
  return area.center().y() - value / top_ * area.height() / 2;
}

void StripPlot::paintAxes(QPainter& painter, const QRectF& area) const {
  const int line = QFontMetrics(font()).height();
  painter.setPen(ink("quiet"));
  painter.drawText(QRectF(0, area.top(), 26, area.height()), Qt::AlignCenter, unit_);
  for (const double value : {-top_, -0.5 * top_, 0.0, 0.5 * top_, top_}) {
    const double y = toY(area, value);
    painter.setPen(value == 0 ? ink("grip") : ink("line"));
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(14, y - 8, 38, 16), Qt::AlignRight | Qt::AlignVCenter,
                     withMinus(QString::number(value, 'g', 3)));
  }
  const AxisSpan span = seen();
  const double step = stepFor(span.length(), 6);
  for (double back = std::ceil((now() - span.to) / step - 1e-9) * step;
       back <= now() - span.from + 1e-9 * step; back += step) {
    const double x = toX(area, now() - back);
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(ink("quiet"));
    const QString words = back < 1e-9 ? (held_ ? tr("held") : tr("now"))
                                      : QStringLiteral("−%1 s").arg(back, 0, 'g', 4);
    painter.drawText(QRectF(x - 36, area.bottom() + 3, 72, line), Qt::AlignCenter, words);
  }
}

// Room for a longer number than there is, so that the next name does not dance.
int StripPlot::legendWidth(std::size_t curve) const {
  return 29 + QFontMetrics(font()).horizontalAdvance(
                  QStringLiteral("%1 −00.00 %2").arg(curves_[curve].name, unit_));
}

QSize StripPlot::minimumSizeHint() const {
  int wide = 58 + 16 + (layout() != nullptr ? layout()->minimumSize().width() : 0);
  for (std::size_t c = 0; c < curves_.size(); ++c) wide += legendWidth(c);
  return {wide, 110};
}

void StripPlot::paintLegend(QPainter& painter, const QRectF& area) const {
  const QFontMetrics metrics(font());
  const double middle = 4 + metrics.height() / 2.0;
  double x = area.left();
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const double value = shown().empty() ? 0 : static_cast<double>(shown().back().value[c]);
    const QString words = withMinus(QStringLiteral("%1 %2 %3")
                                        .arg(curves_[c].name)
                                        .arg(shownAs(value, 2), 0, 'f', 2)
                                        .arg(unit_));
    painter.setPen(QPen(ink(curves_[c].ink), 3));
    painter.drawLine(QPointF(x, middle), QPointF(x + 12, middle));
    painter.setPen(ink("text"));
    painter.drawText(QPointF(x + 17, 4 + metrics.ascent()), words);
    x += legendWidth(c);
  }
}

void StripPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  top_ = top();
  const QRectF place = area();
  paintAxes(painter, place);

  painter.setClipRect(place.adjusted(0, -1, 0, 1));
  painter.setRenderHint(QPainter::Antialiasing);
  const AxisSpan span = seen();
  const double beside = 20 * kEvery; // the curve goes on to the edge
  // The first curve is the one that matters: it is drawn last.
  for (std::size_t c = curves_.size(); c-- > 0;) {
    QPolygonF curve;
    for (const Point& point : shown())
      if (point.t > span.from - beside && point.t < span.to + beside)
        curve << QPointF(toX(place, point.t), toY(place, point.value[c]));
    painter.setPen(QPen(ink(curves_[c].ink), curves_[c].width));
    painter.drawPolyline(curve);
  }
  painter.setClipping(false);
  paintLegend(painter, place);
}

} // namespace patina
