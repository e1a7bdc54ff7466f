#include "visualization/plots/replay_plot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "visualization/values/palette.h"

namespace patina {
namespace {

// The greatest force of each part of the time, so that a long recording keeps its peaks.
PlotSeries forceOverTime(const std::vector<ToolSample>& samples, std::size_t parts) {
  PlotSeries series{"force", {}, {}, false};
  const double begin = samples.front().t, span = samples.back().t - begin;
  std::size_t part = 0;
  for (const ToolSample& sample : samples) {
    const double along = span > 0 ? (sample.t - begin) / span : 0;
    const auto in = static_cast<std::size_t>(along * static_cast<double>(parts));
    if (series.x.empty() || in != part) {
      series.x.push_back(sample.t - begin);
      series.y.push_back(sample.force.norm());
      part = in;
    } else if (sample.force.norm() > series.y.back()) {
      series.x.back() = sample.t - begin;
      series.y.back() = sample.force.norm();
    }
  }
  return series;
}

} // namespace

ReplayPlot::ReplayPlot(const std::vector<ToolSample>& samples, const PictureSize& size,
                       double magnification)
    : begin_(samples.front().t),
      line_(std::max(1, static_cast<int>(std::lround(2 * magnification)))) {
  const PlotSeries force = forceOverTime(samples, static_cast<std::size_t>(size.width));
  plot_ = drawPlot({"", "time [s]", "force [N]", false, false, {force}, true}, size, magnification);
}

vtkSmartPointer<vtkImageData> ReplayPlot::beside(vtkImageData& picture,
                                                 const ToolSample& now) const {
  const int wide = picture.GetDimensions()[0], high = picture.GetDimensions()[1];
  const int more = plot_.pixels->GetDimensions()[0];
  if (plot_.pixels->GetDimensions()[1] != high)
    throw std::invalid_argument("force plot: the picture has another height");
  auto all = vtkSmartPointer<vtkImageData>::New();
  all->SetDimensions(wide + more, high, 1);
  all->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto row = [](vtkImageData& image, int y) {
    return static_cast<unsigned char*>(image.GetScalarPointer()) +
           std::ptrdiff_t{3} * image.GetDimensions()[0] * y;
  };
  for (int y = 0; y < high; ++y) {
    unsigned char* to = std::copy_n(row(picture, y), 3 * wide, row(*all, y));
    std::copy_n(row(*plot_.pixels, y), 3 * more, to);
  }
  const double part = (now.t - begin_ - plot_.low) / (plot_.high - plot_.low);
  const int column =
      static_cast<int>(std::lround(plot_.from[0] + part * (plot_.to[0] - plot_.from[0])));
  for (int y = std::max(0, plot_.from[1]); y < std::min(high, plot_.to[1]); ++y)
    for (int x = column - line_ / 2; x < column - line_ / 2 + line_; ++x) {
      if (x < 0 || x >= more) continue;
      for (int c = 0; c < 3; ++c)
        row(*all, y)[3 * (wide + x) + c] = static_cast<unsigned char>(
            std::lround(255 * palette::kTool[static_cast<std::size_t>(c)]));
    }
  return all;
}

} // namespace patina
