#include "app/gui/toolkit/plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QMouseEvent>
#include <QWheelEvent>

#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

constexpr double kNotch = 1.25;
constexpr int kMarksLine = 14, kRight = 12, kMinMargin = 42; // [px]
constexpr int kMinHeight = 110, kMinWidth = 96;              // [px]
constexpr int kDash = 12, kGap = 5, kApart = 12;             // Lengths in the legend [px].
constexpr double kNear = 6;                                  // Radius of a click on a mark [px].

// Returns 1, 2, 5, 10 and so on.
std::vector<double> roundIn(const AxisSpan& span) {
  std::vector<double> marks;
  if (!(span.from > 0)) return marks;
  for (double power = std::pow(10, std::floor(std::log10(span.from))); power <= span.to;
       power *= 10)
    for (const double digit : {1., 2., 5.})
      if (digit * power >= span.from && digit * power <= span.to) marks.push_back(digit * power);
  return marks;
}

AxisSpan logarithms(const AxisSpan& span) {
  return {std::log10(span.from), std::log10(span.to)};
}

QRectF boundsOf(const PlotAxes& axes) {
  QRectF box;
  for (const PlotCurve& curve : axes.curves) box = box.united(curve.points.boundingRect());
  return box;
}

QString levelWords(double level, double step, bool logarithmic) {
  const double value = logarithmic ? std::pow(10, level) : level;
  if (logarithmic && value < 1) return QString::number(value, 'g', 3);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return withMinus(QString::number(value, 'f', logarithmic ? 0 : decimals));
}

} // namespace

AxisSpan zoomed(const AxisSpan& whole, const AxisSpan& seen, double at, double notches,
                double min_length) {
  const double max_length = whole.length();
  const double length = std::clamp(seen.length() * std::pow(kNotch, -notches),
                                   std::min(min_length, max_length), max_length);
  const double part = (at - seen.from) / seen.length();
  return shifted(whole, {at - part * length, at + (1 - part) * length}, 0);
}

AxisSpan shifted(const AxisSpan& whole, const AxisSpan& seen, double by) {
  const double length = std::min(seen.length(), whole.length());
  const double from = std::clamp(seen.from + by, whole.from, whole.to - length);
  return {from, from + length};
}

double stepFor(double range, int count) {
  const double min_step = range / count, power = std::pow(10, std::floor(std::log10(min_step)));
  for (const double step : {1., 2., 5., 10.})
    if (step * power >= min_step) return step * power;
  return min_step;
}

std::vector<double> marksOf(const AxisSpan& span, int count, double min_step) {
  std::vector<double> marks;
  // Adding a step has no effect in a span of rounding errors.
  if (!(span.length() > 1e-9 * std::max(std::abs(span.from), std::abs(span.to)))) return marks;
  for (int max_count = count; marks.size() < 2 && max_count < count + 8; ++max_count) {
    const double step = std::max(stepFor(span.length(), max_count), min_step);
    marks.clear();
    for (double k = std::ceil(span.from / step - 1e-9); k * step <= span.to + 1e-9 * step; ++k)
      marks.push_back(k * step + 0.0); // Avoids -0.
  }
  return marks;
}

QString withMinus(QString number) {
  return number.replace('-', QStringLiteral("−"));
}

double PlotWidget::Frame::toX(double value) const {
  return area.left() +
         ((logarithmic ? std::log10(value) : value) - x.from) / x.length() * area.width();
}

double PlotWidget::Frame::toY(double value) const {
  return area.bottom() -
         ((logarithmic ? std::log10(value) : value) - y.from) / y.length() * area.height();
}

double PlotWidget::Frame::fromX(double pixel) const {
  const double value = x.from + (pixel - area.left()) / area.width() * x.length();
  return logarithmic ? std::pow(10, value) : value;
}

PlotWidget::PlotWidget(QWidget* parent) : QWidget(parent) {
  setAttribute(Qt::WA_OpaquePaintEvent);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setMouseTracking(true);
}

void PlotWidget::setContent(PlotContent content, bool keeps_view) {
  if (!keeps_view) {
    resetView();
    dragged_.reset();
  }
  content_ = std::move(content);
  update();
}

