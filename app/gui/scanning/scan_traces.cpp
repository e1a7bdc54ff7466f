#include "app/gui/scanning/scan_traces.h"

#include <algorithm>
#include <cmath>

#include "app/gui/toolkit/card.h"

namespace patina {
namespace {

constexpr double kLive = 10;           // Visible span of a growing scan [s].
constexpr double kMinTraceSpan = 0.02; // [s]
constexpr double kMinHighest = .1;     // Smallest top of an axis, in its unit.

using Samples = std::vector<ProbeSample>;

struct Trace {
  const char *name, *color;
  double (*value)(const ProbeSample&);
};
struct Lane {
  const char* unit;
  std::vector<Trace> traces;
};

const std::vector<Lane>& lanes() {
  static const std::vector<Lane> kLanes = {
      {"N", {{"force", "warm", [](const ProbeSample& s) { return s.force; }}}},
      {"m/s²",
       {{"a1u", "series_x", [](const ProbeSample& s) { return s.acceleration[0]; }},
        {"a1v", "series_y", [](const ProbeSample& s) { return s.acceleration[1]; }},
        {"a2u", "series_z", [](const ProbeSample& s) { return s.acceleration[2]; }},
        {"a2v", "quiet", [](const ProbeSample& s) { return s.acceleration[3]; }}}}};
  return kLanes;
}

PlotMark markOf(const Finding& finding) {
  switch (finding.kind) {
  case Finding::Kind::gap:
  case Finding::Kind::dropout:
    return {finding.from, finding.to, "warn", PlotMark::Shape::span};
  case Finding::Kind::outlier:
    return {finding.from, finding.to, "bad", PlotMark::Shape::cross};
  case Finding::Kind::no_marker:
    return {finding.from, finding.to, "quiet", PlotMark::Shape::dash};
  default:
    return {finding.from, finding.to, "bad", PlotMark::Shape::dash};
  }
}

Samples::const_iterator firstAt(const Samples& samples, double t) {
  return std::lower_bound(samples.begin(), samples.end(), t,
                          [](const ProbeSample& sample, double time) { return sample.t < time; });
}

// Returns the minimum and the maximum of the samples in each of `count` parts of the view.
QPolygonF pointsOf(const Samples& samples, const Trace& trace, const AxisSpan& view, int count) {
  QPolygonF points;
  const double part = view.length() / count;
  for (auto sample = firstAt(samples, view.from - part);
       sample != samples.end() && sample->t <= view.to + part;) {
    const double end = part * (std::floor(sample->t / part) + 1), t = sample->t;
    double min_value = trace.value(*sample), max_value = min_value;
    while (++sample != samples.end() && sample->t < end) {
      min_value = std::min(min_value, trace.value(*sample));
      max_value = std::max(max_value, trace.value(*sample));
    }
    points << QPointF(t, min_value) << QPointF(t, max_value);
  }
  return points;
}

// Returns a range with round ends.
AxisSpan rangeOf(const std::vector<PlotCurve>& curves) {
  double low = 0, high = kMinHighest;
  for (const PlotCurve& curve : curves)
    for (const QPointF& point : curve.points) {
      low = std::min(low, point.y());
      high = std::max(high, point.y());
    }
  const double step = stepFor(high - low, 3);
  if (low > -0.1 * step) low = 0; // Slightly negative values are noise.
  return {step * std::floor(low / step), step * std::ceil(high / step)};
}

} // namespace

ScanTraces::ScanTraces(OpenScan& scan, QWidget* parent) : PlotWidget(parent), scan_(scan) {
  named(this, "traces",
        tr("The probe's force and accelerations. A click or drag moves the cursor, the wheel zooms "
           "the time, a double click shows all of it. Marks at the top show missing or rejected "
           "data"));
  setFocusPolicy(Qt::StrongFocus);
  connect(&scan_, &OpenScan::opened, this, [this] {
    resetView();
    describe();
  });
  connect(&scan_, &OpenScan::pathMade, this, &ScanTraces::describe);
  connect(this, &PlotWidget::viewChanged, this, &ScanTraces::describe);
  connect(this, &PlotWidget::cursorMoved, &scan_.cursor(), &ScanCursor::set);
  connect(&scan_.cursor(), &ScanCursor::moved, this, [this] {
    moveInto(scan_.cursor().time());
    describe();
  });
  describe();
}

void ScanTraces::describe() {
  if (scan_.files() == nullptr) return setContent({});
  const Samples& samples = scan_.path() != nullptr ? scan_.path()->probe : scan_.files()->probe;
  PlotContent content;
  content.stacked = true;
  content.cursor = scan_.cursor().time();
  if (samples.empty()) content.words = tr("This scan has no stream of a probe.");
  if (scan_.path() != nullptr)
    for (const Finding& finding : scan_.path()->findings) content.marks.push_back(markOf(finding));
  AxisSpan all{scan_.span().from, scan_.span().to};
  if (!(all.length() > 0)) all.to = all.from + 1;
  const AxisSpan first{scan_.grows() ? std::max(all.from, all.to - kLive) : all.from, all.to};
  const auto now = firstAt(samples, *content.cursor);
  for (const Lane& lane : lanes()) {
    PlotAxes axes{QStringLiteral("s"), QString::fromUtf8(lane.unit)};
    axes.x = all;
    axes.first_view = first;
    axes.min_view = kMinTraceSpan;
    for (const Trace& trace : lane.traces) {
      PlotCurve curve{tr(trace.name), trace.color};
      curve.points = pointsOf(samples, trace, chosenView().value_or(first), std::max(100, width()));
      curve.width = 1.1;
      curve.value = now == samples.end() ? QStringLiteral("–")
                                         : withMinus(QString::number(trace.value(*now), 'f', 2));
      axes.curves.push_back(curve);
    }
    axes.y = rangeOf(axes.curves);
    content.axes.push_back(axes);
  }
  setContent(content, true);
}

} // namespace patina
