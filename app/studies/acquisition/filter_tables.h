// Tables of the filter study and their common header.
#pragma once

#include "app/studies/framework/query_timing.h"
#include "app/studies/framework/study.h"

namespace patina {

inline WorkPrecisionTable filterTable(const std::string& title, const std::string& unit) {
  return {"filter", title, unit, {}, std::nullopt, std::nullopt};
}

WorkPrecisionTable heightTable(const StudyOptions& options, Progress& progress);
WorkPrecisionTable stiffnessTable(const StudyOptions& options, Progress& progress);

} // namespace patina
