#include "geometry/io/text_scan.h"

#include <cctype>
#include <charconv>

namespace patina::text {

bool equalIgnoringCase(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
           return std::tolower(static_cast<unsigned char>(x)) ==
                  std::tolower(static_cast<unsigned char>(y));
         });
}

std::string pointCloud(std::size_t points, const char* why) {
  return "a point cloud of " + formatCount(points) + (points == 1 ? " point" : " points") +
         ", not a mesh: " + why +
         "; a surface reconstruction makes a mesh of it, such as Screened Poisson in MeshLab or "
         "PoissonRecon in CloudCompare";
}

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
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, code] = std::from_chars(word.data(), end, value);
  const bool beyond = code == std::errc::result_out_of_range && rest == end;
  throw FileError(name, line,
                  quoted(word) +
                      (!beyond                          ? " is not a number"
                       : word.find('-', 1) != word.npos ? " is too small a number"
                                                        : " is too large a number") +
                      "; it stands" + expected);
}

} // namespace patina::text
