#include "core/named.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

enum class Color { red, green, blue };
constexpr Named<Color> kColors[] = {
    {Color::red, "red"}, {Color::green, "green"}, {Color::blue, "blue"}};

TEST(Named, EveryTextLeadsBackToItsValue) {
  for (const auto& row : kColors)
    EXPECT_EQ(parseIn(kColors, nameIn(kColors, row.value)), row.value);
}

TEST(Named, UnknownValuesAreAbsent) {
  EXPECT_EQ(parseIn(kColors, "Red"), std::nullopt);
  EXPECT_EQ(nameIn(kColors, static_cast<Color>(7)), "");
}

TEST(Named, AllTextsAreListedInTheirOrder) {
  EXPECT_EQ(allNames(kColors), "red, green, blue");
  EXPECT_EQ(allNames(kColors, " or "), "red, green or blue");
}

} // namespace
} // namespace patina
