// Error against run time, in one row: the table every study prints (owner's first demand).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"

namespace patina {

struct WorkPrecisionRow {
  std::vector<std::pair<std::string, Json>> knobs; // ("sampler", "high"), ("resolution", 150) ...
  double error = 0;                                // mean or rms, in the table's error_unit
  double error_max = 0;                            // same unit
  double ns = 0; // time of one query, or of the whole build if the knobs say so
  double bytes = 0;
  std::vector<std::pair<std::string, double>>
      more; // further measured columns, with units in the name
};

struct WorkPrecisionTable {
  std::string study;      // "field"
  std::string title;      // "Distance on an analytic sphere"
  std::string error_unit; // "m", "deg", "%"
  std::vector<WorkPrecisionRow> rows;
  std::optional<double> order_fitted;   // d log error / d log h over successive refinements
  std::optional<double> order_expected; // theory, with its item in the title
};

// Least-squares slope of log(error) on log(h). Needs two points or more, all positive; throws
// std::invalid_argument otherwise.
double fittedOrder(const std::vector<double>& h, const std::vector<double>& error);

// Machine, compiler, scheduling policy, load average: so that a published number can be read.
Json machineDescription();

Json toJson(const WorkPrecisionTable& table);
void writeCsv(const std::filesystem::path& path, const WorkPrecisionTable& table);

} // namespace patina
