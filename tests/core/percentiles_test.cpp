#include "core/percentiles.h"

#include <gtest/gtest.h>

#include <numeric>

namespace patina {
namespace {

TEST(Percentiles, AreNearestRankWhateverTheOrder) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1);
  const Percentiles p = percentiles(values);
  EXPECT_EQ(p.p50, 500);
  EXPECT_EQ(p.p99, 990);
  EXPECT_EQ(p.p999, 999);
  EXPECT_EQ(p.max, 1000);
}

TEST(Percentiles, OfOneValueAreThatValueAndOfNoneZeros) {
  EXPECT_EQ(percentiles({7}).p50, 7);
  EXPECT_EQ(percentiles({7}).p999, 7);
  EXPECT_EQ(percentiles({}).max, 0);
}

} // namespace
} // namespace patina
