#include "core/numbers.h"

#include <clocale>
#include <cmath>
#include <cstring>

#include "core/error.h"

namespace patina {
namespace {

TEST(Numbers, ParsesTheWholeTextOrNothing) {
  EXPECT_EQ(parseNumber("1e-3"), 1e-3);
  EXPECT_EQ(parseNumber("-.5"), -0.5);
  EXPECT_EQ(parseNumber("+2"), 2.0);
  EXPECT_TRUE(std::isnan(*parseNumber("nan")));
  EXPECT_EQ(parseNumber("-inf"), -INFINITY);
  for (const char* text : {"", " 1", "1 ", "1,5", "1.5mm", "+-1", "++1", "0x10", "1e", "-", "one"})
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
}

TEST(Numbers, DoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  // Debian without locales has none of these; the test then checks less but still passes.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name)) break;
  EXPECT_EQ(parseNumber("1.5"), 1.5);
  EXPECT_EQ(formatNumber(1.5), "1.5");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Numbers, ReadBackBitForBit) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 5000; ++i) {
    double value;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (std::isnan(value)) continue;
    EXPECT_EQ(parseNumber(formatNumber(value)), value);
  }
}

TEST(Lengths, TakeUnits) {
  EXPECT_DOUBLE_EQ(parseLength("1.5mm"), 0.0015);
  EXPECT_DOUBLE_EQ(parseLength("1.5 mm"), 0.0015);
  EXPECT_DOUBLE_EQ(parseLength("20um"), 2e-5);
  EXPECT_DOUBLE_EQ(parseLength("2cm"), 0.02);
  EXPECT_DOUBLE_EQ(parseLength("1in"), 0.0254);
  EXPECT_DOUBLE_EQ(parseLength("3m"), 3);
  EXPECT_DOUBLE_EQ(parseLength("0.25"), 0.25);
}

TEST(Lengths, RejectOtherTexts) {
  for (const char* text : {"", "mm", "1.5ft", "1,5mm", "nan", "infmm", "m", "1 2mm"})
    EXPECT_THROW(parseLength(text), Error) << text;
}

TEST(Numbers, AreReadable) {
  EXPECT_EQ(formatBytes(0), "0 B");
  EXPECT_EQ(formatBytes(999), "999 B");
  EXPECT_EQ(formatBytes(12.3e6), "12.3 MB");
  EXPECT_EQ(formatBytes(999.9e3), "1 MB");
  EXPECT_EQ(formatLength(0.00075), "0.75 mm");
  EXPECT_EQ(formatLength(0.1), "100 mm");
  EXPECT_EQ(formatLength(2.5), "2.5 m");
  EXPECT_EQ(formatLength(2e-6), "2 um");
  EXPECT_EQ(formatCount(1003520), "1,003,520");
  EXPECT_EQ(formatCount(999), "999");
  EXPECT_EQ(formatCount(1000), "1,000");
}

} // namespace
} // namespace patina
