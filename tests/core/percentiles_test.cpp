#include "core/percentiles.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

namespace patina {
namespace {

TEST(Percentiles, AreNearestRankInAnyOrder) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1);
  const Percentiles p = percentiles(values);
  EXPECT_EQ(p.p50, 500);
  EXPECT_EQ(p.p99, 990);
  EXPECT_EQ(p.p999, 999);
  EXPECT_EQ(p.max, 1000);
}

TEST(Percentiles, EqualASingleValueAndAreZeroWithoutValues) {
  EXPECT_EQ(percentiles({7}).p50, 7);
  EXPECT_EQ(percentiles({7}).p999, 7);
  EXPECT_EQ(percentiles({}).max, 0);
}

TEST(Percentiles, CountsGiveThePercentilesOfTheList) {
  std::mt19937 random(5);
  std::map<std::uint32_t, std::size_t> counts;
  std::vector<double> values;
  for (int i = 0; i < 3000; ++i) {
    const std::uint32_t value = random() % 400;
    values.push_back(value);
    ++counts[value];
    const Percentiles a = percentiles(values), b = percentilesOfCounts(counts);
    ASSERT_EQ(a.p50, b.p50);
    ASSERT_EQ(a.p99, b.p99);
    ASSERT_EQ(a.p999, b.p999);
    ASSERT_EQ(a.max, b.max);
  }
  EXPECT_EQ(percentilesOfCounts({}).max, 0);
}

} // namespace
} // namespace patina
