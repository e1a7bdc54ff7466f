#include "visualization/values/histogram.h"

#include <gtest/gtest.h>
#include <limits>

namespace patina {
namespace {

TEST(Histogram, CountsFiniteValuesOnceInBinsOfEqualWidth) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto bins = histogramOf({0, 0.5F, 1, nan, 2.5F, 4, 4}, 4);
  ASSERT_EQ(bins.size(), 4U);
  const std::size_t counts[] = {2, 1, 1, 2};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(bins[i].from, static_cast<double>(i));
    EXPECT_EQ(bins[i].to, static_cast<double>(i + 1));
    EXPECT_EQ(bins[i].count, counts[i]) << i;
  }
}

TEST(Histogram, IsEmptyWithoutValuesAndOneBinOfEqualOnes) {
  EXPECT_TRUE(histogramOf({std::numeric_limits<float>::infinity()}, 5).empty());
  const auto bins = histogramOf({3, 3, 3}, 5);
  ASSERT_EQ(bins.size(), 1U);
  EXPECT_EQ(bins[0].count, 3U);
}

} // namespace
} // namespace patina
