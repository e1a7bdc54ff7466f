// Relief on a one-sided open part, which is the front of a thickened sheet.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "authoring/relief_shapes.h"
#include "core/error.h"

namespace patina {
namespace {

using namespace test;

struct SlabSheet {
  TriangleMesh mesh = sheet(0.04, 0.04, 8);
  std::shared_ptr<const CornerUvs> uvs =
      uvsBy(mesh, [](const Vec3& p) { return Vec2(p.x() / 0.04 + 0.5, p.y() / 0.04 + 0.5); });
  std::shared_ptr<const SurfaceField> field;

  explicit SlabSheet(double band) {
    FieldSpec spec;
    spec.voxel = 1e-3;
    spec.band = band;
    field = fieldOf(mesh, spec);
  }
  std::shared_ptr<const SurfaceField> baked(double height) const {
    const auto disc = reliefImage(
        128, [](double u, double v) { return std::hypot(u - 0.5, v - 0.5) < 0.3 ? 1.0 : 0.0; });
    const std::vector<ReliefInput> sources{sourceOf(mesh, uvs, disc, height)};
    return bakeOf(field, mesh, sources).baked(sources);
  }
};

TEST(PlateRelief, MovesTheFrontOfASheetAndNotItsBack) {
  for (const double band : {8.0, 14.0})
    for (const double height : {2e-3, -1e-3, -2e-3, band > 8 ? -5e-3 : 1e-3}) {
      const auto field = SlabSheet(band).baked(height);
      for (const double x : {0.0, 3.3e-3}) {
        EXPECT_NEAR(0.012 - surfaceAt(*field, Vec3(x, 0, 0.012), -Vec3::UnitZ()), height, 1e-5);
        const double from = -(band + 4) * 1e-3;
        EXPECT_NEAR(from + surfaceAt(*field, Vec3(x, 0, from), Vec3::UnitZ()), -band * 1e-3, 1e-5)
            << height;
      }
      // The distance of coarse nodes behind the sheet is unchanged.
      const auto base = SlabSheet(band).field;
      std::size_t i = 0;
      for (int z = 0; z <= base->blocks[2]; ++z)
        for (int k = 0; k < (base->blocks[0] + 1) * (base->blocks[1] + 1); ++k, ++i)
          if (base->faceAt(kBlockSide * (k % (base->blocks[0] + 1)),
                           kBlockSide * (k / (base->blocks[0] + 1)), kBlockSide * z) >= 0 &&
              base->grid.toWorld(Vec3::Constant(kBlockSide * z)).z() < -band * 1e-3) {
            EXPECT_EQ(field->coarse[i].phi, base->coarse[i].phi);
          }
    }
}

TEST(PlateRelief, RejectsEngravingThroughASheetAndNamesTheBand) {
  for (const double height : {-2.1e-3, -4.5e-3, -5e-3}) try {
      (void)SlabSheet(8).baked(height);
      FAIL() << height;
    } catch (const Error& error) {
      const std::string band = std::to_string(static_cast<int>(std::ceil(-2e3 * height + 4)));
      EXPECT_NE(std::string(error.what()).find("set band to " + band), std::string::npos)
          << error.what();
      EXPECT_NO_THROW((void)SlabSheet(std::stod(band)).baked(height));
    }
}

} // namespace
} // namespace patina
