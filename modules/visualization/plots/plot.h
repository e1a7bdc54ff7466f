// Writes plots of studies and recordings as PNG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/work_precision.h"
#include "visualization/view/picture.h"

namespace patina {

struct PlotSeries {
  std::string name; // name in the legend
  std::vector<double> x, y;
  bool points = true; // a mark at each value
  bool line = true;
};

struct Plot {
  std::string title, x_label, y_label; // labels include the unit: "time of one query [ns]"
  bool log_x = false, log_y = false;   // a log axis leaves out values that are not positive
  std::vector<PlotSeries> series;
};

// Error against time, both logarithmic. Rows with equal text settings ("sampler") form one series,
// in order of time; numeric settings ("resolution") vary along it.
Plot workPrecisionPlot(const WorkPrecisionTable& table);

// Throws Error if there is no display or no value to draw, FileError if it cannot write.
void writePlot(const Plot& plot, const std::filesystem::path& path,
               const PictureSize& size = {1100, 720});

} // namespace patina
