// Options of earlier versions are still accepted.
#include "app/cli/framework/former_options.h"

#include <gtest/gtest.h>

namespace patina::cli {
namespace {

using Words = std::vector<std::string>;

TEST(FormerOptions, AreReplacedByTheirPresentSpelling) {
  EXPECT_EQ(inPresentSpelling({"register", "a.obj", "p.csv", "--also", "q.csv"}),
            (Words{"register", "a.obj", "p.csv", "--with", "q.csv"}));
  EXPECT_EQ(inPresentSpelling({"map-texture", "--most-stretch=3"}),
            (Words{"map-texture", "--max-stretch=3"}));
}

TEST(FormerOptions, WithoutAnEffectAreDropped) {
  EXPECT_EQ(inPresentSpelling({"filter", "scan", "--smooth", "-o", "p.csv"}),
            (Words{"filter", "scan", "-o", "p.csv"}));
}

TEST(FormerOptions, OfOtherCommandsAndInputsAreLeftAlone) {
  EXPECT_EQ(inPresentSpelling({"simulate-scan", "--seed", "3"}),
            (Words{"simulate-scan", "--seed", "3"}));
  EXPECT_EQ(inPresentSpelling({"filter", "--", "--smooth"}), (Words{"filter", "--", "--smooth"}));
  EXPECT_EQ(inPresentSpelling({"info", ""}), (Words{"info", ""}));
  EXPECT_TRUE(inPresentSpelling({}).empty());
}

} // namespace
} // namespace patina::cli
