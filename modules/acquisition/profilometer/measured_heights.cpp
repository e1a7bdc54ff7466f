#include "acquisition/profilometer/measured_heights.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>

#include "acquisition/profilometer/height_readers.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kMaxHeight = 1e3; // [m]; beyond it a unit is wrong
constexpr std::uintmax_t kMaxFile = std::uintmax_t{1} << 29;
constexpr std::size_t kHeadBytes = 4096;

// Returns true for a text with a column x. A text with the word "along" is a table of a path.
bool isHeightTable(std::string_view head) {
  std::string text;
  for (const char c : head) {
    if (c > 0 && c < ' ' && c != '\t' && c != '\r' && c != '\n') return false;
    if (c != '\0' && c != ' ' && c != '"') // UTF-16 has zeros
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (text.find("along") != std::string::npos) return false;
  constexpr std::string_view kBefore = ",;\t\r\n#\xBF\xFE\xFF", kAfter = ",;\t[(";
  for (std::size_t x = 0; x + 1 < text.size(); ++x)
    if (text[x] == 'x' && (x == 0 || kBefore.find(text[x - 1]) != kBefore.npos) &&
        kAfter.find(text[x + 1]) != kAfter.npos)
      return true;
  return false;
}

using Reader = RawHeights (*)(std::string_view, const std::string&);

Reader readerOf(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, kHeadBytes);
  if (head.starts_with("PK\x03\x04")) return readX3p;
  if (head.size() >= 8 && (head[0] == 'a' || head[0] == 'b'))
    for (const std::string_view kind : {"ISO-", "BCR-", "NIST-"})
      if (head.substr(1).starts_with(kind)) return readSdf;
  if (isGwyddionText(head)) return readGwyddionText;
  return isHeightTable(head) ? readHeightTable : nullptr;
}

// The number of steps between the lowest and the highest of the positions, which are those of a
// grid: as many distinct ones as there are groups that are closer together than half the gap which
// `count` even positions would have.
std::size_t intervalsOf(std::vector<double> positions) {
  std::sort(positions.begin(), positions.end());
  const double near =
      0.5 * (positions.back() - positions.front()) / static_cast<double>(positions.size());
  std::size_t groups = 0;
  for (std::size_t i = 1; i < positions.size(); ++i)
    groups += positions[i] - positions[i - 1] > near ? 1 : 0;
  return groups;
}

// Points in any order become rows; places without a point were not measured.
void layOnGrid(RawHeights& raw, const std::string& name) {
  const std::string uneven = "points x, y do not lie on a grid of even steps; resample them to one";
  const auto [x_low, x_high] = std::minmax_element(raw.x.begin(), raw.x.end());
  const auto [y_low, y_high] = std::minmax_element(raw.y.begin(), raw.y.end());
  const double x0 = *x_low, y0 = *y_low, width = *x_high - x0, height = *y_high - y0;
  if (!(width > 0) || !(height > 0)) throw FileError(name, 0, uneven);
  const std::size_t across = intervalsOf(raw.x), down = intervalsOf(raw.y);
  raw.columns = across + 1;
  raw.rows = down + 1;
  raw.step_x = width / static_cast<double>(across);
  raw.step_y = height / static_cast<double>(down);
  // A grid has as many places as points, but for the few that are absent.
  const double places = static_cast<double>(raw.columns) * static_cast<double>(raw.rows);
  if (places * (1 - kMaxUnmeasuredShare) > static_cast<double>(raw.z.size()))
    throw FileError(name, 0, uneven);
  std::vector<double> heights(countOfPoints(raw.columns, raw.rows, name), kNotMeasured);
  std::vector<bool> is_taken(heights.size());
  for (std::size_t i = 0; i < raw.z.size(); ++i) {
    const double u = (raw.x[i] - x0) / raw.step_x, v = (raw.y[i] - y0) / raw.step_y;
    if (std::abs(u - std::round(u)) > 0.25 || std::abs(v - std::round(v)) > 0.25)
      throw FileError(name, 0, uneven);
    const auto place = static_cast<std::size_t>(std::lround(v)) * raw.columns +
                       static_cast<std::size_t>(std::lround(u));
    if (is_taken[place])
      throw FileError(name, 0,
                      "has two points at x " + formatNumber(raw.x[i]) + " m, y " +
                          formatNumber(raw.y[i]) + " m");
    is_taken[place] = true;
    heights[place] = raw.z[i];
  }
  raw.z = std::move(heights);
}

