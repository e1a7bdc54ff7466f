#include "app/gui/aligning/basin_plot.h"

#include <algorithm>
#include <cmath>

#include "app/gui/window/theme.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3;
constexpr double kNothing = 1e-6; // [mm]: rounding, no length

QColor colorOf(double part) {
  const double at = std::clamp(part, 0., 1.) * (palette::kMuch.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), palette::kMuch.size() - 2);
  const double t = at - static_cast<double>(low);
  const auto mix = [&](std::size_t i) {
    return (1 - t) * palette::kMuch[low][i] + t * palette::kMuch[low + 1][i];
  };
  return QColor::fromRgbF(mix(0), mix(1), mix(2));
}

} // namespace

BasinPlot::BasinPlot(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("basin_plot"));
  setMinimumHeight(118);
  setToolTip(tr("Rms distance of the path from the surface if it were shifted or turned from where "
                "it lies: a bowl has its foot where it fits, a flat line is free to move"));
}

void BasinPlot::setBasin(const std::optional<Basin>& basin) {
  graphs_.clear();
  map_ = QImage();
  if (basin) {
    constexpr const char* kInks[] = {"series_x", "series_y", "series_z"};
    const QString names[] = {tr("x"), tr("y"), tr("z")};
    for (int turns = 0; turns < 2; ++turns) {
      Graph graph{turns ? QStringLiteral("°") : tr("mm"), tr("mm"), false, false, {}};
      const double reach = turns ? basin->turn * 180 / M_PI : kMilli * basin->shift;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double>& rms = basin->along[axis + (turns ? 3 : 0)];
        GraphCurve curve{(axis > 0 ? tr("%1")
                          : turns  ? tr("rms, turned %1")
                                   : tr("rms, shifted %1"))
                             .arg(names[axis]),
                         kInks[axis],
                         {}};
        for (std::size_t i = 0; i < rms.size(); ++i)
          curve.points << QPointF(
              reach * (2. * static_cast<double>(i) / static_cast<double>(rms.size() - 1) - 1),
              kMilli * rms[i]);
        graph.curves.push_back(curve);
      }
      graphs_.push_back(graph);
    }
    const auto [least, most] = std::minmax_element(basin->map.begin(), basin->map.end());
    least_mm_ = kMilli * *least;
    most_mm_ = kMilli * *most;
    reach_mm_ = kMilli * basin->shift;
    map_ = QImage(basin->side, basin->side, QImage::Format_RGB32);
    for (int row = 0; row < basin->side; ++row)
      for (int column = 0; column < basin->side; ++column) {
        const double rms = basin->map[static_cast<std::size_t>(row * basin->side + column)];
        map_.setPixelColor(
            column, basin->side - 1 - row,
            colorOf((kMilli * rms - least_mm_) / std::max(1e-9, most_mm_ - least_mm_)));
      }
  }
  update();
}

void BasinPlot::setSteps(const std::vector<double>& rms) {
  steps_ = Graph{tr("steps"), tr("mm"), false, false, {{tr("rms"), "accent", {}}}, true};
  for (std::size_t i = 0; i < rms.size(); ++i)
    steps_.curves[0].points << QPointF(static_cast<double>(i), kMilli * rms[i]);
  update();
}

void BasinPlot::paintMap(QPainter& painter, const QRectF& whole) const {
  const int line = painter.fontMetrics().height();
  const double side = std::min(whole.height() - 2 * line - 12, whole.width() - 40);
  const QRectF area(whole.left() + 28, whole.top() + line + 6, side, side);
  painter.setRenderHint(QPainter::SmoothPixmapTransform, false);
  painter.drawImage(area, map_);
  painter.setPen(QPen(ink("warm"), 1.5));
  painter.drawLine(area.center() - QPointF(5, 0), area.center() + QPointF(5, 0));
  painter.drawLine(area.center() - QPointF(0, 5), area.center() + QPointF(0, 5));
  painter.setPen(ink("text"));
  painter.drawText(QPointF(area.left(), whole.top() + painter.fontMetrics().ascent() + 3),
                   tr("rms over shifts x, y"));
  painter.setPen(ink("quiet"));
  painter.drawText(QRectF(area.left(), area.bottom() + 3, whole.width() - 28, line),
                   Qt::AlignLeft | Qt::AlignVCenter,
                   tr("±%1 mm: %2 to %3 mm")
                       .arg(reach_mm_, 0, 'f', 0)
                       .arg(least_mm_ < kNothing ? 0 : least_mm_, 0, 'g', 3)
                       .arg(most_mm_ < kNothing ? 0 : most_mm_, 0, 'g', 3));
}

void BasinPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  if (map_.isNull()) {
    painter.setPen(ink("quiet"));
    painter.drawText(rect(), Qt::AlignCenter, tr("Looking about …"));
    return;
  }
  // Its words fit below it.
  const double map_wide = std::max(std::min(0.25 * width(), 1.3 * height()),
                                   28. + fontMetrics().horizontalAdvance(QString(24, '0')));
  const bool stepped = steps_.curves[0].points.size() > 1;
  const double wide = (width() - map_wide) / (stepped ? 3 : 2);
  for (std::size_t i = 0; i < graphs_.size(); ++i)
    paintGraph(painter, QRectF(wide * static_cast<double>(i), 0, wide, height()), graphs_[i]);
  if (stepped) paintGraph(painter, QRectF(2 * wide, 0, wide, height()), steps_);
  paintMap(painter, QRectF(width() - map_wide, 0, map_wide, height()));
}

} // namespace patina
