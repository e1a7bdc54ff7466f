#include "geometry/io/text_scan.h"

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
  throw FileError(name, line,
                  quoted(word) + " is no number a double can hold; it stands" + expected);
}

} // namespace patina::text
