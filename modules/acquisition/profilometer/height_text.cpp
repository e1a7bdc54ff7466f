// Plain text: what Gwyddion exports, and tables of x, y, z.
#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/profilometer/height_readers.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/units.h"

namespace patina {
namespace {

std::string_view withoutBlanks(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

// Accepts a decimal point or comma, and no thousands separators.
std::optional<double> numberOfAnyLocale(std::string_view word) {
  if (const auto value = parseNumber(word)) return value;
  std::string with_point(word);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parseNumber(with_point);
}

// Metres of one unit, or nullopt if the text names no unit of length.
std::optional<double> metresOf(std::string_view text) {
  const std::optional<Unit> unit = parseUnit(withoutBlanks(text));
  if (!unit || unit->exponents != std::array<int, 4>{1, 0, 0, 0}) return std::nullopt;
  return unit->multiplier / unit->divisor;
}

// Header comments in any language: "# Width: 10.5 µm" is a size, "# Value units: m" a unit.
struct GwyddionHeader {
  std::vector<double> sizes; // width, height [m]
  std::vector<double> units; // units of the values [m]
  std::string_view rest;     // after the comments
  std::size_t line = 1;      // first line of the data
};

GwyddionHeader gwyddionHeader(std::string_view text) {
  GwyddionHeader header;
  while (text.starts_with('#')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++header.line;
    std::size_t colon = line.find(':'), after = colon + 1;
    if (colon == std::string_view::npos) {
      colon = line.find("\xEF\xBC\x9A"); // full-width colon
      after = colon + 3;
    }
    if (colon == std::string_view::npos) continue;
    const std::string_view value = withoutBlanks(line.substr(after));
    const std::size_t blank = value.find(' ');
    if (const auto unit = metresOf(value))
      header.units.push_back(*unit);
    else if (blank != std::string_view::npos)
      if (const auto number = numberOfAnyLocale(value.substr(0, blank)))
        if (const auto metres = metresOf(value.substr(blank)))
          header.sizes.push_back(*number * *metres);
  }
  header.rest = text;
  return header;
}

} // namespace

bool isGwyddionText(std::string_view head) {
  if (head.starts_with("# Channel:") || head.starts_with("# Width:")) return true;
  const GwyddionHeader header = gwyddionHeader(head);
  return header.sizes.size() >= 2;
}

RawHeights readGwyddionText(std::string_view bytes, const std::string& name) {
  const GwyddionHeader header = gwyddionHeader(bytes);
  if (header.sizes.size() != 2 || header.units.size() != 1)
    throw FileError(name, 0,
                    "lacks lines '# Width: 10 µm', '# Height: 10 µm' or '# Value units: "
                    "m', with units of length; export it with the header, one image a "
                    "file");
  RawHeights raw;
  raw.rows = 0;
  WordReader words(header.rest, header.line);
  std::uint64_t in_row = 0;
  std::string_view word;
  const auto endRow = [&] {
    if (raw.rows == 1) raw.columns = in_row;
    if (raw.rows > 0 && in_row != raw.columns)
      throw FileError(name, 0,
                      "row " + formatCount(raw.rows) + " of the matrix has " + formatCount(in_row) +
                          " values, the first has " + formatCount(raw.columns));
    in_row = 0;
  };
  while (words.next(word)) {
    if (raw.z.empty() || words.beganLine()) {
      endRow();
      ++raw.rows;
    }
    const std::optional<double> value = numberOfAnyLocale(word);
    if (!value) throw FileError(name, words.line(), "has a value that is no number");
    if (raw.z.size() >= kMaxMeasuredPoints) countOfPoints(raw.z.size() + 1, 1, name);
    raw.z.push_back(*value * header.units[0]);
    ++in_row;
  }
  endRow();
  if (raw.z.empty()) throw FileError(name, 0, "has no matrix after its header");
  raw.step_x = header.sizes[0] / static_cast<double>(raw.columns);
  raw.step_y = header.sizes[1] / static_cast<double>(raw.rows);
  // The first row is the top of the image.
  for (std::size_t low = 0, high = raw.rows - 1; low < high; ++low, --high)
    std::swap_ranges(raw.z.begin() + static_cast<std::ptrdiff_t>(low * raw.columns),
                     raw.z.begin() + static_cast<std::ptrdiff_t>((low + 1) * raw.columns),
                     raw.z.begin() + static_cast<std::ptrdiff_t>(high * raw.columns));
  return raw;
}

RawHeights readHeightTable(std::string_view bytes, const std::string& name) {
  CsvReader reader(sourceOfText(bytes), name, {{"x [m]"}, {"y [m]", "z [m]"}});
  const bool has_y = reader.has("y [m]"), has_z = reader.has("z [m]");
  if (!has_y && !has_z)
    throw FileError(name, reader.line(),
                    "the header has x and no height: name a column 'z [um]', "
                    "or another unit");
  RawHeights raw;
  raw.is_list = has_y && has_z;
  for (std::vector<double> row; reader.next(row);) {
    if (raw.z.size() >= kMaxMeasuredPoints) countOfPoints(raw.z.size() + 1, 1, name);
    if (!std::isfinite(row[0]) || (raw.is_list && !std::isfinite(row[1])))
      throw FileError(name, reader.line(), "x or y is not a finite number");
    raw.x.push_back(row[0]);
    if (raw.is_list) raw.y.push_back(row[1]);
    const double z = row[has_z ? 2 : 1];
    raw.z.push_back(std::isfinite(z) ? z : kNotMeasured);
  }
  raw.columns = raw.z.size();
  countOfPoints(raw.columns, 1, name);
  if (const std::string line = reader.leftOut(); !line.empty())
    raw.warnings.push_back(line.substr(name.size() + 2));
  return raw;
}

} // namespace patina