// Gaps of a row become linear between their ends, or as high as their one end; a row without any
// height becomes that before it, or the first that has some.
void interpolate(RawHeights& raw) {
  const auto columns = static_cast<std::ptrdiff_t>(raw.columns);
  const auto isMeasured = [](double z) { return !std::isnan(z); };
  const auto source = std::find_if(raw.z.begin(), raw.z.end(), isMeasured) - raw.z.begin();
  const std::vector<double> first(raw.z.begin() + source / columns * columns,
                                  raw.z.begin() + (source / columns + 1) * columns);
  for (auto row = raw.z.begin(); row != raw.z.end(); row += columns) {
    const auto end = row + columns;
    auto last = end; // the height before a gap; none yet
    if (std::none_of(row, end, isMeasured))
      std::copy_n(row == raw.z.begin() ? first.begin() : row - columns, columns, row);
    for (auto z = row; z != end; last = z++) {
      if (isMeasured(*z)) continue;
      const auto next = std::find_if(z, end, isMeasured);
      const double low = last == end ? *next : *last, high = next == end ? low : *next;
      const auto gap = static_cast<double>(next - z + 1);
      for (double i = 1; z != next; ++z, ++i) *z = low + i / gap * (high - low);
      if (next == end) break;
    }
  }
}

// Keeps the points of which `tested` is a number.
void dropUnmeasured(RawHeights& raw, const std::vector<double>& tested) {
  std::vector<bool> keep;
  for (const double value : tested) keep.push_back(!std::isnan(value));
  for (std::vector<double>* values : {&raw.x, &raw.y, &raw.z}) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values->size(); ++i)
      if (keep[i]) (*values)[kept++] = (*values)[i];
    values->resize(kept);
  }
}

// Positions of a profile become increasing; points that were not measured are left out.
void makeProfile(RawHeights& raw, const std::string& name) {
  if (raw.x.empty()) {
    requireStep(raw.step_x, "step along x", name);
    for (std::size_t i = 0; i < raw.z.size(); ++i)
      raw.x.push_back(static_cast<double>(i) * raw.step_x);
  }
  dropUnmeasured(raw, raw.x);
  dropUnmeasured(raw, raw.z);
  if (!raw.x.empty() && raw.x.back() < raw.x.front()) {
    std::reverse(raw.x.begin(), raw.x.end());
    std::reverse(raw.z.begin(), raw.z.end());
  }
  const auto backwards = std::is_sorted_until(raw.x.begin(), raw.x.end());
  if (backwards != raw.x.end())
    throw FileError(name, 0,
                    "x runs backwards at " + formatNumber(*backwards) +
                        " m; sort the points, or give x and y of an area");
}

} // namespace

std::size_t countOfPoints(std::uint64_t columns, std::uint64_t rows, const std::string& name) {
  if (columns == 0 || rows == 0) throw FileError(name, 0, "says that it has no points");
  if (columns > kMaxMeasuredPoints || rows > kMaxMeasuredPoints / columns)
    throw FileError(name, 0,
                    "says that it has " + formatCount(columns) + " x " + formatCount(rows) +
                        " points; at most " + formatCount(kMaxMeasuredPoints) +
                        " are read: crop it");
  return columns * rows;
}

