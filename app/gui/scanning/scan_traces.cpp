#include "app/gui/scanning/scan_traces.h"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr int kLeft = 62, kRight = 12, kMarks = 14, kTimes = 17, kNames = 15; // [px]
constexpr double kLive = 10; // shown of what grows [s]
constexpr double kNear = 6;  // of a click [px]

QString axisWords(double value) {
  return QString::number(value, 'g', 3).replace('-', QStringLiteral("−"));
}

// 1, 2 or 5 times a power of ten, at least so much.
double roundStep(double least) {
  const double ten = std::pow(10, std::floor(std::log10(least)));
  for (const double digit : {1., 2., 5.})
    if (digit * ten >= least) return digit * ten;
  return 10 * ten;
}

const char* inkOf(Finding::Kind kind) {
  switch (kind) {
  case Finding::Kind::gap:
  case Finding::Kind::dropout:
    return "warn";
  case Finding::Kind::no_marker:
    return "quiet";
  default:
    return "bad";
  }
}

} // namespace

const std::vector<ScanTraces::Lane>& ScanTraces::lanes() {
  static const std::vector<Lane> kLanes = {
      {QStringLiteral("N"), {{tr("force"), "warm", [](const ProbeSample& s) { return s.force; }}}},
      {QStringLiteral("m/s²"),
       {{QStringLiteral("a1u"), "series_x", [](const ProbeSample& s) { return s.acceleration[0]; }},
        {QStringLiteral("a1v"), "series_y", [](const ProbeSample& s) { return s.acceleration[1]; }},
        {QStringLiteral("a2u"), "series_z", [](const ProbeSample& s) { return s.acceleration[2]; }},
        {QStringLiteral("a2v"), "quiet", [](const ProbeSample& s) { return s.acceleration[3]; }}}}};
  return kLanes;
}

ScanTraces::ScanTraces(OpenScan& scan, QWidget* parent) : QWidget(parent), scan_(scan) {
  setObjectName(QStringLiteral("traces"));
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setToolTip(tr("The probe's force and accelerations. A click or drag moves the cursor, the wheel "
                "zooms the time, a double click shows all of it; marks on top say what is "
                "missing"));
  const auto all = [this] {
    shown_ = scan_.span();
    if (!(shown_.to > shown_.from)) shown_.to = shown_.from + 1;
    update();
  };
  connect(&scan_, &OpenScan::opened, this, all);
  connect(&scan_, &OpenScan::pathMade, this, [this, all] {
    if (!scan_.grows()) return update();
    all();
    shown_.from = std::max(shown_.from, shown_.to - kLive);
  });
  connect(&scan_.cursor(), &ScanCursor::moved, this, [this] {
    const double t = scan_.cursor().time(), wide = shown_.to - shown_.from;
    if (t < shown_.from || t > shown_.to) {
      const Gap span = scan_.span();
      shown_.from = std::clamp(t - wide / 2, span.from, std::max(span.from, span.to - wide));
      shown_.to = shown_.from + wide;
    }
    update();
  });
  all();
}

const std::vector<ProbeSample>& ScanTraces::samples() const {
  static const std::vector<ProbeSample> kNoSamples;
  if (scan_.files() == nullptr) return kNoSamples;
  return scan_.path() != nullptr ? scan_.path()->probe : scan_.files()->probe;
}

QRectF ScanTraces::area() const {
  return {kLeft, kMarks, static_cast<double>(width() - kLeft - kRight),
          static_cast<double>(height() - kMarks - kTimes)};
}

double ScanTraces::toX(double t) const {
  const QRectF room = area();
  return room.left() + (t - shown_.from) / (shown_.to - shown_.from) * room.width();
}

double ScanTraces::toTime(double x) const {
  const QRectF room = area();
  return shown_.from + (x - room.left()) / room.width() * (shown_.to - shown_.from);
}

QPoint ScanTraces::placeOf(double t) const {
  return {qRound(toX(t)), kMarks / 2};
}

