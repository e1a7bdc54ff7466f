// Text as people of any language write it.
#pragma once

#include <cstddef>
#include <string_view>

namespace patina {

// Whether the bytes are well-formed UTF-8 without control characters.
bool isUtf8(std::string_view text);

// Without the three bytes that some editors and spreadsheets begin a file with.
inline std::string_view withoutByteOrderMark(std::string_view bytes) {
  return bytes.substr(0, 3) == "\xEF\xBB\xBF" ? bytes.substr(3) : bytes;
}

// Writes the one to three bytes of a code point of the first plane and returns their number; '?' for
// half of a pair.
std::size_t putUtf8(char16_t unit, char* to);

} // namespace patina