std::optional<AxisSpan> PlotWidget::chosenView() const {
  const auto chosen = chosen_.find(0);
  return chosen == chosen_.end() ? std::nullopt : std::optional(chosen->second);
}

void PlotWidget::moveInto(double x) {
  const auto chosen = chosen_.find(0);
  if (chosen == chosen_.end() || content_.axes.empty()) return;
  AxisSpan& view = chosen->second;
  if (x < view.from || x > view.to)
    view = shifted(frames()[0].all, view, x - 0.5 * (view.from + view.to));
}

QPoint PlotWidget::placeOf(double x) const {
  return content_.axes.empty() ? QPoint() : QPoint(qRound(frames()[0].toX(x)), kMarksLine / 2);
}

int PlotWidget::legendWidth(const PlotCurve& curve) const {
  return kDash + kGap + kApart +
         fontMetrics().horizontalAdvance(curve.name + ' ' + curve.max_value);
}

QSize PlotWidget::minimumSizeHint() const {
  if (content_.bare) return {kMinWidth, 0};
  int wide = 0;
  for (const PlotAxes& axes : content_.axes)
    for (const PlotCurve& curve : axes.curves)
      if (!curve.max_value.isEmpty()) wide += legendWidth(curve);
  return {kMinMargin + 4 + kRight + wide, kMinHeight};
}

PlotWidget::Frame PlotWidget::frameOf(const PlotAxes& axes, std::size_t view,
                                      int max_levels) const {
  Frame frame;
  const QRectF box = boundsOf(axes);
  frame.all = axes.x.value_or(AxisSpan{box.left(), box.right()});
  frame.y = axes.y.value_or(AxisSpan{box.top(), box.bottom()});
  frame.logarithmic = axes.spectrum;
  AxisSpan first = axes.first_view.value_or(frame.all);
  // Values that differ by rounding are drawn as equal.
  const double size = std::max(std::abs(frame.y.from), std::abs(frame.y.to));
  if (!(frame.y.length() > 1e-9 * size)) frame.y.to = frame.y.from + std::max(1e-9, size);
  if (axes.spectrum) {
    frame.all = logarithms(frame.all);
    first = logarithms(first);
    frame.y = logarithms(frame.y);
    frame.y.from = std::floor(frame.y.from);
    frame.y.to = std::max(frame.y.from + 1, std::ceil(frame.y.to));
  }
  const auto chosen = chosen_.find(view);
  frame.x = chosen == chosen_.end() ? first : chosen->second;
  if (frame.x.length() > 0) frame.levels = marksOf(frame.y, max_levels, axes.spectrum ? 1 : 0);
  return frame;
}

std::vector<PlotWidget::Frame> PlotWidget::frames() const {
  const QFontMetrics letters(font());
  const int line = letters.height();
  const auto count = static_cast<double>(content_.axes.size());
  const double lane = (height() - kMarksLine - line - 4) / std::max(1., count);
  const double high = content_.stacked ? lane - line : height() - 2 * line - 12;
  const int max_levels = std::clamp(static_cast<int>(high / line), 1, 4);
  std::vector<Frame> frames;
  double margin = kMinMargin;
  for (const PlotAxes& axes : content_.axes) {
    const Frame& frame =
        frames.emplace_back(frameOf(axes, content_.stacked ? 0 : frames.size(), max_levels));
    margin = std::max<double>(margin, letters.horizontalAdvance(axes.y_unit) + 4);
    for (const double level : frame.levels)
      if (frame.levels.size() > 1)
        margin = std::max<double>(
            margin, letters.horizontalAdvance(
                        levelWords(level, frame.levels[1] - frame.levels[0], frame.logarithmic)) +
                        4);
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame& frame = frames[i];
    const auto at = static_cast<double>(i);
    if (content_.stacked) {
      frame.whole = QRectF(0, kMarksLine + at * lane, width(), lane);
      frame.area = frame.whole.adjusted(margin + 4, line, -kRight, 0);
    } else {
      frame.whole = QRectF(width() / count * at, 0, width() / count, height());
      frame.area = frame.whole.adjusted(margin + 4, line + 6, -kRight, -line - 6);
    }
    frame.legend = frame.whole.top() + (content_.stacked ? 0 : 3);
    if (frame.levels.size() < 2 || frame.whole.width() < kMinWidth) frame.area = QRectF();
  }
  return frames;
}

