// What contact must hold to on any shape.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "app/studies/contact/course.h"
#include "core/percentiles.h"
#include "support/longer.h"

namespace patina::test {

inline constexpr double kWorstStep = 0.05; // [N] beyond 2 K |dx| + K v_s dt
inline constexpr double kMostOf = 1e-6;    // of the ticks in contact
inline constexpr double kMostSamples = 12; // of the field, a tick that began in contact
inline constexpr double kMostEntrySamples = 40;

// pulls_allowed: in one scene, where all of them are judged together after.
inline void expectFaultless(const CourseReport& report, const std::string& what,
                            double pulls_allowed = 0) {
  const double most = kMostOf * static_cast<double>(report.contacts);
  EXPECT_LE(static_cast<double>(report.lost), most) << what << ": of " << report.contacts;
  EXPECT_LE(static_cast<double>(report.pulls), std::max(most, pulls_allowed))
      << what << ": of " << report.contacts;
  EXPECT_EQ(report.faults, 0) << what;
  EXPECT_LE(report.worst_excess, kWorstStep) << what;
  EXPECT_EQ(report.unjudged, 0) << what;
  EXPECT_LE(percentiles(report.samples).max, kMostSamples) << what;
  EXPECT_LE(percentiles(report.entry_samples).max, kMostEntrySamples) << what;
}

// [N], at 500 N/m on 100 mm and 150 voxels.
inline void expectExact(const CourseReport& report, const std::string& what) {
  const Percentiles error = percentiles(report.error);
  EXPECT_LE(error.p50, 0.01) << what;
  EXPECT_LE(error.p99, 0.10) << what;
  EXPECT_LE(error.p999, 0.40) << what;
}

} // namespace patina::test
