#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "app/studies/haptics/contact_test_path.h"
#include "support/study_rows.h"

namespace patina {
namespace {

using test::more;
using test::quickTables;

TEST(ContactStudy, IsRegistered) {
  const auto& all = studies();
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const Study& s) { return s.name == "contact"; }));
}

// T-K06b in the study's report.
TEST(ContactStudy, ContactPointOfTheRayIsOfOrderTwo) {
  const WorkPrecisionTable& order = quickTables<contactStudy>().at(4);
  ASSERT_TRUE(order.order_fitted && order.order_expected);
  EXPECT_NEAR(*order.order_fitted, *order.order_expected, 0.2);
}

TEST(ContactStudy, ComparesProxyAndRayInEveryTable) {
  for (const WorkPrecisionTable& table : std::span(quickTables<contactStudy>()).first(5)) {
    const auto rowsOf = [&](const std::string& method) {
      return std::count_if(table.rows.begin(), table.rows.end(), [&](const auto& row) {
        return std::any_of(row.settings.begin(), row.settings.end(), [&](const auto& knob) {
          return knob.first == "contact" && knob.second.asString() == method;
        });
      });
    };
    EXPECT_GT(rowsOf("proxy"), 0) << table.title;
    EXPECT_EQ(rowsOf("proxy"), rowsOf("ray")) << table.title;
  }
}

TEST(ContactStudy, EveryRowIsMeasuredAndLosesNoTick) {
  EXPECT_EQ(quickTables<contactStudy>().size(), 6u);
  for (const WorkPrecisionTable& table : quickTables<contactStudy>()) {
    EXPECT_GE(table.rows.size(), 4u) << table.title;
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_GT(row.ns, 0) << table.title;
      EXPECT_GT(row.bytes, 0) << table.title;
      EXPECT_TRUE(std::isfinite(row.error) && row.error <= row.error_max) << table.title;
      const double lost = more(row, "lost ticks");
      EXPECT_TRUE(std::isnan(lost) || lost == 0) << table.title;
    }
  }
}

TEST(ContactStudy, SlidesAtTheDynamicCoefficient) {
  for (const WorkPrecisionRow& row : quickTables<contactStudy>()[1].rows)
    EXPECT_NEAR(more(row, "Coulomb ratio"), 0.3, 0.002)
        << row.settings[0].second.asString() << " on " << row.settings[1].second.asString();
}

// The last table has both in one row.
TEST(ContactStudy, ComparesProxyAndRayWithTheExactProxyOnEveryShape) {
  const WorkPrecisionTable& table = quickTables<contactStudy>().back();
  std::set<std::string> shapes;
  int better = 0;
  double proxy_loop = 0, ray_loop = 0;
  for (const WorkPrecisionRow& row : table.rows) {
    const std::string& shape = row.settings.at(0).second.asString();
    shapes.insert(shape);
    EXPECT_GE(more(row, "ticks in contact"), 300) << shape;
    for (const char* none : {"lost ticks", "pulling ticks", "fault ticks"})
      EXPECT_EQ(more(row, none), 0) << shape << ": " << none;
    EXPECT_LE(more(row, "step excess [N]"), 0.05) << shape;
    EXPECT_LE(more(row, "p50 [N]"), row.error) << shape;
    EXPECT_LE(row.error, 1) << shape; // the force is 3 N, on a coarse grid
    EXPECT_GE(more(row, "samples"), 1) << shape;
    EXPECT_LE(more(row, "most samples"), 40) << shape;
    for (const std::string method : {"", "ray "}) {
      EXPECT_LE(more(row, method + "p99 [ns]"), more(row, method + "p99.9 [ns]")) << shape;
      EXPECT_LE(more(row, method + "p50 [N]"), 1) << shape;
    }
    EXPECT_GT(row.ns, 0) << shape;
    EXPECT_LE(row.ns, more(row, "p99 [ns]")) << shape;
    EXPECT_GT(more(row, "ray ns"), 0) << shape;
    better += row.error <= 1.01 * more(row, "ray p99 [N]");
    proxy_loop = std::max(proxy_loop, more(row, "worst loop [J]"));
    ray_loop = std::max(ray_loop, more(row, "ray worst loop [J]"));
  }
  EXPECT_EQ(shapes.size(), 8u);
  EXPECT_GE(better, static_cast<int>(table.rows.size()) / 2);
  EXPECT_LE(proxy_loop, 10e-6);
  EXPECT_GT(ray_loop, 10 * proxy_loop);
}

// The reference is perpendicular where it must be and moves as defined.
TEST(ContactTestPath, ReferenceFollowsItsDefinition) {
  const ContactTest test = makeContactTest({.tip_radius = 0.02, .friction = true});
  ASSERT_EQ(test.tips.size(), 20000u);
  ASSERT_EQ(test.lead_in.size(), 300u);
  EXPECT_NEAR(test.lead_in.front().norm(), 1.3 * 0.05, 1e-12);
  for (std::size_t i = 1; i + 1 < test.tips.size(); i += 97) {
    const double depth = 0.05 * 1.02 - test.tips[i].norm();
    const Vec3 n = test.tips[i].normalized();
    EXPECT_NEAR(test.reference[i].dot(n), 1000 * depth, 1e-9);
    const Vec3 drag = test.reference[i] - 1000 * depth * n;
    EXPECT_NEAR(drag.norm(), 300 * depth, 1e-9);
    // Friction opposes the motion, computed by central differences.
    Vec3 motion = test.tips[i + 1].normalized() - test.tips[i - 1].normalized();
    motion -= motion.dot(n) * n;
    EXPECT_NEAR(drag.normalized().dot(motion.normalized()), -1, 1e-4);
  }
}

} // namespace
} // namespace patina
