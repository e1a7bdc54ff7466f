// Force of a recording over time, beside the picture of its replay.
#pragma once

#include <vector>

#include "scene/tool_sample.h"
#include "visualization/plots/plot.h"

namespace patina {

class ReplayPlot {
 public:
  // Draws |force| of the samples, of which there must be one. Throws as drawPlot() does.
  ReplayPlot(const std::vector<ToolSample>& samples, const PictureSize& size, double magnification);

  // Returns the picture with the plot at its right; a vertical line marks the sample's time.
  // `picture`: red, green and blue, as high as the plot.
  vtkSmartPointer<vtkImageData> beside(vtkImageData& picture, const ToolSample& now) const;

 private:
  PlotImage plot_;
  double begin_ = 0; // time of the first sample [s]
  int line_ = 1;     // width of the line [pixels]
};

} // namespace patina
