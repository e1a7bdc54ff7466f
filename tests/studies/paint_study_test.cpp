#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/study_rows.h"

namespace patina {
namespace {

using test::knob;
using test::more;

class PaintStudy : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Progress progress;
    paint() = paintStudy(StudyOptions{.quick = true}, progress);
    material() = materialStudy(StudyOptions{.quick = true}, progress);
  }
  static std::vector<WorkPrecisionTable>& paint() {
    static std::vector<WorkPrecisionTable> tables;
    return tables;
  }
  static std::vector<WorkPrecisionTable>& material() {
    static std::vector<WorkPrecisionTable> tables;
    return tables;
  }
  static const WorkPrecisionTable& table(const std::string& begins) {
    for (const auto* all : {&paint(), &material()})
      for (const WorkPrecisionTable& one : *all)
        if (one.title.starts_with(begins)) return one;
    throw std::out_of_range(begins);
  }
};

TEST_F(PaintStudy, EveryRowHasErrorAndTime) {
  for (const auto* all : {&paint(), &material()})
    for (const WorkPrecisionTable& one : *all)
      for (const WorkPrecisionRow& row : one.rows) {
        EXPECT_GT(row.ns, 0) << one.title;
        EXPECT_TRUE(std::isfinite(row.error) && row.error_max >= row.error * 0.999) << one.title;
      }
}

// T-K17: a hard edge on a lattice of texels. The variance of the area is that of its edge: h^3.
TEST_F(PaintStudy, CoverageConvergesLikeALatticeUnderASharpEdge) {
  const WorkPrecisionTable& one = table("Area");
  EXPECT_NEAR(*one.order_fitted, 1.5, 0.4);
  for (const WorkPrecisionRow& row : one.rows)
    EXPECT_LT(row.error_max, knob(row, "falloff") > 3 ? 2 : 0.2);
}

// T-K21b, F8: loss of the trilinear field at a crest between its nodes.
TEST_F(PaintStudy, BakedReliefLosesDetailBelowTheVoxel) {
  const WorkPrecisionTable& one = table("Relief baked (kim)");
  EXPECT_NEAR(*one.order_fitted, 2, 0.2);
  for (const WorkPrecisionRow& row : one.rows) {
    const double theory = more(row, "lost by theory [%]");
    EXPECT_NEAR(row.error_max, theory, 0.1 * theory);
  }
}

// The limit is 1 % at 2.5 voxels, 22 texels to a wavelength.
TEST_F(PaintStudy, PulledReliefKeepsItsHeightAtAnyVoxel) {
  for (const WorkPrecisionRow& row : table("Relief pulled: ").rows) {
    EXPECT_GE(knob(row, "texels a wavelength"), 22);
    EXPECT_LT(row.error_max, 1) << knob(row, "voxels a wavelength");
    EXPECT_LT(more(row, "crest lost [%]"), 1);
  }
  EXPECT_NEAR(*table("Relief pulled, by its image").order_fitted, 3, 0.35);
}

TEST_F(PaintStudy, RaisedSphereHasTheExpectedSize) {
  for (const WorkPrecisionRow& row : table("A sphere raised").rows)
    EXPECT_LT(row.error_max, 5e-6); // some h^2 / 4R and the facets
}

TEST_F(PaintStudy, PaintedStiffnessIsTrilinear) {
  EXPECT_NEAR(*table("Stiffness felt").order_fitted, 2, 0.2);
}

// T-K22d.
TEST_F(PaintStudy, WorkAroundALoopMatchesTheClosedForm) {
  for (const WorkPrecisionRow& row : table("Work round").rows) {
    const double share = more(row, "of 0.5 (K2 - K1) d^2 [%]");
    const bool literal = row.settings[0].second.asString() == "literal";
    EXPECT_NEAR(share, literal ? 100 : 0, 1) << row.settings[0].second.asString();
  }
}

} // namespace
} // namespace patina
