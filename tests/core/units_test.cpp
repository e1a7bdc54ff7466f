#include "core/units.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

std::string inSi(const std::string& text) {
  const auto unit = parseUnit(text);
  if (!unit) return "none";
  std::string out = std::to_string(unit->multiplier / unit->divisor);
  for (const int exponent : unit->exponents) out += " " + std::to_string(exponent);
  return out;
}

TEST(Units, AreParsedInTheirUsualSpellings) {
  for (const char* text : {"m/s^2", "m/s2", "m/s**2", "m/s\xC2\xB2", "m / s^2", "m s^-2", "m*s^-2",
                           "m/s/s", " m/s^2 "})
    EXPECT_EQ(inSi(text), "1.000000 1 -2 0 0") << text;
  for (const char* text : {"", "1", "-", " "}) EXPECT_EQ(inSi(text), "1.000000 0 0 0 0");
  EXPECT_EQ(inSi("N s/m"), "1.000000 -1 1 1 0");
  EXPECT_EQ(inSi("mm/N"), "0.001000 1 0 -1 0");
  EXPECT_EQ(inSi("min"), "60.000000 0 1 0 0");
  EXPECT_EQ(inSi("in"), "0.025400 1 0 0 0");
  EXPECT_EQ(inSi("mg"), "0.009807 1 -2 0 0");
  EXPECT_EQ(inSi("deg"), "0.017453 0 0 0 1");
  EXPECT_EQ(inSi("\xC2\xB5m"), "0.000001 1 0 0 0");
}

TEST(Units, UnknownSymbolIsNoUnit) {
  for (const char* text : {"furlong", "mmm", "m/", "/s", "m//s", "m^", "m^0", "m^9", "m^x", "M",
                           "S", "m/(s)", "^2", "*", "m**"})
    EXPECT_EQ(inSi(text), "none") << text;
}

} // namespace
} // namespace patina
