#include "geometry/io/text_scan.h"

#include <cmath>
#include <cstdlib>

namespace patina::text {

void throwNotANumber(std::string_view word, const std::string& name, std::size_t line,
                     const char* what) {
  const std::string expected = std::string(" where ") + what + " should be";
  if (word.empty()) throw FileError(name, line, "the line ends" + expected);
  if (hasControl(word)) throw FileError(name, line, "binary data" + expected);
  std::string with_point(word.substr(0, 64));
  const std::size_t comma = with_point.find(',');
  if (comma != std::string::npos) {
    with_point[comma] = '.';
    if (parseNumber(with_point))
      throw FileError(name, line,
                      quoted(word) + " has a decimal comma; numbers need a decimal point");
  }
  char* end = nullptr;
  const bool large = std::isinf(std::strtod(with_point.c_str(), &end)) && *end == '\0' &&
                     with_point.find_first_of("0123456789") != std::string::npos;
  throw FileError(name, line,
                  quoted(word) + (large ? " is too large a number" : " is not a number") +
                      "; it stands" + expected);
}

} // namespace patina::text
