#include "app/gui/panels/field_plots.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QHBoxLayout>
#include <QShortcut>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "visualization/values/histogram.h"

namespace patina {
namespace {

constexpr double kToMilli = 1000;
constexpr std::size_t kBins = 50;
constexpr int kRefinement = 4; // Points along a side of a cell, whose pattern would show otherwise.

class PlotWindow : public QWidget {
 public:
  PlotWindow(QWidget& over, const char* name) : QWidget(&over, Qt::Window) {
    setObjectName(QString::fromUtf8(name));
    setAttribute(Qt::WA_DeleteOnClose);
    resize(560, 340);
    auto* column = new QVBoxLayout(this);
    column->addWidget(plot_, 1);
    auto* line = new QHBoxLayout;
    line->addWidget(note_, 1);
    addButton(line, "save_table", tr("Save table…"), tr("As CSV"), this, &PlotWindow::save);
    column->addLayout(line);
    connect(new QShortcut(Qt::Key_Escape, this), &QShortcut::activated, this, &QWidget::close);
  }
  void set(FieldPlot shown) {
    shown_ = std::move(shown);
    setWindowTitle(shown_.title);
    note_->setText(shown_.note);
    plot_->setContent(shown_.content);
  }

 private:
  void save() {
    saveDialog(this, tr("Save the table"), tr("Tables (*.csv)"), shown_.file,
               [this](const QString& path) {
                 try {
                   writeCsv(path.toStdString(), shown_.table);
                   note_->setText(tr("Saved %1").arg(path));
                 } catch (const Error& error) {
                   note_->setText(tr("Not saved: %1").arg(QString::fromUtf8(error.what())));
                 }
               })
        ->open();
  }

  FieldPlot shown_{};
  PlotWidget* plot_ = new PlotWidget(this);
  ElidedLabel* note_ = named(new ElidedLabel(this), "plot_note");
};

} // namespace

FieldPlot profilePlot(const std::vector<LineSample>& profile) {
  FieldPlot plot{"line_profile_window", tr("Line profile"), {}, {}, {}, "profile.csv"};
  plot.table.columns = {"s [m]", "x [m]", "y [m]", "z [m]", "phi [m]"};
  PlotAxes axes{tr("mm"), tr("mm")};
  bool gap = true; // Parts without a value separate the curves.
  for (const LineSample& sample : profile) {
    const Vec3& p = sample.point;
    plot.table.rows.push_back({sample.along, p.x(), p.y(), p.z(), sample.phi});
    const bool known = std::isfinite(sample.phi);
    if (known && std::exchange(gap, false))
      axes.curves.push_back({axes.curves.empty() ? tr("Distance") : QString(), "accent"});
    if (known) axes.curves.back().points << QPointF(kToMilli * sample.along, kToMilli * sample.phi);
    gap = gap || !known;
  }
  axes.x = AxisSpan{0, kToMilli * profile.back().along};
  plot.note = tr("Length %1").arg(inWords(profile.back().along));
  if (axes.curves.empty())
    plot.content.words = tr("The line is farther from the surface than the field's band");
  else
    plot.content.axes.push_back(std::move(axes));
  return plot;
}

FieldPlot histogramPlot(const FieldPlane& slice, double voxel) {
  FieldPlot plot{"histogram_window", tr("Histogram of the slice"), {}, {}, {}, "histogram.csv"};
  plot.table.columns = {"phi from [m]", "phi to [m]", "area [m^2]"};
  PlotCurve curve{tr("Area over distance"), "accent"};
  double area = 0;
  const auto bins = histogramOf(refinedValues(slice, kRefinement), kBins);
  for (const HistogramBin& bin : bins) {
    const double side = voxel / kRefinement, part = side * side * static_cast<double>(bin.count);
    area += part;
    plot.table.rows.push_back({voxel * bin.from, voxel * bin.to, part});
    for (const double end : {bin.from, bin.to})
      curve.points << QPointF(kToMilli * voxel * end, kToMilli * kToMilli * part);
  }
  if (bins.empty()) {
    plot.content.words = tr("The slice does not meet the field's band");
    return plot;
  }
  // The steps stand on 0.
  curve.points.prepend(QPointF(curve.points.front().x(), 0));
  curve.points << QPointF(curve.points.back().x(), 0);
  plot.content.axes.push_back({tr("mm"), tr("mm²"), {curve}});
  plot.note = tr("Area of the band %1").arg(shownText(formatArea(area)));
  return plot;
}

void showPlot(QWidget& over, FieldPlot plot) {
  auto* window = static_cast<PlotWindow*>(over.findChild<QWidget*>(QString::fromUtf8(plot.name)));
  if (window == nullptr) window = new PlotWindow(over, plot.name);
  window->set(std::move(plot));
  window->show();
  window->raise();
}

} // namespace patina
