#include "core/units.h"

#include <algorithm>
#include <charconv>
#include <numbers>

namespace patina {
namespace {

struct Symbol {
  std::string_view name;
  Unit unit;
  bool listed = true; // shown in messages; false for a second spelling
};

constexpr std::array<int, 4> kLength{1, 0, 0, 0}, kTime{0, 1, 0, 0}, kForce{0, 0, 1, 0},
    kAngle{0, 0, 0, 1}, kAcceleration{1, -2, 0, 0};

// Micro sign U+00B5, Greek letter U+03BC or one Latin-1 byte; degree sign U+00B0 or one byte.
constexpr Symbol kSymbols[] = {
    {"m", {1, 1, kLength}},
    {"km", {1e3, 1, kLength}},
    {"dm", {1, 10, kLength}},
    {"cm", {1, 100, kLength}},
    {"mm", {1, 1e3, kLength}},
    {"um", {1, 1e6, kLength}},
    {"\xC2\xB5m", {1, 1e6, kLength}, false},
    {"\xCE\xBCm", {1, 1e6, kLength}, false},
    {"\xB5m", {1, 1e6, kLength}, false},
    {"nm", {1, 1e9, kLength}},
    {"in", {254, 1e4, kLength}},
    {"inch", {254, 1e4, kLength}, false},
    {"ft", {3048, 1e4, kLength}},
    {"s", {1, 1, kTime}},
    {"sec", {1, 1, kTime}, false},
    {"ms", {1, 1e3, kTime}},
    {"us", {1, 1e6, kTime}},
    {"\xC2\xB5s", {1, 1e6, kTime}, false},
    {"\xCE\xBCs", {1, 1e6, kTime}, false},
    {"\xB5s", {1, 1e6, kTime}, false},
    {"ns", {1, 1e9, kTime}},
    {"min", {60, 1, kTime}},
    {"h", {3600, 1, kTime}},
    {"N", {1, 1, kForce}},
    {"kN", {1e3, 1, kForce}},
    {"cN", {1, 100, kForce}},
    {"mN", {1, 1e3, kForce}},
    {"uN", {1, 1e6, kForce}},
    {"kgf", {980665, 1e5, kForce}},
    {"gf", {980665, 1e8, kForce}},
    {"rad", {1, 1, kAngle}},
    {"mrad", {1, 1e3, kAngle}},
    {"deg", {std::numbers::pi, 180, kAngle}},
    {"\xC2\xB0", {std::numbers::pi, 180, kAngle}, false},
    {"\xB0", {std::numbers::pi, 180, kAngle}, false},
    {"g", {980665, 1e5, kAcceleration}}, // standard gravity, not gram
    {"mg", {980665, 1e8, kAcceleration}},
};

// Accepts "2", "^2", "**2", "-1", and a raised 2 in UTF-8 or Latin-1. An empty text is 1.
std::optional<int> exponentIn(std::string_view text) {
  if (text.empty()) return 1;
  if (text == "\xC2\xB2" || text == "\xB2") return 2;
  if (text.starts_with("**"))
    text.remove_prefix(2);
  else if (text.front() == '^')
    text.remove_prefix(1);
  int exponent = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return exponent >= -3 && exponent <= 3 && exponent != 0 ? std::optional(exponent) : std::nullopt;
}

// Multiplies the unit by the longest symbol at the factor's start that only an exponent, or
// nothing, follows. Returns false if there is none.
bool multiply(Unit& unit, std::string_view factor, int sign) {
  const Symbol* best = nullptr;
  int exponent = 0;
  for (const Symbol& symbol : kSymbols) {
    if (!factor.starts_with(symbol.name) || (best && best->name.size() > symbol.name.size()))
      continue;
    const auto power = exponentIn(factor.substr(symbol.name.size()));
    if (power) best = &symbol, exponent = *power * sign;
  }
  if (best == nullptr) return false;
  for (int i = 0; i < std::abs(exponent); ++i) {
    unit.multiplier *= exponent > 0 ? best->unit.multiplier : best->unit.divisor;
    unit.divisor *= exponent > 0 ? best->unit.divisor : best->unit.multiplier;
  }
  for (std::size_t k = 0; k < unit.exponents.size(); ++k)
    unit.exponents[k] += exponent * best->unit.exponents[k];
  return true;
}

} // namespace

std::optional<Unit> parseUnit(std::string_view text) {
  constexpr std::string_view kSpaces = " \t";
  const std::size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return Unit{};
  text = text.substr(first, text.find_last_not_of(kSpaces) + 1 - first);
  if (text == "1" || text == "-") return Unit{};
  Unit unit;
  int sign = 1;
  while (true) {
    // One star between factors is a product, two stars are a power.
    std::size_t end = 0;
    while (end < text.size() && text[end] != '/' && text[end] != ' ' &&
           !(text[end] == '*' && end > 0 && end + 1 < text.size() && text[end + 1] != '*' &&
             text[end - 1] != '*'))
      ++end;
    if (!multiply(unit, text.substr(0, end), sign)) return std::nullopt;
    if (end == text.size()) return unit;
    text.remove_prefix(end);
    while (!text.empty() && (text.front() == ' ' || text.front() == '*')) text.remove_prefix(1);
    if (!text.empty() && text.front() == '/') {
      sign = -1;
      text.remove_prefix(1);
      while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    }
  }
}

std::string unitsLike(const Unit& unit) {
  std::string names;
  for (const Symbol& symbol : kSymbols)
    if (symbol.listed && symbol.unit.exponents == unit.exponents)
      names += (names.empty() ? "" : ", ") + std::string(symbol.name);
  return names;
}

} // namespace patina
