// Plots of studies and recordings as PNG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/work_precision.h"
#include "visualization/view/picture.h"

namespace patina {

struct PlotSeries {
  std::string name; // in the legend
  std::vector<double> x, y;
  bool points = true; // a mark at each value
  bool line = true;
};

struct Plot {
  std::string title, x_label, y_label; // labels carry their unit: "time of one query [ns]"
  bool log_x = false, log_y = false;   // values that are not positive are left out of a log axis
  std::vector<PlotSeries> series;
};

// Error against time, both logarithmic. Rows that share every text-valued knob ("sampler") form one
// series, in order of time; the numeric knobs ("resolution") run along it.
Plot workPrecisionPlot(const WorkPrecisionTable& table);

// Throws Error without a display or without a single value to draw, FileError if it cannot be
// written.
void writePlot(const Plot& plot, const std::filesystem::path& path,
               const PictureSize& size = {1100, 720});

} // namespace patina
