#include "app/studies/field/field_study.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "app/studies/field/field_candidates.h"
#include "app/studies/study_shapes.h"
#include "field/store/field_grid.h"
#include "support/node_values.h"
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
    if (row->knobs[0].second.asString() == knob) return *row;
  throw std::runtime_error("no row '" + knob + "'");
}

// T-K01a, T-K05a, F1, F15 on the study's own tables.
TEST(FieldStudy, FittedOrdersAreThoseOfTheTheory) {
  for (const std::string shape : {"sphere", "torus"}) {
    const WorkPrecisionTable& value = tableNamed("Distance on a " + shape);
    const WorkPrecisionTable& direction = tableNamed("Direction on a " + shape);
    EXPECT_NEAR(more(rowOf(value, "trilinear derivative"), "order"), 2, 0.1);
    EXPECT_NEAR(more(rowOf(value, "kim"), "order"), 2, 0.1);
    // On the torus's coarse grid some nodal slopes are one-sided, on the fine one hardly any.
    EXPECT_GT(more(rowOf(value, "high"), "order"), 2.65);
    EXPECT_LT(more(rowOf(value, "high"), "order"), shape == "sphere" ? 3.35 : 4.7);
    EXPECT_LT(rowOf(value, "high").error, 1.2 * rowOf(value, "quadratic spline").error);
    EXPECT_NEAR(more(rowOf(direction, "trilinear derivative"), "order"), 1, 0.1);
    EXPECT_GE(more(rowOf(direction, "kim"), "order"), 1.9);
    EXPECT_GE(more(rowOf(direction, "quadratic spline"), "order"), 1.9);
    EXPECT_EQ(direction.order_fitted, more(rowOf(direction, "kim"), "order"));
    EXPECT_EQ(value.order_fitted, more(rowOf(value, "high"), "order"));
    EXPECT_EQ(value.order_expected, 3.0);
  }
}

// F1: the derivative of the trilinear interpolant is the wrong direction.
TEST(FieldStudy, NodalGradientsBeatTheTrilinearDerivative) {
  const WorkPrecisionTable& table = tableNamed("Direction on a sphere");
  EXPECT_GT(rowOf(table, "trilinear derivative").error, 50 * rowOf(table, "kim").error);
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
  EXPECT_EQ(quickTables<fieldStudy>().size(), 8U);
  for (const WorkPrecisionTable& table : quickTables<fieldStudy>())
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_GT(row.ns, 0) << table.title;
      EXPECT_GT(more(row, "random order [ns]"), 0) << table.title;
      EXPECT_GT(row.bytes, 0) << table.title;
      EXPECT_GT(row.error, 0) << table.title;
      EXPECT_LE(row.error, row.error_max) << table.title;
    }
}

// Facets set a floor that falls with the triangles. The spline follows them more closely than
// nodal slopes do, the more so the finer they are: why it is not `high` (docs/studies.md).
TEST(FieldStudy, FacetsLimitEverySamplerOnAMesh) {
  const WorkPrecisionTable& table = tableNamed("Direction on a sphere of triangles");
  ASSERT_EQ(table.rows.size(), 8U);
  EXPECT_GT(table.rows[1].error, 2 * table.rows[5].error);
  EXPECT_GT(table.rows[3].error, 1.1 * table.rows[2].error);
  EXPECT_GT(table.rows[7].error, 2 * table.rows[6].error);
  EXPECT_GT(more(table.rows[2], "value rms [m]"), 5 * more(table.rows[6], "value rms [m]"));
}

TEST(FieldStudy, LayoutsOfTheSameNodesAgree) {
  const WorkPrecisionTable& table = tableNamed("Layouts");
  const WorkPrecisionRow& stored = rowOf(table, "9^3 blocks, gradient stored");
  EXPECT_EQ(table.rows.size(), 6U);
  for (const WorkPrecisionRow& row : table.rows) {
    // Made on the fly a slope is one difference, stored it is the mean of nine.
    const std::string layout = row.knobs[0].second.asString();
    const bool stored_slopes = layout.find("on the fly") == std::string::npos;
    EXPECT_LT(row.error, (stored_slopes ? 1.05 : 1.3) * stored.error) << layout;
    EXPECT_GT(row.error, (stored_slopes ? 0.95 : 1.1) * stored.error) << layout;
    EXPECT_NEAR(more(row, "value rms [m]"), more(stored, "value rms [m]"), 1e-8);
  }
}

TEST(FieldStudy, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fieldStudy(StudyOptions{.quick = true}, progress), Cancelled);
}

TEST(QuadraticSpline, InterpolatesTheNodesAndItsGradientIsItsDerivative) {
  const StudyShape torus = studyShapes()[1];
  const FieldGrid grid = gridAround(torus.bounds, {.resolution = 80, .voxel = {}, .band = 8});
  const SurfaceField field = sampleFunction(torus.distance, grid, 8);
  const QuadraticSpline spline(field);
  const Vec3 near = grid.toGrid(Vec3(0.05, 0, 0)).array().round();
  for (int n = 0; n < 50; ++n) {
    const Vec3 node = near + Vec3(-(n % 3), n % 7 - 3, n % 5 - 2);
    const float stored = test::phiAt(field, static_cast<int>(node.x()), static_cast<int>(node.y()),
                                     static_cast<int>(node.z()));
    ASSERT_LT(std::abs(stored), 4);
    EXPECT_NEAR(spline.atGrid(node).phi, stored, 1e-5);
    const Vec3 q = node + Vec3(0.31, -0.27, 0.11);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = 0.05 * Vec3::Unit(axis);
      const double slope = (spline.atGrid(q + step).phi - spline.atGrid(q - step).phi) / 0.1;
      EXPECT_NEAR(spline.atGrid(q).gradient[axis], slope, 1e-4);
    }
  }
}

// The closed forms that everything is measured against.
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