void ScanTraces::look(const QPointF& at) {
  double t = toTime(at.x());
  if (scan_.path() != nullptr && at.y() < kMarks) {
    double nearest = kNear;
    for (const Finding& finding : scan_.path()->findings) {
      const double from = toX(finding.from), to = toX(finding.to);
      const double away = std::max({0., from - at.x(), at.x() - to});
      // What is a moment lies over what lasts.
      const double rank = away + (finding.to > finding.from ? 0.5 : 0);
      if (rank >= nearest) continue;
      nearest = rank;
      t = finding.to > finding.from ? std::clamp(toTime(at.x()), finding.from, finding.to)
                                    : finding.from;
    }
  }
  scan_.cursor().set(t);
}

void ScanTraces::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) look(event->localPos());
}

void ScanTraces::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons().testFlag(Qt::LeftButton)) scan_.cursor().set(toTime(event->localPos().x()));
}

void ScanTraces::mouseDoubleClickEvent(QMouseEvent*) {
  shown_ = scan_.span();
  update();
}

void ScanTraces::wheelEvent(QWheelEvent* event) {
  const double at = toTime(event->position().x());
  const double factor = std::pow(1.25, -event->angleDelta().y() / 120.);
  const Gap span = scan_.span();
  shown_.from = std::max(span.from, at + (shown_.from - at) * factor);
  shown_.to = std::min(span.to, at + (shown_.to - at) * factor);
  if (shown_.to - shown_.from < 0.02) shown_.to = shown_.from + 0.02;
  update();
}

void ScanTraces::paintFindings(QPainter& painter) const {
  if (scan_.path() == nullptr) return;
  const QRectF room = area();
  for (const Finding& finding : scan_.path()->findings) {
    const double from = std::max(room.left(), toX(finding.from)),
                 to = std::min(room.right(), toX(finding.to));
    if (to < room.left() || from > room.right()) continue;
    const QColor color = ink(inkOf(finding.kind));
    if (finding.kind == Finding::Kind::gap || finding.kind == Finding::Kind::dropout) {
      QColor shade = color;
      shade.setAlpha(45);
      painter.fillRect(QRectF(from, room.top(), std::max(1., to - from), room.height()), shade);
      painter.fillRect(QRectF(from, 4, std::max(3., to - from), 5), color);
    } else if (finding.kind == Finding::Kind::outlier) {
      painter.setPen(QPen(color, 1.6));
      painter.drawLine(QPointF(from - 3, 3), QPointF(from + 3, 10));
      painter.drawLine(QPointF(from - 3, 10), QPointF(from + 3, 3));
    } else {
      painter.fillRect(QRectF(from - 2, 9, std::max(5., to - from), 4), color);
    }
  }
}

