#include "core/utf8.h"

#include <cstdint>

namespace patina {

bool isUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    if (first < 0x80) {
      if (first < 0x20 || first == 0x7f) return false;
      continue;
    }
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
    if (first < 0xc2 || first > 0xf4)
      return false; // continuation byte, overlong, or beyond Unicode
    std::uint32_t point = first & (0x3fU >> more);
    for (int k = 0; k < more; ++k, ++i) {
      if (i == text.size() || (text[i] & 0xc0) != 0x80) return false;
      point = point << 6 | (static_cast<unsigned char>(text[i]) & 0x3fU);
    }
    const std::uint32_t least = more == 3   ? 0x10000
                                : more == 2 ? 0x800
                                            : 0xa0; // excludes the C1 control characters
    if (point < least || point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) return false;
  }
  return true;
}

std::size_t putUtf8(char16_t unit, char* to) {
  if (unit >= 0xD800 && unit < 0xE000) unit = '?';
  if (unit < 0x80) {
    to[0] = static_cast<char>(unit);
    return 1;
  }
  const std::size_t count = unit < 0x800 ? 2 : 3;
  to[0] = static_cast<char>(count == 2 ? 0xC0 | unit >> 6 : 0xE0 | unit >> 12);
  for (std::size_t i = 1; i < count; ++i)
    to[i] = static_cast<char>(0x80 | (unit >> 6 * (count - 1 - i) & 0x3F));
  return count;
}

} // namespace patina