std::size_t PlotWidget::axesAt(const QPointF& place) const {
  if (content_.stacked) return 0;
  const auto count = static_cast<double>(content_.axes.size());
  return static_cast<std::size_t>(
      std::clamp(place.x() / std::max(1, width()) * count, 0., count - 1e-9));
}

void PlotWidget::zoom(const QPointF& place, double notches) {
  const std::size_t i = axesAt(place);
  const Frame frame = frames()[i];
  if (frame.area.isEmpty()) return;
  const double part = std::clamp((place.x() - frame.area.left()) / frame.area.width(), 0., 1.);
  const double min_view = content_.axes[i].min_view;
  chosen_[i] = zoomed(frame.all, frame.x, frame.x.from + part * frame.x.length(), notches,
                      min_view > 0 ? min_view : 1e-3 * frame.all.length());
  update();
  emit viewChanged(true);
}

void PlotWidget::shift(double pixels) {
  const Frame frame = frames()[*dragged_];
  if (pixels == 0 || frame.area.isEmpty()) return;
  chosen_[*dragged_] = shifted(frame.all, frame.x, -pixels * frame.x.length() / frame.area.width());
  update();
  emit viewChanged(true);
}

void PlotWidget::moveCursor(const QPointF& place) {
  const Frame frame = frames()[0];
  if (frame.area.isEmpty()) return;
  const double x = frame.fromX(place.x());
  double found = x, nearest = place.y() < kMarksLine && !dragged_ ? kNear : 0;
  for (const PlotMark& mark : content_.marks) {
    const double away =
        std::max({0., frame.toX(mark.from) - place.x(), place.x() - frame.toX(mark.to)});
    // A single place has priority over a span.
    const double rank = away + (mark.to > mark.from ? 0.5 : 0);
    if (rank >= nearest) continue;
    nearest = rank;
    found = std::clamp(x, mark.from, mark.to);
  }
  emit cursorMoved(found);
}

bool PlotWidget::event(QEvent* event) {
  if (content_.bare || content_.axes.empty()) return QWidget::event(event);
  const auto place = [event] { return static_cast<QMouseEvent*>(event)->localPos(); };
  switch (event->type()) {
  case QEvent::Wheel: {
    const auto& wheel = *static_cast<QWheelEvent*>(event);
    event->accept();
    zoom(wheel.position(), wheel.angleDelta().y() / 120.);
    return true;
  }
  case QEvent::MouseButtonPress:
    if (static_cast<QMouseEvent*>(event)->button() != Qt::LeftButton) break;
    if (content_.cursor) moveCursor(place());
    dragged_ = axesAt(place());
    last_ = place().x();
    return true;
  case QEvent::MouseMove:
    pointer_ = place();
    if (dragged_ && content_.cursor)
      moveCursor(*pointer_);
    else if (dragged_)
      shift(pointer_->x() - last_);
    else
      update();
    last_ = pointer_->x();
    return true;
  case QEvent::MouseButtonRelease:
    dragged_.reset();
    return true;
  case QEvent::MouseButtonDblClick:
    chosen_.erase(axesAt(place()));
    update();
    emit viewChanged(false);
    return true;
  case QEvent::Leave:
    pointer_.reset();
    update();
    break;
  default:
    break;
  }
  return QWidget::event(event);
}

void PlotWidget::paintBare(QPainter& painter) const {
  painter.setPen(themeColor("line"));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));
  const PlotCurve& curve = content_.axes[0].curves[0];
  const QRectF box = curve.points.boundingRect(), area = QRectF(rect()).adjusted(4, 5, -4, -3);
  QPolygonF line;
  for (const QPointF& point : curve.points)
    line << QPointF(area.left() + (point.x() - box.left()) / box.width() * area.width(),
                    area.bottom() - point.y() * area.height());
  QColor shade = themeColor(curve.color);
  shade.setAlpha(60);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(shade);
  painter.drawPolygon(line);
  painter.setPen(QPen(themeColor(curve.color), curve.width));
  painter.drawPolyline(line);
}

