#include "visualization/plots/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include "core/error.h"
#include "visualization/values/palette.h"
#include "visualization/view/display.h"
#include "visualization/view/png.h"

namespace patina {
namespace {

struct Range {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

bool drawable(double value, bool log) {
  return std::isfinite(value) && (!log || value > 0);
}

PlotSeries cleaned(const Plot& plot, const PlotSeries& series) {
  PlotSeries clean = series;
  clean.x.clear();
  clean.y.clear();
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
    if (drawable(series.x[i], plot.log_x) && drawable(series.y[i], plot.log_y)) {
      clean.x.push_back(series.x[i]);
      clean.y.push_back(series.y[i]);
    }
  return clean;
}

void setText(vtkTextProperty* text, double size, bool bold) {
  text->SetFontFamilyToArial();
  text->SetFontSize(static_cast<int>(std::lround(size)));
  text->SetBold(bold);
  text->SetItalic(false);
  text->SetColor(palette::forVtk(palette::kText));
}

// VTK's log ticks are sparse and crowd at small ranges. These have more ticks per decade, the fewer
// decades there are.
std::vector<double> ticksOfADecade(double decades) {
  if (decades < 1) return {1, 1.5, 2, 3, 4, 5, 7};
  if (decades <= 2) return {1, 2, 5};
  return {1};
}

void placeLogTicks(vtkAxis* axis, const Range& range) {
  const double low = std::floor(std::log10(range.low) + 1e-9);
  const double high = std::ceil(std::log10(range.high) - 1e-9);
  const std::vector<double> factors = ticksOfADecade(std::log10(range.high / range.low));
  const bool few = factors.size() > 1;
  const bool many = high - low > 9;
  const vtkNew<vtkDoubleArray> positions;
  const vtkNew<vtkStringArray> labels;
  const double margin = std::max(0.08, 0.04 * std::log10(range.high / range.low));
  const double from = few ? std::log10(range.low) - margin : low;
  const double to = few ? std::log10(range.high) + margin : high;
  for (int decade = static_cast<int>(low) - 1; decade <= static_cast<int>(high) + 1; ++decade)
    for (const double factor : factors) {
      if (many && decade % 2 != 0) continue;
      const double at = decade + std::log10(factor);
      if (at < from - 1e-9 || at > to + 1e-9) continue;
      char text[32];
      if (decade >= -2 && decade <= 3)
        std::snprintf(text, sizeof text, "%g", std::pow(10.0, at));
      else
        std::snprintf(text, sizeof text, "%ge%d", factor, decade);
      positions->InsertNextValue(at);
      labels->InsertNextValue(text);
    }
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetUnscaledRange(std::pow(10.0, from), std::pow(10.0, to));
  axis->SetCustomTickPositions(positions, labels);
}

void setAxis(vtkAxis* axis, const std::string& label, bool log, const Range& range,
             double magnification) {
  axis->SetTitle(label);
  setText(axis->GetTitleProperties(), 17 * magnification, false);
  setText(axis->GetLabelProperties(), 15 * magnification, false);
  axis->GetGridPen()->SetColorF(0.88, 0.89, 0.91);
  axis->GetPen()->SetColorF(0.35, 0.38, 0.42);
  axis->GetPen()->SetWidth(static_cast<float>(1.2 * magnification));
  if (!log) {
    const double margin = range.high > range.low ? 0.04 * (range.high - range.low) : 1;
    axis->SetBehavior(vtkAxis::FIXED);
    axis->SetRange(range.low - margin, range.high + margin);
    return;
  }
  axis->SetLogScale(true);
  placeLogTicks(axis, range);
}

void addSeries(vtkChartXY* chart, const PlotSeries& series, std::size_t index,
               double magnification) {
  const vtkNew<vtkTable> table;
  const vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(series.name.c_str());
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    x->InsertNextValue(series.x[i]);
    y->InsertNextValue(series.y[i]);
  }
  table->AddColumn(x);
  table->AddColumn(y);
  const int marks[] = {vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE, vtkPlotPoints::DIAMOND,
                       vtkPlotPoints::CROSS, vtkPlotPoints::PLUS};
  const auto& color = palette::kSeries[index % palette::kSeries.size()];
  auto* line =
      vtkPlotPoints::SafeDownCast(chart->AddPlot(series.line ? vtkChart::LINE : vtkChart::POINTS));
  line->SetInputData(table, 0, 1);
  line->GetPen()->SetColorF(color[0], color[1], color[2]);
  line->GetBrush()->SetColorF(color[0], color[1], color[2]);
  line->SetWidth(static_cast<float>((series.line ? 2.2 : 1.0) * magnification));
  // Colours repeat with dashed lines, so that every series is distinct.
  if (series.line && index >= palette::kSeries.size())
    line->GetPen()->SetLineType(vtkPen::DASH_LINE);
  line->SetMarkerStyle(series.points ? marks[index % 5] : vtkPlotPoints::NONE);
  line->SetMarkerSize(9);
  line->SetLabel(series.name);
}

// A plot in an off-screen window.
struct Chart {
  vtkNew<vtkContextView> view;
  vtkNew<vtkChartXY> chart;