void requireStep(double step, const std::string& what, const std::string& name) {
  if (!(step > 0) || !(step <= 10))
    throw FileError(name, 0,
                    what + " is " + formatNumber(step) + " m; it must be above 0 and at " +
                        "most 10 m");
}

bool WordReader::next(std::string_view& word) {
  began_line_ = at_start_;
  std::size_t i = 0;
  for (; i < text_.size() && std::isspace(static_cast<unsigned char>(text_[i])); ++i)
    if (text_[i] == '\n') ++line_, began_line_ = true;
  text_.remove_prefix(i);
  std::size_t end = 0;
  while (end < text_.size() && !std::isspace(static_cast<unsigned char>(text_[end]))) ++end;
  word = text_.substr(0, end);
  text_.remove_prefix(end);
  at_start_ = false;
  return !word.empty();
}

bool isProfilometerFile(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<char, kHeadBytes> head{};
  file.read(head.data(), head.size());
  return readerOf({head.data(), static_cast<std::size_t>(file.gcount())}) != nullptr;
}

MeasuredHeights parseMeasuredHeights(std::string_view bytes, const std::string& name,
                                     std::vector<std::string>& warnings) {
  const Reader reader = readerOf(bytes);
  if (reader == nullptr)
    throw FileError(name, 0, "is no X3P, SDF, Gwyddion text or table with x and z");
  RawHeights raw = reader(bytes, name);
  for (const std::string& line : raw.warnings) warnings.push_back(name + ": " + line);
  for (const std::vector<double>* values : {&raw.x, &raw.y, &raw.z})
    for (const double value : *values)
      if (std::abs(value) > kMaxHeight)
        throw FileError(name, 0,
                        "has a " + std::string(values == &raw.z ? "height" : "position") + " of " +
                            formatNumber(value) + " m; is its unit right?");
  if (raw.is_list) {
    dropUnmeasured(raw, raw.x);
    dropUnmeasured(raw, raw.y);
    if (raw.z.size() < 4) throw FileError(name, 0, "has fewer than 4 points");
    layOnGrid(raw, name);
  }
  const auto bad = static_cast<std::size_t>(
      std::count_if(raw.z.begin(), raw.z.end(), [](double z) { return std::isnan(z); }));
  const double share = static_cast<double>(bad) / static_cast<double>(raw.z.size());
  const std::string of_all = formatCount(bad) + " of " + formatCount(raw.z.size()) + " points were";
  if (!(share <= kMaxUnmeasuredShare))
    throw FileError(name, 0,
                    of_all + " not measured, more than " + formatNumber(100 * kMaxUnmeasuredShare) +
                        " %: fill them in the program of the instrument, or crop");
  const bool area = raw.rows > 1;
  if (bad > 0)
    warnings.push_back(name + ": " + of_all + " not measured and " +
                       (area ? "are interpolated" : "are left out"));
  MeasuredHeights measured;
  if (area) {
    requireStep(raw.step_x, "step along x", name);
    requireStep(raw.step_y, "step along y", name);
    if (raw.columns < 2) throw FileError(name, 0, "has one point a row; a profile has one row");
    interpolate(raw);
    measured.step_x = raw.step_x;
    measured.step_y = raw.step_y;
  } else {
    makeProfile(raw, name);
    measured.along = std::move(raw.x);
  }
  measured.heights = std::move(raw.z);
  measured.rows = raw.rows;
  measured.columns = measured.heights.size() / measured.rows;
  return measured;
}

MeasuredHeights readMeasuredHeights(const std::filesystem::path& path,
                                    std::vector<std::string>& warnings) {
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown && size > kMaxFile)
    throw FileError(path.string(), 0,
                    "has " + formatBytes(static_cast<double>(size)) + "; at most " +
                        formatBytes(static_cast<double>(kMaxFile)) + " are read: crop it");
  return parseMeasuredHeights(readFile(path), path.string(), warnings);
}

} // namespace patina