void PlotWidget::paintLevels(QPainter& painter, const Frame& frame, const PlotAxes& axes) const {
  const int line = painter.fontMetrics().height();
  const double left = frame.whole.left(), margin = frame.area.left() - left - 4;
  for (const double level : frame.levels) {
    const double y =
        frame.area.bottom() - (level - frame.y.from) / frame.y.length() * frame.area.height();
    painter.setPen(themeColor(level == 0 && frame.y.from < 0 ? "grip" : "line"));
    painter.drawLine(QPointF(frame.area.left(), y), QPointF(frame.area.right(), y));
    painter.setPen(themeColor("quiet"));
    painter.drawText(QRectF(left, y - line / 2., margin, line), Qt::AlignRight | Qt::AlignVCenter,
                     levelWords(level, frame.levels[1] - frame.levels[0], frame.logarithmic));
  }
  if (!content_.stacked) // Stacked axes have a level of the axes above there.
    painter.drawText(QRectF(left, frame.legend, margin, line), Qt::AlignRight, axes.y_unit);
}

void PlotWidget::paintX(QPainter& painter, const Frame& frame, const PlotAxes& axes,
                        bool has_words) const {
  const int line = painter.fontMetrics().height();
  const AxisSpan seen =
      frame.logarithmic ? AxisSpan{std::pow(10, frame.x.from), std::pow(10, frame.x.to)} : frame.x;
  std::vector<double> marks = frame.logarithmic ? roundIn(seen) : std::vector<double>();
  if (marks.size() < 2)
    marks =
        marksOf(seen, std::clamp(static_cast<int>(frame.area.width() / 60), 2, 10), axes.counted);
  for (const double x : marks) {
    const double at = frame.toX(x);
    painter.setPen(themeColor("line"));
    if (!axes.spectrum)
      painter.drawLine(QPointF(at, frame.area.top()), QPointF(at, frame.area.bottom()));
    if (!has_words) continue;
    painter.setPen(themeColor("quiet"));
    const bool has_unit = x == marks.back() || !axes.zero_words.isEmpty();
    const QString words =
        x == 0 && !axes.zero_words.isEmpty()
            ? axes.zero_words
            : withMinus(QString::number(x)) + (has_unit ? kNoBreak + axes.x_unit : QString());
    const double wide = painter.fontMetrics().horizontalAdvance(words) + 2;
    const double from = std::min(at - wide / 2, frame.whole.right() - wide);
    painter.drawText(QRectF(from, frame.area.bottom() + 3, wide, line), Qt::AlignCenter, words);
  }
}

void PlotWidget::paintCurves(QPainter& painter, const Frame& frame, const PlotAxes& axes) const {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setClipRect(frame.area.adjusted(-1, -2, 1, 1));
  // The first curve is the most important one, so it is drawn last.
  for (auto curve = axes.curves.rbegin(); curve != axes.curves.rend(); ++curve) {
    painter.setPen(QPen(themeColor(curve->color), axes.spectrum ? 2 : curve->width));
    QPolygonF drawn;
    for (const QPointF& point : curve->points) {
      const QPointF at(frame.toX(point.x()), frame.toY(point.y()));
      if (axes.spectrum) painter.drawLine(at, QPointF(at.x(), frame.area.bottom()));
      drawn << at;
    }
    if (!axes.spectrum) painter.drawPolyline(drawn);
  }
  painter.restore();
}

// Returns the x of the point nearest to the pointer, for curves whose legend has no value.
std::optional<double> PlotWidget::pointedAt(const Frame& frame, const PlotAxes& axes) const {
  if (!pointer_ || dragged_ || !frame.area.contains(*pointer_)) return std::nullopt;
  std::optional<double> found;
  for (const PlotCurve& curve : axes.curves)
    for (const QPointF& point : curve.points)
      if (curve.value.isEmpty() && (!found || std::abs(frame.toX(point.x()) - pointer_->x()) <
                                                  std::abs(frame.toX(*found) - pointer_->x())))
        found = point.x();
  return found;
}

