// Work-precision table (Hairer & Wanner): error against run time, one row per setting.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"

namespace patina {

struct WorkPrecisionRow {
  std::vector<std::pair<std::string, Json>>
      settings;         // ("sampler", "high"), ("resolution", 150) ...
  double error = 0;     // mean or RMS, in the table's error_unit
  double error_max = 0; // same unit
  double ns = 0;        // time of one query, or of the whole build if the settings name it
  double bytes = 0;
  std::vector<std::pair<std::string, double>> more; // further columns, names with units
};

struct WorkPrecisionTable {
  std::string study;      // "field"
  std::string title;      // "Distance on an analytic sphere"
  std::string error_unit; // "m", "deg", "%"
  std::vector<WorkPrecisionRow> rows;
  std::optional<double> order_fitted;   // d log error / d log h over successive refinements
  std::optional<double> order_expected; // theoretical order; the title cites its source
};

// Least-squares slope of log(error) over log(h). Throws std::invalid_argument unless there are two
// or more positive, finite points.
double fittedOrder(const std::vector<double>& h, const std::vector<double>& error);

// Machine, compiler, scheduling policy and load average, to interpret a published number.
Json machineDescription();

Json toJson(const WorkPrecisionTable& table);
void writeCsv(const std::filesystem::path& path, const WorkPrecisionTable& table);

} // namespace patina
