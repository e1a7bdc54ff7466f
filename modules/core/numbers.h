// Locale-independent numbers and lengths.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace patina {

// The whole of text as a number ("1e-3"); nullopt if any of it is not part of one. "nan" and "inf"
// parse.
std::optional<double> parseNumber(std::string_view text);

// "1.5mm" -> 0.0015; units um mm cm m in; without one, metres. Throws Error naming the text.
double parseLength(std::string_view text);

// Shortest text that reads back bit for bit.
std::string formatNumber(double value);
// For people: "12.3 MB", "0.75 mm", "1,003,520".
std::string formatBytes(double bytes);
std::string formatLength(double metres);
std::string formatArea(double square_metres); // "3600 mm²"
std::string formatCount(std::size_t count);

} // namespace patina
