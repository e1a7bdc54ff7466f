// Limits of contact that hold on any shape.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "core/percentiles.h"
#include "support/longer.h"

namespace patina::test {

inline constexpr double kWorstStep = 0.05; // [N] beyond 2 K |dx| + K v_s dt
inline constexpr double kMaxOf = 1e-6;     // share of the ticks in contact
inline constexpr double kMaxSamples = 12;  // field evaluations of a tick that began in contact
inline constexpr double kMaxEntrySamples = 40;

// pulls_allowed: number in one scene; the sum over all scenes is judged later.
inline void expectFaultless(const TrialReport& report, const std::string& what,
                            double pulls_allowed = 0) {
  const double most = kMaxOf * static_cast<double>(report.contacts);
  EXPECT_LE(static_cast<double>(report.lost), most) << what << ": of " << report.contacts;
  EXPECT_LE(static_cast<double>(report.pulls), std::max(most, pulls_allowed))
      << what << ": of " << report.contacts;
  EXPECT_EQ(report.faults, 0) << what;
  EXPECT_LE(report.worst_excess, kWorstStep) << what;
  EXPECT_EQ(report.unverified, 0) << what;
  EXPECT_LE(percentiles(report.samples).max, kMaxSamples) << what;
  EXPECT_LE(percentiles(report.entry_samples).max, kMaxEntrySamples) << what;
}

// [N], at 500 N/m on 100 mm and 150 voxels.
inline void expectExact(const TrialReport& report, const std::string& what) {
  const Percentiles error = percentiles(report.error);
  EXPECT_LE(error.p50, 0.01) << what;
  EXPECT_LE(error.p99, 0.10) << what;
  EXPECT_LE(error.p999, 0.40) << what;
}

} // namespace patina::test
