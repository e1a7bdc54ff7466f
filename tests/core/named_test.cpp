#include "core/named.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

enum class Color { red, green, blue };
constexpr Named<Color> kColors[] = {
    {Color::red, "red"}, {Color::green, "green"}, {Color::blue, "blue"}};

TEST(Named, EveryTextLeadsBackToItsValue) {
  for (const auto& row : kColors)
    EXPECT_EQ(valueIn(kColors, textIn(kColors, row.value)), row.value);
}

TEST(Named, WhatTheTableLacksIsAbsent) {
  EXPECT_EQ(valueIn(kColors, "Red"), std::nullopt);
  EXPECT_EQ(textIn(kColors, static_cast<Color>(7)), "");
}

TEST(Named, AllTextsAreListedInTheirOrder) {
  EXPECT_EQ(textsOf(kColors), "red, green, blue");
  EXPECT_EQ(textsOf(kColors, " or "), "red, green or blue");
}

} // namespace
} // namespace patina
