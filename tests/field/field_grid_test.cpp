#include "field/store/field_grid.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "field/analytic_fields.h"

namespace patina {
namespace {

FieldSpec spec(int resolution, double band = 8) {
  return {.resolution = resolution, .voxel = std::nullopt, .band = band};
}

TEST(FieldGrid, HasTheRequestedCellsAlongTheLongestSideIncludingBands) {
  const FieldGrid grid = gridAround(Box3(Vec3(1, 2, 3), Vec3(1.1, 2.05, 3.02)), spec(150));
  EXPECT_EQ(grid.nodes[0], 151);
  EXPECT_NEAR(grid.voxel, 0.1 / 134, 1e-15);
  EXPECT_EQ(grid.nodes[1], 67 + 16 + 1);
}

TEST(FieldGrid, CoversTheBoxGrownByTheBand) {
  for (const double width : {1e-6, 0.013, 0.4, 1.0}) {
    const Box3 box(Vec3(-5, 0.1, 7), Vec3(-4, 0.1 + width, 7 + width / 3));
    const FieldGrid grid = gridAround(box, spec(97, 5));
    const Vec3 reach = Vec3::Constant(5 * grid.voxel * (1 - 1e-6));
    const Vec3 last = grid.toWorld(Vec3(grid.nodes[0] - 1, grid.nodes[1] - 1, grid.nodes[2] - 1));
    EXPECT_TRUE((grid.origin.array() <= (box.min() - reach).array()).all());
    EXPECT_TRUE((last.array() >= (box.max() + reach).array()).all());
  }
}

TEST(FieldGrid, WidenedBandIsTheSmallestThatHoldsTheReach) {
  const Box3 box(Vec3(0, 0, 0), Vec3(0.1, 0.05, 0.02));
  for (const double reach : {0.0, 1e-3, 5e-3, 0.02, 0.2}) {
    for (const bool by_voxel : {false, true}) {
      FieldSpec asked = spec(150);
      if (by_voxel) asked.voxel = 1e-3;
      const FieldSpec wide = widened(asked, box, reach, 3);
      const auto holds = [&](double band) {
        FieldSpec trial = asked;
        trial.band = band;
        if (!by_voxel && trial.resolution <= 2 * band + 2) return false;
        return reach / gridAround(box, trial).voxel + 3 <= band + 1e-6;
      };
      // No band of 150 cells holds 0.2 m around a shape of 0.1 m, and gridAround reports it.
      const bool possible = reach < 0.2 || by_voxel;
      EXPECT_TRUE(!possible || reach == 0 || holds(wide.band)) << reach;
      EXPECT_EQ(wide.resolution, 150);
      if (wide.band > asked.band) {
        EXPECT_FALSE(holds(wide.band - 1)) << reach;
      } else {
        EXPECT_EQ(wide.band, asked.band);
      }
    }
  }
}

TEST(FieldGrid, ScalesWithTheShape) {
  const Box3 small(Vec3(-0.05, -0.03, 0.01), Vec3(0.05, 0.02, 0.07));
  const FieldGrid a = gridAround(small, spec(150));
  for (const double scale : {2.0, 3.7, 10.0, 200.0}) {
    const FieldGrid b = gridAround(Box3(small.min() * scale, small.max() * scale), spec(150));
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_NEAR(b.voxel / a.voxel, scale, 1e-13 * scale);
    EXPECT_LT((b.origin - scale * a.origin).norm(), 1e-13 * scale);
  }
}

TEST(FieldGrid, TakesAVoxelInsteadOfAResolution) {
  const FieldGrid grid = gridAround(Box3(Vec3::Zero(), Vec3(0.1, 0, 0)),
                                    {.resolution = 150, .voxel = 0.01, .band = 4});
  EXPECT_EQ(grid.nodes, (std::array<int, 3>{19, 9, 9}));
  EXPECT_EQ(grid.nodeCount(), 19U * 9U * 9U);
}

TEST(FieldGrid, RejectsImpossibleGridsInOneLine) {
  const Box3 box(Vec3::Zero(), Vec3::Ones());
  EXPECT_THROW(gridAround(box, spec(18)), Error);
  EXPECT_NO_THROW(gridAround(box, spec(19)));
  EXPECT_THROW(gridAround(box, {.resolution = 150, .voxel = 0.0, .band = 8}), Error);
  EXPECT_THROW(gridAround(box, {.resolution = 150, .voxel = std::nan(""), .band = 8}), Error);
  EXPECT_THROW(gridAround(box, {.resolution = 150, .voxel = 1e-5, .band = 8}), Error);
  EXPECT_THROW(gridAround(box, spec(5000)), Error);
  EXPECT_THROW(gridAround(box, spec(150, 0)), Error);
  EXPECT_THROW(gridAround(Box3(), spec(150)), Error);
  EXPECT_THROW(gridAround(Box3(Vec3::Zero(), Vec3::Zero()), spec(150)), Error);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(gridAround(Box3(Vec3::Zero(), Vec3(1, inf, 1)), spec(150)), Error);
  try {
    gridAround(box, spec(18));
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("18"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

} // namespace
} // namespace patina