  Chart(const Plot& plot, const PictureSize& size, double magnification) {
    checkPictureSize(size);
    std::vector<PlotSeries> series;
    Range x, y;
    if (plot.from_zero) y.add(0);
    for (const PlotSeries& given : plot.series) {
      series.push_back(cleaned(plot, given));
      for (const double value : series.back().x) x.add(value);
      for (const double value : series.back().y) y.add(value);
    }
    if (x.low > x.high)
      throw Error("plot '" + plot.title + "' has no value that can be drawn" +
                  (plot.log_x || plot.log_y ? " on logarithmic axes" : ""));
    requireDisplay();

    view->GetRenderer()->SetBackground(1, 1, 1);
    view->GetRenderWindow()->SetOffScreenRendering(1);
    view->GetRenderWindow()->SetMultiSamples(8);
    view->GetRenderWindow()->SetSize(size.width, size.height);
    view->GetScene()->AddItem(chart);
    chart->SetTitle(plot.title);
    setText(chart->GetTitleProperties(), 20 * magnification, true);
    setAxis(chart->GetAxis(vtkAxis::BOTTOM), plot.x_label, plot.log_x, x, magnification);
    setAxis(chart->GetAxis(vtkAxis::LEFT), plot.y_label, plot.log_y, y, magnification);
    std::size_t index = 0;
    for (const PlotSeries& item : series)
      if (!item.x.empty()) addSeries(chart, item, index++, magnification);
    chart->SetShowLegend(index > 1);
    vtkChartLegend* legend = chart->GetLegend();
    legend->SetHorizontalAlignment(vtkChartLegend::RIGHT);
    legend->SetVerticalAlignment(vtkChartLegend::TOP);
    setText(legend->GetLabelProperties(), 15 * magnification, false);
    legend->GetBrush()->SetColorF(1, 1, 1, 0.88);
    legend->GetPen()->SetColorF(0.8, 0.82, 0.85);
    view->Render();
  }
};

} // namespace

Plot workPrecisionPlot(const WorkPrecisionTable& table) {
  Plot plot;
  plot.title = table.title;
  plot.x_label = "time [ns]";
  plot.y_label = "error [" + table.error_unit + "]";
  plot.log_x = plot.log_y = true;
  std::map<std::string, std::vector<std::pair<double, double>>> groups;
  std::vector<std::string> order;
  for (const WorkPrecisionRow& row : table.rows) {
    std::string key;
    for (const auto& [knob, value] : row.settings)
      if (value.isString()) key += (key.empty() ? "" : ", ") + value.asString();
    if (key.empty()) key = table.study;
    if (groups.find(key) == groups.end()) order.push_back(key);
    groups[key].emplace_back(row.ns, row.error);
  }
  for (const std::string& key : order) {
    const auto& points = groups[key]; // in the order of the rows: refinement, not time
    PlotSeries series;
    series.name = key;
    for (const auto& [ns, error] : points) {
      series.x.push_back(ns);
      series.y.push_back(error);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

PlotImage drawPlot(const Plot& plot, const PictureSize& size, double magnification) {
  const Chart drawn(plot, size, magnification);
  const vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(drawn.view->GetRenderWindow());
  capture->ReadFrontBufferOff();
  capture->Update();
  PlotImage image;
  image.pixels = capture->GetOutput();
  vtkAxis* x = drawn.chart->GetAxis(vtkAxis::BOTTOM);
  vtkAxis* y = drawn.chart->GetAxis(vtkAxis::LEFT);
  image.low = x->GetUnscaledMinimum();
  image.high = x->GetUnscaledMaximum();
  for (std::size_t i = 0; i < 2; ++i) {
    vtkAxis* axis = i == 0 ? x : y;
    image.from[i] = static_cast<int>(std::lround(axis->GetPoint1()[i]));
    image.to[i] = static_cast<int>(std::lround(axis->GetPoint2()[i]));
  }
  return image;
}

void writePlot(const Plot& plot, const std::filesystem::path& path, const PictureSize& size) {
  const Chart drawn(plot, size, 1);
  writeWindowPng(*drawn.view->GetRenderWindow(), path);
}

} // namespace patina
