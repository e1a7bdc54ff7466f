// Studies: error against run time, one row per setting (`patina study`).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/work_precision.h"

namespace patina {

struct StudyOptions {
  bool quick = false;    // fewer points and coarser grids: seconds, for the tests
  bool thorough = false; // ten times as many random samples
};

struct Study {
  std::string_view name;  // on the command line
  std::string_view about; // one line
  // Reports to `progress` and throws Cancelled.
  std::vector<WorkPrecisionTable> (*run)(const StudyOptions&, Progress&);
};

// Empty table; tablesOf() sets its study.
inline WorkPrecisionTable tableOf(const std::string& title, const std::string& unit) {
  return {"", title, unit, {}, std::nullopt, std::nullopt};
}

// One table of a study; `from` is the progress at its start.
struct StudyPart {
  double from = 0;
  std::string about;
  std::function<WorkPrecisionTable()> table;
};
std::vector<WorkPrecisionTable> tablesOf(const std::vector<StudyPart>& parts, Progress& progress);

// Measured errors against voxel size, for a fit of the order.
struct OrderFit {
  std::vector<double> voxels, errors;
  void add(double voxel, double error) {
    voxels.push_back(voxel);
    errors.push_back(error);
  }
  void into(WorkPrecisionTable& table, double expected) const {
    table.order_fitted = fittedOrder(voxels, errors);
    table.order_expected = expected;
  }
};

} // namespace patina