void ScanTraces::paintLane(QPainter& painter, const QRectF& whole, const Lane& lane) const {
  const QRectF room = whole.adjusted(0, kNames, 0, 0);
  const auto& all = samples();
  const auto before = [](const ProbeSample& sample, double t) { return sample.t < t; };
  const auto begin = std::lower_bound(all.begin(), all.end(), shown_.from, before);
  const auto end = std::lower_bound(begin, all.end(), shown_.to, before);
  double low = 0, high = 0.1;
  for (auto sample = begin; sample != end; ++sample)
    for (const Curve& curve : lane.curves) {
      low = std::min(low, curve.value(*sample));
      high = std::max(high, curve.value(*sample));
    }
  const double step = roundStep((high - low) / 3);
  if (low > -0.1 * step) low = 0; // noise about nothing
  low = step * std::floor(low / step);
  high = step * std::ceil(high / step);
  const auto toY = [&](double value) {
    return room.bottom() - (value - low) / (high - low) * room.height();
  };
  for (double value = low; value <= high + step / 2; value += step) {
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(room.left(), toY(value)), QPointF(room.right(), toY(value)));
    painter.setPen(ink("quiet"));
    painter.drawText(QRectF(26, toY(value) - 8, kLeft - 31, 16), Qt::AlignRight | Qt::AlignVCenter,
                     axisWords(std::abs(value) < step / 2 ? 0 : value));
  }
  painter.drawText(QRectF(2, room.top(), 30, room.height()), Qt::AlignLeft | Qt::AlignVCenter,
                   lane.unit);
  painter.setClipRect(room.adjusted(0, -1, 0, 1));
  for (std::size_t c = lane.curves.size(); c-- > 0;) {
    // Of many samples in a pixel the lowest and the highest.
    QPolygonF line;
    int pixel = -1;
    double least = 0, most = 0;
    const auto flush = [&] {
      if (pixel >= 0) line << QPointF(pixel, toY(least)) << QPointF(pixel, toY(most));
    };
    for (auto sample = begin; sample != end; ++sample) {
      const double value = lane.curves[c].value(*sample);
      const int at = qRound(toX(sample->t));
      if (at != pixel) {
        flush();
        pixel = at;
        least = most = value;
      }
      least = std::min(least, value);
      most = std::max(most, value);
    }
    flush();
    painter.setPen(QPen(ink(lane.curves[c].ink), 1.1));
    painter.drawPolyline(line);
  }
  painter.setClipping(false);
  const auto now = std::lower_bound(all.begin(), all.end(), scan_.cursor().time(), before);
  double x = room.left();
  for (const Curve& curve : lane.curves) {
    QString words = curve.name;
    if (now != all.end())
      words += QStringLiteral(" %1").arg(curve.value(*now), 0, 'f', 2).replace('-', "−");
    const double wide = painter.fontMetrics().horizontalAdvance(words) + 4;
    const QRectF tag(x, whole.top(), wide + 14, kNames);
    painter.setPen(QPen(ink(curve.ink), 3));
    painter.drawLine(tag.left() + 2, tag.center().y(), tag.left() + 10, tag.center().y());
    painter.setPen(ink("text"));
    painter.drawText(tag.adjusted(14, 0, 0, 0), Qt::AlignVCenter, words);
    x += wide + 22;
  }
}

void ScanTraces::paintTimes(QPainter& painter) const {
  const QRectF room = area();
  const double step = roundStep((shown_.to - shown_.from) * 80 / std::max(80., room.width()));
  for (double t = step * std::ceil(shown_.from / step); t <= shown_.to; t += step) {
    painter.setPen(ink("line"));
    painter.drawLine(QPointF(toX(t), room.top()), QPointF(toX(t), room.bottom()));
    painter.setPen(ink("quiet"));
    const bool first = toX(t) < room.left() + 20; // beside it stand the values
    painter.drawText(QRectF(toX(t) - (first ? 0 : 35), room.bottom() + 1, 70, kTimes - 2),
                     first ? Qt::AlignLeft | Qt::AlignVCenter : Qt::AlignCenter,
                     QStringLiteral("%1 s").arg(t, 0, 'g', 6));
  }
}

void ScanTraces::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  if (scan_.files() == nullptr) return;
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF room = area();
  paintTimes(painter);
  paintFindings(painter);
  if (samples().empty()) {
    painter.setPen(ink("quiet"));
    painter.drawText(room, Qt::AlignCenter, tr("This scan has no stream of a probe."));
  } else {
    const double high = room.height() / static_cast<double>(lanes().size());
    for (std::size_t i = 0; i < lanes().size(); ++i)
      paintLane(painter,
                QRectF(room.left(), room.top() + static_cast<double>(i) * high, room.width(), high),
                lanes()[i]);
  }
  const double x = toX(scan_.cursor().time());
  if (x < room.left() - 1 || x > room.right() + 1) return;
  painter.setPen(QPen(ink("accent"), 1.5));
  painter.drawLine(QPointF(x, 0), QPointF(x, room.bottom()));
}

} // namespace patina
