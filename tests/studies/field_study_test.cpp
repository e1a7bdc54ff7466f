#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "app/studies/field/study_shapes.h"
#include "support/study_rows.h"

namespace patina {
namespace {

using test::more;
using test::quickTables;

const WorkPrecisionTable& tableNamed(const std::string& start) {
  for (const WorkPrecisionTable& table : quickTables<fieldStudy>())
    if (table.title.rfind(start, 0) == 0) return table;
  throw std::runtime_error("no table '" + start + "'");
}

// The row of the finest grid.
const WorkPrecisionRow& rowOf(const WorkPrecisionTable& table, const std::string& knob) {
  for (auto row = table.rows.rbegin(); row != table.rows.rend(); ++row)
    if (row->settings[0].second.asString() == knob) return *row;
  throw std::runtime_error("no row '" + knob + "'");
}

// T-K01a, T-K05a, F1, F15 on the study's own tables.
TEST(FieldStudy, FittedOrdersMatchTheTheory) {
  for (const std::string shape : {"sphere", "torus"}) {
    const WorkPrecisionTable& value = tableNamed("Distance on a " + shape);
    const WorkPrecisionTable& direction = tableNamed("Direction on a " + shape);
    EXPECT_NEAR(more(rowOf(value, "kim"), "order"), 2, 0.1);
    // Some nodal slopes of the torus are one-sided on the coarse grid, hardly any on the fine one.
    EXPECT_GT(more(rowOf(value, "high"), "order"), 2.65);
    EXPECT_LT(more(rowOf(value, "high"), "order"), shape == "sphere" ? 3.35 : 4.7);
    EXPECT_GE(more(rowOf(direction, "kim"), "order"), 1.9);
    EXPECT_EQ(direction.order_fitted, more(rowOf(direction, "kim"), "order"));
    EXPECT_EQ(value.order_fitted, more(rowOf(value, "high"), "order"));
    EXPECT_EQ(value.order_expected, 3.0);
  }
}

TEST(FieldStudy, SeparatesCreasesFromSmoothRegions) {
  const WorkPrecisionTable& table = tableNamed("Direction on a box");
  const WorkPrecisionRow& row = rowOf(table, "kim");
  EXPECT_LT(more(row, "smooth_max [deg]"), 0.1);
  EXPECT_GT(more(row, "crease_max [deg]"), 30);
  EXPECT_LE(more(row, "crease_p50 [deg]"), more(row, "crease_p95 [deg]"));
  EXPECT_TRUE(
      std::isnan(more(rowOf(tableNamed("Direction on a sphere"), "kim"), "crease_max [deg]")));
}

TEST(FieldStudy, EveryRowIsMeasuredInAllItsColumns) {
  EXPECT_EQ(quickTables<fieldStudy>().size(), 7U);
  for (const WorkPrecisionTable& table : quickTables<fieldStudy>())
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_GT(row.ns, 0) << table.title;
      EXPECT_GT(more(row, "random order [ns]"), 0) << table.title;
      EXPECT_GT(row.bytes, 0) << table.title;
      EXPECT_GT(row.error, 0) << table.title;
      EXPECT_LE(row.error, row.error_max) << table.title;
    }
}

// Facets set an error floor that falls with the triangles.
TEST(FieldStudy, FacetsLimitEverySamplerOnAMesh) {
  const WorkPrecisionTable& table = tableNamed("Direction on a sphere of triangles");
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_GT(table.rows[0].error, 2 * table.rows[2].error);
  EXPECT_GT(more(table.rows[1], "value rms [m]"), 5 * more(table.rows[3], "value rms [m]"));
}

TEST(FieldStudy, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fieldStudy(StudyOptions{.quick = true}, progress), Cancelled);
}

// The closed forms are the reference of all tables.
TEST(StudyShapes, GradientsAreUnitDerivativesOfTheDistance) {
  for (const StudyShape& shape : studyShapes())
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = 0.05 * Vec3(std::sin(1.1 * n), std::sin(2.3 * n + 1), std::cos(3.7 * n));
      if (shape.from_crease(p) < 0.02 || std::abs(shape.distance(p)) > 0.005) continue;
      const Vec3 gradient = shape.gradient(p);
      EXPECT_NEAR(gradient.norm(), 1, 1e-12);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 1e-6 * Vec3::Unit(axis);
        const double slope = (shape.distance(p + step) - shape.distance(p - step)) / 2e-6;
        EXPECT_NEAR(gradient[axis], slope, 1e-4) << shape.name;
      }
    }
}

} // namespace
} // namespace patina