void PlotWidget::paintLegend(QPainter& painter, const Frame& frame, const PlotAxes& axes) const {
  const QFontMetrics letters = painter.fontMetrics();
  const double middle = frame.legend + letters.height() / 2.;
  const std::optional<double> x = pointedAt(frame, axes);
  std::vector<QString> values;
  // The first name is shortened in narrow axes.
  double left = frame.area.left() + kApart / 2, room = frame.whole.right() - left;
  for (const PlotCurve& curve : axes.curves) {
    QString value = curve.value;
    for (const QPointF& point : curve.points)
      if (x && value.isEmpty() && point.x() == *x)
        value = withMinus(QString::number(point.y(), 'g', 3));
    if (x && &curve == &axes.curves.back())
      value += QStringLiteral(" %1 (%2 %3)")
                   .arg(axes.y_unit, withMinus(QString::number(*x, 'g', 4)), axes.x_unit);
    values.push_back(value.isEmpty() ? value : ' ' + value);
    room -= kDash + kGap + kApart + letters.horizontalAdvance(values.back()) +
            (&curve == &axes.curves.front() ? 0 : letters.horizontalAdvance(curve.name));
  }
  for (std::size_t c = 0; c < axes.curves.size(); ++c) {
    const PlotCurve& curve = axes.curves[c];
    if (curve.name.isEmpty()) continue; // It belongs to the one before.
    const QString name =
        c > 0 ? curve.name
              : letters.elidedText(curve.name, Qt::ElideRight, std::max(0, static_cast<int>(room)));
    painter.setPen(QPen(themeColor(curve.color), 3));
    painter.drawLine(QPointF(left, middle), QPointF(left + kDash, middle));
    painter.setPen(themeColor("text"));
    painter.drawText(QPointF(left + kDash + kGap, frame.legend + letters.ascent()),
                     name + values[c]);
    left += curve.max_value.isEmpty()
                ? kDash + kGap + kApart + letters.horizontalAdvance(name + values[c])
                : legendWidth(curve);
  }
  painter.setPen(themeColor("quiet"));
  if (content_.stacked)
    painter.drawText(QPointF(left, frame.legend + letters.ascent()), axes.y_unit);
  if (!x) return;
  painter.setPen(themeColor("grip"));
  painter.drawLine(QPointF(frame.toX(*x), frame.area.top()),
                   QPointF(frame.toX(*x), frame.area.bottom()));
}

// area: the area of all stacked axes together.
void PlotWidget::paintMarks(QPainter& painter, const QRectF& area, const Frame& frame) const {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  for (const PlotMark& mark : content_.marks) {
    const double from = std::max(area.left(), frame.toX(mark.from)),
                 to = std::min(area.right(), frame.toX(mark.to));
    if (to < area.left() || from > area.right()) continue;
    const QColor color = themeColor(mark.color);
    if (mark.shape == PlotMark::Shape::span) {
      QColor shade = color;
      shade.setAlpha(45);
      painter.fillRect(QRectF(from, area.top(), std::max(1., to - from), area.height()), shade);
      painter.fillRect(QRectF(from, 4, std::max(3., to - from), 5), color);
    } else if (mark.shape == PlotMark::Shape::cross) {
      painter.setPen(QPen(color, 1.6));
      painter.drawLine(QPointF(from - 3, 3), QPointF(from + 3, 10));
      painter.drawLine(QPointF(from - 3, 10), QPointF(from + 3, 3));
    } else {
      painter.fillRect(QRectF(from - 2, 9, std::max(5., to - from), 4), color);
    }
  }
  painter.restore();
}

void PlotWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), themeColor(content_.bare ? "soft" : "card"));
  if (content_.bare) return paintBare(painter);
  const std::vector<Frame> frames = this->frames();
  QRectF all;
  for (const Frame& frame : frames) all = all.united(frame.area);
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (!frames[i].area.isEmpty())
      paintX(painter, frames[i], content_.axes[i], !content_.stacked || i + 1 == frames.size());
  if (!all.isEmpty()) paintMarks(painter, all, frames[0]);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].area.isEmpty()) continue;
    paintLevels(painter, frames[i], content_.axes[i]);
    paintCurves(painter, frames[i], content_.axes[i]);
    paintLegend(painter, frames[i], content_.axes[i]);
  }
  painter.setPen(themeColor("quiet"));
  painter.drawText(rect(), Qt::AlignCenter, content_.words);
  if (!content_.cursor || all.isEmpty()) return;
  const double x = frames[0].toX(*content_.cursor);
  if (x < all.left() - 1 || x > all.right() + 1) return;
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(themeColor("accent"), 1.5));
  painter.drawLine(QPointF(x, 0), QPointF(x, all.bottom()));
}

} // namespace patina
