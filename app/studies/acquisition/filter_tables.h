// The tables of the filter study, and what they have in common.
#pragma once

#include <ctime>

#include "app/studies/study.h"

namespace patina {

inline WorkPrecisionTable filterTable(const std::string& title, const std::string& unit) {
  return {"filter", title, unit, {}, std::nullopt, std::nullopt};
}

inline double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

WorkPrecisionTable gainTable();
WorkPrecisionTable heightTable(const StudyOptions& options, Progress& progress);
WorkPrecisionTable stiffnessTable(const StudyOptions& options, Progress& progress);

} // namespace patina
