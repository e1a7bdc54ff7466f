// Draws plots of studies and recordings, and writes them as PNG.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

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
  bool from_zero = false; // the y axis includes 0
};

// Error against time, both logarithmic. Rows with equal text settings ("sampler") form one series,
// in order of time; numeric settings ("resolution") vary along it.
Plot workPrecisionPlot(const WorkPrecisionTable& table);

struct PlotImage {
  vtkSmartPointer<vtkImageData> pixels; // red, green and blue, in rows from the bottom
  // Ends of the axes: values of x, and pixels from the lower left corner.
  double low = 0, high = 1;
  std::array<int, 2> from{}, to{};
};

// Texts and lines are magnified. Throws Error if there is no display or no value to draw.
PlotImage drawPlot(const Plot& plot, const PictureSize& size, double magnification = 1);
// Throws as drawPlot() does, and FileError if it cannot write.
void writePlot(const Plot& plot, const std::filesystem::path& path,
               const PictureSize& size = {1100, 720});

} // namespace patina
