// Captions of edits in the history.
#include "app/gui/toolkit/history_words.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

TEST(HistoryWords, ContainNoFileKeys) {
  EXPECT_EQ(wordsOfEdit("friction.static = 0.5, friction.dynamic = 0.3, friction.slip = paper"),
            QStringLiteral("Static friction 0.5, dynamic friction 0.3, friction towards the tip"));
  EXPECT_EQ(wordsOfEdit("friction.slip = displacement"),
            QStringLiteral("Friction against the motion"));
  EXPECT_EQ(wordsOfEdit("roughness 50 um, 4 mm"), QStringLiteral("Painted roughness 50 µm, 4 mm"));
  EXPECT_EQ(wordsOfEdit("move cup by 12 um"), QStringLiteral("Move cup by 12 µm"));
  EXPECT_EQ(wordsOfEdit("remove umbrella"), QStringLiteral("Remove umbrella"));
  EXPECT_EQ(wordsOfEdit("tip.radius = 0.001"), QStringLiteral("Tip radius 1 mm"));
  EXPECT_EQ(wordsOfKeys(QStringLiteral("friction.static = 0.5")),
            QStringLiteral("static friction = 0.5"));
}

} // namespace
} // namespace patina
