// The range of an offset or a magnet, in words.
#include <gtest/gtest.h>

#include "visualization/values/touch_band.h"

namespace patina {
namespace {

SurfaceField fieldOf(double voxel, double band) {
  SurfaceField field;
  field.grid.voxel = voxel;
  field.band = band;
  return field;
}

TEST(TouchBand, IsAbsentWithoutOffsetAndMagnet) {
  EXPECT_FALSE(touchBand({}));
  HapticProperties zero;
  zero.offset = 0;
  EXPECT_FALSE(touchBand(zero));
  zero.magnet = Magnet{0, 500, false};
  EXPECT_FALSE(touchBand(zero));
}

TEST(TouchBand, ReachesToTheOffsetOrTheMagnetsRange) {
  HapticProperties haptics;
  haptics.offset = 2e-3;
  EXPECT_EQ(touchBand(haptics), (TouchBand{TouchBand::Kind::offset, 2e-3}));
  haptics.offset.reset();
  haptics.magnet = Magnet{3e-3, 200, true};
  EXPECT_EQ(touchBand(haptics), (TouchBand{TouchBand::Kind::magnet, 3e-3}));
}

TEST(TouchBand, LegendShowsItsValueAndWhetherTheFieldCoversIt) {
  const SurfaceField field = fieldOf(1e-3, 8); // isoSurface is closed up to band - 2 voxels
  EXPECT_EQ(bandLegend({TouchBand::Kind::offset, 2.5e-3}, field), "offset 2.5 mm");
  EXPECT_EQ(bandLegend({TouchBand::Kind::magnet, 6e-3}, field), "magnet range 6 mm");
  const TouchBand wide{TouchBand::Kind::offset, 6.5e-3};
  EXPECT_FALSE(isStored(wide, field));
  EXPECT_EQ(bandLegend(wide, field), "offset 6.5 mm: not drawn, the field holds up to 6 mm");
}

} // namespace
} // namespace patina
