#include "app/gui/texturing/profile_plot.h"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;
constexpr double kFineStep = 0.1e-3;       // of what is drawn along the way [m]
constexpr double kLeastAmplitude = 0.1e-6; // of what is drawn of the spectrum [m]

Graph spectrumOf(const FourierSeries& series, double period) {
  Graph spectrum{ProfilePlot::tr("mm"),
                 ProfilePlot::tr("µm"),
                 true,
                 true,
                 {{ProfilePlot::tr("spectrum"), "accent", {}}}};
  for (std::size_t j = 0; j < series.a.size(); ++j) {
    const double amplitude = std::hypot(series.a[j], series.b[j]);
    if (amplitude < kLeastAmplitude) continue;
    spectrum.curves[0].points << QPointF(kMilli * period / static_cast<double>(j + 1),
                                         kMicro * amplitude);
  }
  return spectrum;
}

// In which a step of the picture is the same step everywhere.
AxisSpan even(const Graph& graph, const AxisSpan& span) {
  return graph.logarithmic ? AxisSpan{std::log(span.from), std::log(span.to)} : span;
}

void see(Graph& graph, const AxisSpan& span) {
  graph.seen = graph.logarithmic ? AxisSpan{std::exp(span.from), std::exp(span.to)} : span;
}

} // namespace

// Its place among the graphs is that of x among as many equal parts.
Graph* ProfilePlot::graphAt(double x) {
  if (graphs_.empty()) return nullptr;
  const auto count = static_cast<double>(graphs_.size());
  const double part = std::clamp(x / std::max(1, width()) * count, 0., count - 1e-9);
  return &graphs_[static_cast<std::size_t>(part)];
}

void ProfilePlot::zoom(const QPointF& at, double notches) {
  Graph* graph = graphAt(at.x());
  if (graph == nullptr || areas_.size() != graphs_.size()) return;
  const QRectF& area = areas_[static_cast<std::size_t>(graph - graphs_.data())];
  if (area.isEmpty()) return;
  const AxisSpan whole = even(*graph, wholeOf(*graph));
  const AxisSpan seen = even(*graph, graph->seen.value_or(wholeOf(*graph)));
  const double part = std::clamp((at.x() - area.left()) / area.width(), 0., 1.);
  see(*graph,
      zoomed(whole, seen, seen.from + part * seen.length(), notches, 1e-3 * whole.length()));
  update();
}

void ProfilePlot::shift(double pixels) {
  const QRectF& area = areas_[static_cast<std::size_t>(dragged_ - graphs_.data())];
  if (!dragged_->seen || area.isEmpty()) return;
  const AxisSpan seen = even(*dragged_, *dragged_->seen);
  see(*dragged_,
      shifted(even(*dragged_, wholeOf(*dragged_)), seen, -pixels * seen.length() / area.width()));
  update();
}

bool ProfilePlot::event(QEvent* event) {
  switch (event->type()) {
  case QEvent::Wheel: {
    const auto& wheel = *static_cast<QWheelEvent*>(event);
    event->accept();
    zoom(wheel.position(), wheel.angleDelta().y() / 120.);
    return true;
  }
  case QEvent::MouseButtonPress:
    last_ = static_cast<QMouseEvent*>(event)->x();
    dragged_ = areas_.size() == graphs_.size() ? graphAt(last_) : nullptr;
    return true;
  case QEvent::MouseMove:
    if (dragged_ == nullptr) break;
    shift(static_cast<QMouseEvent*>(event)->x() - last_);
    last_ = static_cast<QMouseEvent*>(event)->x();
    return true;
  case QEvent::MouseButtonRelease:
    dragged_ = nullptr;
    return true;
  case QEvent::MouseButtonDblClick:
    if (Graph* graph = graphAt(static_cast<QMouseEvent*>(event)->x())) graph->seen.reset();
    update();
    return true;
  default:
    break;
  }
  return QWidget::event(event);
}

void ProfilePlot::setTexture(const FourierTexture* texture) {
  graphs_.clear();
  dragged_ = nullptr;
  if (texture != nullptr) {
    Graph heights{tr("mm"), tr("µm"), false, false, {{tr("height over a period"), "accent", {}}}};
    const int steps = std::clamp(8 * harmonics(*texture), 64, 2000);
    for (int i = 0; i <= steps; ++i) {
      const double x = period(*texture) * i / steps;
      heights.curves[0].points << QPointF(kMilli * x, kMicro * patina::height(*texture, x));
    }
    graphs_ = {heights};
    if (texture->kind == TextureKind::line || texture->kind == TextureKind::spectrum)
      graphs_.push_back(spectrumOf(patina::seriesOf(*texture), period(*texture)));
  }
  update();
}

void ProfilePlot::setTexture(const DemoTexture* texture) {
  graphs_.clear();
  dragged_ = nullptr;
  if (texture != nullptr) {
    const FittedTexture& fitted = texture->scanned.fitted;
    Graph heights{tr("mm"),
                  tr("µm"),
                  false,
                  false,
                  {{tr("measured"), "quiet", {}}, {tr("harmonics"), "accent", {}}}};
    double last = -1;
    for (const ScanHeight& height : texture->scanned.heights) {
      const double along = height.point.along;
      if (along < last + kFineStep) continue;
      last = along;
      heights.curves[0].points << QPointF(kMilli * along, kMicro * height.point.height);
      heights.curves[1].points << QPointF(kMilli * along,
                                          kMicro * patina::height(fitted.texture, along));
    }
    graphs_ = {heights, spectrumOf(patina::seriesOf(fitted.texture), period(fitted.texture))};
    if (!texture->felt.empty()) {
      Graph felt{tr("mm"),
                 tr("N"),
                 false,
                 false,
                 {{tr("true surface"), "quiet", {}}, {tr("felt"), "accent", {}}}};
      for (std::size_t i = 0; i < texture->felt.size(); i += 3) {
        const FeltPoint& point = texture->felt[i];
        felt.curves[0].points << QPointF(kMilli * point.along, point.truth.dot(point.outward));
        felt.curves[1].points << QPointF(kMilli * point.along, point.felt.dot(point.outward));
      }
      graphs_.push_back(felt);
    }
  }
  update();
}

void ProfilePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  const double wide = width() / std::max<double>(1, static_cast<double>(graphs_.size()));
  areas_.clear();
  for (std::size_t i = 0; i < graphs_.size(); ++i)
    areas_.push_back(
        paintGraph(painter, QRectF(wide * static_cast<double>(i), 0, wide, height()), graphs_[i]));
}

} // namespace patina
