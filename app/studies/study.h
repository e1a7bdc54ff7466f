// Studies: error against run time, one row a setting (`patina study`).
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
  bool thorough = false; // ten times as much of what is drawn at random
};

struct Study {
  std::string_view name;  // on the command line
  std::string_view about; // one line
  // Reports to `progress` and throws Cancelled.
  std::vector<WorkPrecisionTable> (*run)(const StudyOptions&, Progress&);
};

// A table without rows yet; tablesOf() names its study.
inline WorkPrecisionTable tableOf(const std::string& title, const std::string& unit) {
  return {"", title, unit, {}, std::nullopt, std::nullopt};
}

// One table of a study, and what of the whole is done when it begins.
struct StudyPart {
  double from = 0;
  std::string about;
  std::function<WorkPrecisionTable()> table;
};
std::vector<WorkPrecisionTable> tablesOf(const std::vector<StudyPart>& parts, Progress& progress);

// Rows over refinements of one kind: what they measured against their voxels.
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

// All of them, in the order in which `patina study all` runs them.
const std::vector<Study>& studies();
// What the study measures, each table under its name.
std::vector<WorkPrecisionTable> tablesOf(const Study& study, const StudyOptions& options,
                                         Progress& progress);

} // namespace patina
