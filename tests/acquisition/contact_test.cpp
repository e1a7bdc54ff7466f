#include "acquisition/filtering/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace patina {
namespace {

std::vector<PathSample> pathOf(const std::vector<double>& forces) {
  std::vector<PathSample> path(forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    path[i].t = 0.002 * static_cast<double>(i);
    path[i].force = forces[i];
  }
  return path;
}

std::vector<double> levels(std::initializer_list<std::pair<int, double>> parts) {
  std::vector<double> forces;
  for (const auto& [count, force] : parts)
    forces.insert(forces.end(), static_cast<std::size_t>(count), force);
  return forces;
}

TEST(Contact, BeginsAboveOneLimitAndEndsBelowTheOther) {
  std::vector<PathSample> path =
      pathOf(levels({{20, 0}, {20, 0.07}, {20, 0.2}, {20, 0.07}, {20, 0.03}}));
  markContact(path);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_EQ(path[i].touching, i >= 40 && i < 80) << i;
}

TEST(Contact, IgnoresABriefSpikeOrLoss) {
  std::vector<PathSample> path =
      pathOf(levels({{20, 0}, {2, 1}, {20, 0}, {50, 1}, {3, 0}, {50, 1}, {20, 0}}));
  markContact(path);
  const std::vector<ContactInterval> stretches = contactIntervals(path);
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_EQ(stretches[0].begin, 42u);
  EXPECT_EQ(stretches[0].end, 145u);
}

TEST(Contact, IsSplitByLiftsAndLostSamples) {
  std::vector<PathSample> path = pathOf(levels({{50, 1}, {30, 0}, {60, 1}}));
  for (std::size_t i = 110; i < path.size(); ++i) path[i].t += 0.5;
  markContact(path);
  const std::vector<ContactInterval> stretches = contactIntervals(path);
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_EQ(stretches[1].begin, 80u);
  EXPECT_EQ(stretches[1].end, 110u);
  EXPECT_EQ(stretches[2].end, 140u);
}

TEST(Contact, HandlesEmptyAndNonFinitePaths) {
  std::vector<PathSample> path;
  markContact(path);
  EXPECT_TRUE(contactIntervals(path).empty());
  path = pathOf({std::nan(""), std::nan(""), std::nan("")});
  markContact(path);
  EXPECT_TRUE(contactIntervals(path).empty());
  EXPECT_THROW(markContact(path, {0.05, 0.1, 0.01}), std::invalid_argument);
}

} // namespace
} // namespace patina
