// Plots of a field in windows of their own, each of which can be saved as a table.
#pragma once

#include <vector>

#include <QString>
#include <QWidget>

#include "app/gui/toolkit/plot.h"
#include "core/csv.h"
#include "field/sampling/line_profile.h"
#include "visualization/layers/slice_layer.h"

namespace patina {

struct FieldPlot {
  const char* name; // object name of the window
  QString title, note;
  PlotContent content;
  CsvTable table;
  QString file; // proposed for the table
};

FieldPlot profilePlot(const std::vector<LineSample>& profile);
// Area of the slice over the distance, of points one voxel apart.
FieldPlot histogramPlot(const FieldPlane& slice, double voxel);

// Replaces the plot of the same name.
void showPlot(QWidget& over, FieldPlot plot);

} // namespace patina
