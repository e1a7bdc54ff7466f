// Numbers and lengths as text, independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace patina {

// Parses all of `text` as a number ("1e-3", "nan", "inf"); nullopt if any part is left over.
std::optional<double> parseNumber(std::string_view text);

// Parses a length in um, mm, cm, m (default) or in: "1.5mm" -> 0.0015. Throws Error.
double parseLength(std::string_view text);

// Returns the shortest text that reads back bit for bit.
std::string formatNumber(double value);
// Rounded texts for the user: "12.3 MB", "0.75 mm", "1,003,520".
std::string formatBytes(double bytes);
std::string formatLength(double metres);
std::string formatArea(double square_metres); // "3600 mm²"
std::string formatCount(std::size_t count);

} // namespace patina
