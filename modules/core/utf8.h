// Checks and conversions of UTF-8 text.
#pragma once

#include <cstddef>
#include <string_view>

namespace patina {

// True if the bytes are well-formed UTF-8 without control characters.
bool isUtf8(std::string_view text);

// Removes the three-byte mark that some editors and spreadsheets write first.
inline std::string_view withoutByteOrderMark(std::string_view bytes) {
  return bytes.substr(0, 3) == "\xEF\xBB\xBF" ? bytes.substr(3) : bytes;
}

// Writes the UTF-8 bytes of a UTF-16 code unit, '?' for a surrogate; returns their number.
std::size_t putUtf8(char16_t unit, char* to);

} // namespace patina
