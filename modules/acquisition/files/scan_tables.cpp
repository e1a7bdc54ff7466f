#include <algorithm>
#include <cmath>

#include "acquisition/files/measured.h"
#include "acquisition/files/scan_tables.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

const std::vector<std::string> kProbeColumns = {"t [s]",       "force [N]",   "a1u [m/s^2]",
                                                "a1v [m/s^2]", "a2u [m/s^2]", "a2v [m/s^2]"};
const std::vector<std::string> kRateColumns = {"wx [rad/s]", "wy [rad/s]", "wz [rad/s]"};
const std::vector<std::string> kPathColumns = {"t [s]", "x [m]", "y [m]", "z [m]",     "qx",
                                               "qy",    "qz",    "qw",    "sigma [m]", "force [N]"};

const std::vector<std::string> kHeightColumns = {"t [s]",     "along [m]", "height [m]",
                                                 "sigma [m]", "stretch",   "speed [m/s]"};

constexpr double kUnitQuaternion = 1e-3; // largest deviation of the length from 1
constexpr double kRounded = 1e-12;       // deviation of a unit length that is due to rounding

// Throws FileError unless all numbers are plausible and the time is after `last`.
void requireTimed(const std::vector<double>& row, const std::vector<std::string>& columns,
                  const std::string& name, std::size_t line, std::optional<double>& last) {
  for (std::size_t i = 0; i < columns.size(); ++i) requireMeasured(row[i], columns[i], name, line);
  if (last && !(row[0] > *last))
    throw FileError(name, line, row[0] == *last ? "time repeats" : "time runs backwards");
  last = row[0];
}

template <class Take>
void readTimed(CsvReader reader, const std::string& name, const std::vector<std::string>& columns,
               const Take& take) {
  std::optional<double> last;
  for (std::vector<double> row; reader.next(row);) {
    requireTimed(row, columns, name, reader.line(), last);
    take(row, reader.line());
  }
  if (!last) throw FileError(name, 0, "there is no sample in it");
}

ProbeSample sampleIn(const std::vector<double>& row) {
  return {row[0], row[1], {row[2], row[3], row[4], row[5]}};
}

CsvColumns columnsOf(const std::vector<RateSample>* rates) {
  return rates ? CsvColumns{kProbeColumns, kRateColumns} : CsvColumns{kProbeColumns};
}

// Returns true if a table has the columns of a gyroscope. Throws FileError if it lacks some of
// them.
template <class Table>
bool hasRates(const Table& table, const std::string& name, std::size_t line) {
  const auto axes = std::count_if(kRateColumns.begin(), kRateColumns.end(),
                                  [&](const auto& column) { return table.has(column); });
  if (axes != 0 && axes != 3)
    throw FileError(name, line,
                    "has " + std::to_string(axes) +
                        " of the gyroscope's columns wx, wy and wz; add the others or "
                        "leave all three out");
  return axes == 3;
}

RateSample rateIn(const std::vector<double>& row, const std::string& name, std::size_t line) {
  for (std::size_t i = 0; i < 3; ++i) requireMeasured(row[6 + i], kRateColumns[i], name, line);
  return {row[0], {row[6], row[7], row[8]}};
}

OnFile<ProbeSample> samplesIn(CsvReader reader, const std::string& name,
                              std::vector<std::string>* warnings, std::vector<RateSample>* rates) {
  OnFile<ProbeSample> file;
  warnOfColumns(reader, warnings);
  const bool gyroscope = rates && hasRates(reader, name, 0);
  readTimed(std::move(reader), name, kProbeColumns,
            [&](const std::vector<double>& row, std::size_t line) {
              file.values.push_back(sampleIn(row));
              if (gyroscope) rates->push_back(rateIn(row, name, line));
              file.lines.push_back(line);
            });
  return file;
}

std::vector<double> numbersOf(const ProbeSample& s) {
  return {s.t, s.force, s.acceleration[0], s.acceleration[1], s.acceleration[2], s.acceleration[3]};
}

} // namespace

OnFile<ProbeSample> readProbeStream(const std::filesystem::path& path,
                                    std::vector<std::string>* warnings,
                                    std::vector<RateSample>* rates) {
  return samplesIn(CsvReader(path, columnsOf(rates)), path.string(), warnings, rates);
}

OnFile<ProbeSample> parseProbeStream(const std::string& text, const std::string& name,
                                     std::vector<std::string>* warnings,
                                     std::vector<RateSample>* rates) {
  return samplesIn(CsvReader(sourceOfText(text), name, columnsOf(rates)), name, warnings, rates);
}

ProbeLines::ProbeLines(std::string name)
    : name_(std::move(name)), table_(name_, {kProbeColumns, kRateColumns}) {}

// Takes a line that is no row of numbers: the header, what is left out before it, or the header
// once more, as of a device that starts again. Throws FileError if that is another one.
bool ProbeLines::isHeader(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  const bool named = begin != std::string_view::npos &&
                     (std::isalpha(static_cast<unsigned char>(line[begin])) || line[begin] == '"');
  if (table_.hasHeader()) {
    if (!joined_ || !named) return false;
    table_.skipLine();
    if (line != header_)
      throw FileError(name_, table_.line(),
                      "is not the header '" + header_ +
                          "' of the numbers before it: send that one first after each start");
    return true;
  }
  if (joined_ && table_.line() == 0) {
    CsvParser first = table_;
    std::vector<double> none;
    try {
      first.take(line, none);
    } catch (const FileError&) {
    }
    if (first.hasHeader()) table_ = std::move(first);
    if (!table_.hasHeader()) table_.skipLine();
    header_ = line;
    return true;
  }
  if (joined_ && begin != std::string_view::npos && !named && line[begin] != '#' &&
      line[begin] != '%') {
    table_.assumeHeader(line);
    header_ = probeHeader(table_.has(kRateColumns[0]));
    header_.pop_back(); // its line end
    return false;
  }
  header_ = line;
  return false;
}

