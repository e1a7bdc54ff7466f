#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "picture/picture_support.h"
#include "visualization/plots/plot.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

WorkPrecisionTable table() {
  WorkPrecisionTable result;
  result.study = "field";
  result.title = "Distance on an analytic sphere";
  result.error_unit = "m";
  for (const char* sampler : {"kim", "high"})
    for (const int n : {64, 128, 256, 512}) {
      WorkPrecisionRow row;
      row.settings = {{"sampler", sampler}, {"resolution", n}};
      const bool high = std::string(sampler) == "high";
      row.error = high ? 2e-2 * std::pow(n, -3.0) : 1e-3 * std::pow(n, -2.0);
      row.ns = (high ? 60 : 40) * std::pow(n / 64.0, 0.35);
      result.rows.push_back(row);
    }
  return result;
}

Pixels drawn(const Plot& plot, const std::string& name) {
  const char* keep = std::getenv("PATINA_KEEP_PICTURES");
  const fs::path folder = keep != nullptr ? fs::path(keep) : fs::temp_directory_path();
  const fs::path path = folder / (name + (keep ? "" : "-" + std::to_string(getpid())) + ".png");
  writePlot(plot, path);
  Pixels pixels(path);
  if (keep == nullptr) fs::remove(path);
  return pixels;
}

TEST(Plot, GroupsRowsByTextColumnsInOrderOfTime) {
  const Plot plot = workPrecisionPlot(table());
  ASSERT_EQ(plot.series.size(), 2U);
  EXPECT_EQ(plot.series[0].name, "kim");
  EXPECT_EQ(plot.series[1].name, "high");
  EXPECT_TRUE(std::is_sorted(plot.series[1].x.begin(), plot.series[1].x.end()));
  EXPECT_EQ(plot.y_label, "error [m]");
  EXPECT_TRUE(plot.log_x && plot.log_y);
}

TEST(Plot, DrawsEverySeriesInItsColour) {
  PATINA_NEEDS_DISPLAY();
  const Pixels pixels = drawn(workPrecisionPlot(table()), "plot");
  EXPECT_GT(pixels.share([](const Vec3& c) { return c.minCoeff() > 250; }), 0.7);
  EXPECT_GT(pixels.share(isCool), 0.002); // kim
  EXPECT_GT(pixels.share(isWarm), 0.002); // high
}

TEST(Plot, DrawsLinearAxes) {
  PATINA_NEEDS_DISPLAY();
  Plot plot;
  plot.title = "Force along a press";
  plot.x_label = "t [s]";
  plot.y_label = "force [N]";
  PlotSeries series{"|F|", {}, {}, false, true};
  for (int i = 0; i < 500; ++i) {
    series.x.push_back(i * 0.01);
    series.y.push_back(1.2 * std::sin(i * 0.02));
  }
  plot.series.push_back(series);
  EXPECT_GT(drawn(plot, "line").share(isCool), 0.002);
}

TEST(Plot, NothingToDrawIsAnError) {
  Plot plot;
  plot.log_y = true;
  plot.series.push_back({"negative", {1, 2}, {-1, 0}});
  EXPECT_THROW(writePlot(plot, "never.png"), Error);
}

} // namespace
} // namespace patina
