// Units of measurement in the headers of tables. parseLength() of numbers.h reads a typed length.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace patina {

struct Unit {
  double multiplier = 1, divisor = 1; // value in SI = value * multiplier / divisor
  std::array<int, 4> exponents{};     // powers of m, s, N and rad
};

// Parses "mm", "m/s^2", "N s/m", "µm"; "", "1" and "-" have no dimension. nullopt if unknown.
std::optional<Unit> parseUnit(std::string_view text);

// Lists the known symbols of the same dimension: "m, km, dm, cm".
std::string unitsLike(const Unit& unit);

} // namespace patina