void ProbeLines::take(std::string_view bytes, std::vector<ProbeSample>& into,
                      std::vector<RateSample>* rates) {
  lines_.append(bytes);
  std::vector<double> row;
  for (std::string_view line; lines_.next(line);) {
    if (isHeader(line) || !table_.take(line, row)) continue;
    requireTimed(row, kProbeColumns, name_, table_.line(), last_);
    if (!gyroscope_) gyroscope_ = hasRates(table_, name_, table_.line());
    if (*gyroscope_) {
      const RateSample rate = rateIn(row, name_, table_.line());
      if (rates) rates->push_back(rate);
    }
    into.push_back(sampleIn(row));
  }
  if (lines_.rest() > 4096)
    throw FileError(name_, table_.line() + 1, "is no line of a probe's stream");
}

void ProbeLines::end() const {
  if (lines_.rest() > 0)
    throw FileError(name_, table_.line() + 1, "the stream ended within this line");
}

namespace {

std::vector<std::string> probeColumns(bool gyroscope) {
  std::vector<std::string> columns = kProbeColumns;
  if (gyroscope) columns.insert(columns.end(), kRateColumns.begin(), kRateColumns.end());
  return columns;
}

std::vector<double> numbersOf(const ProbeSample& sample, const RateSample* rate) {
  std::vector<double> numbers = numbersOf(sample);
  if (rate) numbers.insert(numbers.end(), {rate->rate.x(), rate->rate.y(), rate->rate.z()});
  return numbers;
}

} // namespace

std::string probeHeader(bool gyroscope) {
  return csvHeader(probeColumns(gyroscope));
}

std::string probeRow(const ProbeSample& sample, const RateSample* rate) {
  return csvRow(numbersOf(sample, rate));
}

void writeProbeStream(const std::filesystem::path& path, const std::vector<ProbeSample>& samples,
                      const std::vector<RateSample>& rates) {
  CsvWriter writer(path, probeColumns(!rates.empty()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    writer.add(numbersOf(samples[i], rates.empty() ? nullptr : &rates.at(i)));
  writer.commit();
}

namespace {

std::vector<PathSample> pathIn(CsvReader reader, const std::string& name,
                               std::vector<std::string>* warnings) {
  std::vector<PathSample> samples;
  warnOfColumns(reader, warnings);
  readTimed(
      std::move(reader), name, kPathColumns, [&](const std::vector<double>& row, std::size_t line) {
        const Eigen::Quaterniond turn(row[7], row[4], row[5], row[6]);
        if (!(std::abs(turn.norm() - 1) < kUnitQuaternion))
          throw FileError(name, line, "the quaternion has length " + formatNumber(turn.norm()));
        if (row[8] < 0) throw FileError(name, line, "sigma [m] is negative");
        PathSample sample;
        sample.t = row[0];
        sample.position = {row[1], row[2], row[3]};
        // A quaternion that this program wrote has length 1 up to rounding and keeps its bits.
        sample.orientation = std::abs(turn.norm() - 1) < kRounded ? turn : turn.normalized();
        sample.sigma = row[8];
        sample.force = row[9];
        samples.push_back(sample);
      });
  return samples;
}

} // namespace

std::vector<PathSample> readPath(const std::filesystem::path& path,
                                 std::vector<std::string>* warnings) {
  return pathIn(CsvReader(path, {kPathColumns}), path.string(), warnings);
}

std::vector<PathSample> parsePath(const std::string& text, const std::string& name,
                                  std::vector<std::string>* warnings) {
  return pathIn(CsvReader(sourceOfText(text), name, {kPathColumns}), name, warnings);
}

namespace {

std::vector<double> numbersOf(const PathSample& s) {
  const auto& q = s.orientation;
  return {s.t,   s.position.x(), s.position.y(), s.position.z(), q.x(),
          q.y(), q.z(),          q.w(),          s.sigma,        s.force};
}

std::vector<double> numbersOf(const ScanHeight& h) {
  return {h.t,
          h.point.arc_length,
          h.point.height,
          h.point.sigma,
          static_cast<double>(h.stretch),
          h.point.speed.value()};
}

template <class Rows>
void append(AtomicFile& file, const std::vector<std::string>& columns, const Rows& rows) {
  std::string text = csvHeader(columns);
  for (const auto& row : rows) {
    text += csvRow(numbersOf(row));
    if (text.size() < 1 << 16) continue;
    file.append(text);
    text.clear();
  }
  file.append(text);
}

} // namespace

std::string pathText(const std::vector<PathSample>& samples) {
  std::string text = csvHeader(kPathColumns);
  for (const PathSample& sample : samples) text += csvRow(numbersOf(sample));
  return text;
}

void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples) {
  AtomicFile file(path);
  append(file, kPathColumns, samples);
  file.commit();
}

void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
               const std::filesystem::path& heights_path, const std::vector<ScanHeight>& heights) {
  AtomicFile file(path), others(heights_path);
  append(file, kPathColumns, samples);
  append(others, kHeightColumns, heights);
  others.commit();
  file.commit();
}

void writeHeights(const std::filesystem::path& path, const std::vector<ScanHeight>& heights) {
  AtomicFile file(path);
  append(file, kHeightColumns, heights);
  file.commit();
}

} // namespace patina
