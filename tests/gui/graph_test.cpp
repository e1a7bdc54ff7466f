// The marks of a graph's axes.
#include "app/gui/widgets/graph.h"

#include <gtest/gtest.h>

#include "app/gui/widgets/words.h"

namespace patina {
namespace {

TEST(Graphs, AnAxisHasTwoMarksAtLeastAndTheyAreRoundAndWithinIt) {
  for (int count = 2; count <= 8; ++count)
    for (double from = -3.7; from < 4; from += 0.37)
      for (double length = 1e-3; length < 2e3; length *= 1.7) {
        const AxisSpan span{from, from + length};
        const auto marks = marksOf(span, count);
        ASSERT_GE(marks.size(), 2U) << from << " + " << length << ", " << count;
        EXPECT_LE(marks.size(), static_cast<std::size_t>(count) + 4);
        EXPECT_GE(marks.front(), from - 1e-9 * length);
        EXPECT_LE(marks.back(), span.to + 1e-9 * length);
      }
  EXPECT_EQ(marksOf({-1, 1}, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_FALSE(std::signbit(marksOf({-1, 1}, 4)[2]));
  EXPECT_EQ(marksOf({0, 2.4}, 8, 1), (std::vector<double>{0, 1, 2}));
  EXPECT_TRUE(marksOf({0.3, std::nextafter(0.3, 1)}, 4).empty());
  EXPECT_TRUE(marksOf({std::nan(""), 1}, 4).empty());
}

TEST(Words, HaveNoMinusBeforeZero) {
  for (const double value : {-0.04, -0., 0.04}) {
    EXPECT_EQ(QString::number(shownAs(value, 1), 'f', 1), QStringLiteral("0.0"));
    EXPECT_EQ(shownAs(value, 3) == 0, value == 0);
  }
  EXPECT_EQ(shownAs(-0.06, 1), -0.06);
}

TEST(Words, KeepANumberAndItsUnitTogether) {
  EXPECT_EQ(inWords(5e-6), QStringLiteral("5 µm").replace(' ', kNoBreak));
  EXPECT_EQ(inWords(std::string("rms 50 um, 3 %")),
            QStringLiteral("rms 50_µm, 3_%").replace('_', kNoBreak));
}

} // namespace
} // namespace patina
