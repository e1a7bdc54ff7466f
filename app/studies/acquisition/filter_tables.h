// The tables of the filter study, and what they have in common.
#pragma once

#include "app/studies/query_timing.h"
#include "app/studies/study.h"

namespace patina {

inline WorkPrecisionTable filterTable(const std::string& title, const std::string& unit) {
  return {"filter", title, unit, {}, std::nullopt, std::nullopt};
}

WorkPrecisionTable gainTable();
WorkPrecisionTable heightTable(const StudyOptions& options, Progress& progress);
WorkPrecisionTable stiffnessTable(const StudyOptions& options, Progress& progress);

} // namespace patina
