// Reads a study's row by the names of its columns.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/studies/framework/studies.h"
#include "core/progress.h"
#include "core/work_precision.h"

namespace patina::test {

// Returns the tables of a study's short form, made once a program.
template <auto Study> const std::vector<WorkPrecisionTable>& quickTables() {
  static const std::vector<WorkPrecisionTable> tables = [] {
    Progress progress;
    return Study(StudyOptions{.quick = true}, progress);
  }();
  return tables;
}

// Returns NaN, which satisfies no bound, if there is no such column.
inline double more(const WorkPrecisionRow& row, const std::string& column) {
  for (const auto& [name, value] : row.more)
    if (name == column) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

inline double knob(const WorkPrecisionRow& row, const std::string& column) {
  for (const auto& [name, value] : row.settings)
    if (name == column) return value.asNumber();
  ADD_FAILURE() << "no knob " << column;
  return std::numeric_limits<double>::quiet_NaN();
}

inline std::string word(const WorkPrecisionRow& row, const std::string& column) {
  for (const auto& [name, value] : row.settings)
    if (name == column) return value.asString();
  ADD_FAILURE() << "no knob " << column;
  return {};
}

} // namespace patina::test
