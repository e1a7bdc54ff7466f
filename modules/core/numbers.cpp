#include "core/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace patina {
namespace {

// Rounds to three significant digits without a locale: 12.3, 0.75, 980.
std::string shortNumber(double value) {
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::general, 3);
  std::string text(buffer.data(), result.ptr);
  // The general format would write 1023 as 1.02e+03.
  if (text.find('e') != std::string::npos && std::abs(value) >= 1 && std::abs(value) < 1e6) {
    const auto whole = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                     std::chars_format::fixed, 0);
    text.assign(buffer.data(), whole.ptr);
  }
  return text;
}

struct LengthSuffix {
  std::string_view suffix;
  double metres;
};
// Longer suffixes first: "mm" also ends in "m".
constexpr std::array<LengthSuffix, 5> kUnits{
    {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}, {"m", 1.0}}};

} // namespace

std::optional<double> parseNumber(std::string_view text) {
  // from_chars rejects a leading plus, which other programs write.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double parseLength(std::string_view text) {
  std::string_view digits = text;
  double factor = 1;
  for (const LengthSuffix& unit : kUnits) {
    if (digits.size() > unit.suffix.size() && digits.ends_with(unit.suffix)) {
      digits.remove_suffix(unit.suffix.size());
      factor = unit.metres;
      break;
    }
  }
  while (!digits.empty() && digits.back() == ' ') digits.remove_suffix(1);
  const std::optional<double> value = parseNumber(digits);
  if (!value || !std::isfinite(*value)) {
    throw Error("'" + std::string(text) +
                "' is not a length: write a number in metres, or one with um, mm, cm, m or in");
  }
  return *value * factor;
}

std::string formatNumber(double value) {
  if (std::isnan(value)) return "nan"; // the sign of NaN has no meaning
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string formatBytes(double bytes) {
  constexpr std::array<const char*, 5> kNames{"B", "kB", "MB", "GB", "TB"};
  std::size_t power = 0;
  // 999.5 would round up to 1000 of the smaller unit.
  while (std::abs(bytes) >= 999.5 && power + 1 < kNames.size()) {
    bytes /= 1000;
    ++power;
  }
  return shortNumber(bytes) + " " + kNames[power];
}

std::string formatLength(double metres) {
  const double size = std::abs(metres);
  if (size == 0) return "0 mm";
  if (size < 0.5e-4) return shortNumber(metres * 1e6) + " um";
  if (size < 0.9995) return shortNumber(metres * 1e3) + " mm";
  return shortNumber(metres) + " m";
}

std::string formatArea(double square_metres) {
  return square_metres < 0.1 ? shortNumber(square_metres * 1e6) + " mm²"
                             : shortNumber(square_metres) + " m²";
}

std::string formatCount(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

} // namespace patina
