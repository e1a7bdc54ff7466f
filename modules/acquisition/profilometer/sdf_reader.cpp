// Surface data files: ISO 25178-71 (ISO-1.0 and ISO-2.0), and BCR-1.0, of which they came.
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "acquisition/profilometer/height_readers.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kMagic = 8; // "aISO-1.0"

// The header's DataType tells how a number is stored; the lowest value of a signed type and of a
// float means that the point was not measured.
struct SdfNumber {
  std::size_t bytes;
  double (*read)(std::string_view, std::size_t);
  double not_measured;
};

template <class Number> SdfNumber storedAs() {
  return {sizeof(Number), numberAt<Number>,
          std::is_signed_v<Number> ? static_cast<double>(std::numeric_limits<Number>::lowest())
                                   : kNotMeasured};
}

const SdfNumber* sdfNumber(double data_type) {
  static const SdfNumber kNumbers[] = {storedAs<std::uint8_t>(),  storedAs<std::uint16_t>(),
                                       storedAs<std::uint32_t>(), storedAs<float>(),
                                       storedAs<std::int8_t>(),   storedAs<std::int16_t>(),
                                       storedAs<std::int32_t>(),  storedAs<double>()};
  for (std::size_t i = 0; i < std::size(kNumbers); ++i)
    if (data_type == static_cast<double>(i)) return &kNumbers[i];
  return nullptr;
}

struct SdfHeader {
  double points = 0, profiles = 0, x_scale = 0, y_scale = 0, z_scale = 0;
  double compression = 0, data_type = 0, check_type = 0;
};

// The frame of a file whose header is right: steps, counts and no heights yet.
RawHeights checkedFrame(const SdfHeader& header, const std::string& name) {
  if (header.compression != 0 || header.check_type != 0)
    throw FileError(name, 0,
                    "is compressed or has a checksum (Compression " +
                        formatNumber(header.compression) + ", CheckType " +
                        formatNumber(header.check_type) + "): export it with 0 and 0");
  if (sdfNumber(header.data_type) == nullptr)
    throw FileError(name, 0,
                    "DataType is " + formatNumber(header.data_type) + "; 0 to 7 are known");
  for (const double count : {header.points, header.profiles})
    if (!(count >= 1) || !(count < 4294967296.0) || count != std::floor(count))
      throw FileError(name, 0,
                      "NumPoints or NumProfiles is " + formatNumber(count) +
                          "; they are whole numbers above 0");
  RawHeights raw;
  raw.columns = static_cast<std::uint64_t>(header.points);
  raw.rows = static_cast<std::uint64_t>(header.profiles);
  countOfPoints(raw.columns, raw.rows, name);
  requireStep(header.x_scale, "Xscale", name);
  if (raw.rows > 1) requireStep(header.y_scale, "Yscale", name);
  if (!(std::abs(header.z_scale) > 0) || !std::isfinite(header.z_scale))
    throw FileError(name, 0,
                    "Zscale is " + formatNumber(header.z_scale) +
                        "; it is the metres of one unit of height");
  raw.step_x = header.x_scale;
  raw.step_y = header.y_scale;
  return raw;
}

[[noreturn]] void refuseCountOfValues(const RawHeights& raw, std::size_t found,
                                      const std::string& name) {
  throw FileError(name, 0,
                  "ends after " + formatCount(found) + " of " +
                      formatCount(raw.columns * raw.rows) + " points: copy or export it again");
}

RawHeights readBinarySdf(std::string_view bytes, const std::string& name) {
  // Magic, maker (10 bytes), two dates (12 each), then the counts: of 2 bytes, since 2.0 of 4.
  const bool wide = bytes[5] == '2';
  const std::size_t counts = kMagic + 34, scales = counts + (wide ? 8 : 4), types = scales + 32,
                    data = types + 3;
  if (bytes.size() < data) throw FileError(name, 0, "ends within its header: copy it again");
  SdfHeader header;
  header.points =
      wide ? numberAt<std::uint32_t>(bytes, counts) : numberAt<std::uint16_t>(bytes, counts);
  header.profiles = wide ? numberAt<std::uint32_t>(bytes, counts + 4)
                         : numberAt<std::uint16_t>(bytes, counts + 2);
  header.x_scale = numberAt<double>(bytes, scales);
  header.y_scale = numberAt<double>(bytes, scales + 8);
  header.z_scale = numberAt<double>(bytes, scales + 16);
  header.compression = numberAt<std::uint8_t>(bytes, types);
  header.data_type = numberAt<std::uint8_t>(bytes, types + 1);
  header.check_type = numberAt<std::uint8_t>(bytes, types + 2);
  RawHeights raw = checkedFrame(header, name);
  const SdfNumber& number = *sdfNumber(header.data_type);
  const std::size_t count = raw.columns * raw.rows;
  if ((bytes.size() - data) / number.bytes < count)
    refuseCountOfValues(raw, (bytes.size() - data) / number.bytes, name);
  raw.z.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double value = number.read(bytes, data + i * number.bytes);
    raw.z.push_back(value == number.not_measured ? kNotMeasured : value * header.z_scale);
  }
  return raw;
}

RawHeights readTextSdf(std::string_view bytes, const std::string& name) {
  SdfHeader header;
  std::map<std::string_view, double*> wanted{
      {"NumPoints", &header.points},   {"NumProfiles", &header.profiles},
      {"Xscale", &header.x_scale},     {"Yscale", &header.y_scale},
      {"Zscale", &header.z_scale},     {"Compression", &header.compression},
      {"DataType", &header.data_type}, {"CheckType", &header.check_type}};
  std::size_t line_number = 1, begin = std::min(bytes.find('\n'), bytes.size() - 1) + 1;
  for (;;) {
    if (begin >= bytes.size())
      throw FileError(name, 0, "ends within its header, which a line with * closes");
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string_view line = bytes.substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    const std::size_t equals = std::min(line.find('='), line.size());
    std::string_view key, value;
    if (!WordReader(line.substr(0, equals)).next(key)) continue;
    if (key.front() == '*') break;
    const auto found = wanted.find(key);
    if (found == wanted.end()) continue;
    const bool has_value = WordReader(line.substr(std::min(equals + 1, line.size()))).next(value);
    const std::optional<double> number = has_value ? parseNumber(value) : std::nullopt;
    if (!number) throw FileError(name, line_number, std::string(key) + " is no number");
    *found->second = *number;
    wanted.erase(found);
  }
  if (!wanted.empty())
    throw FileError(name, line_number, "the header has no " + std::string(wanted.begin()->first));
  RawHeights raw = checkedFrame(header, name);
  const std::size_t count = raw.columns * raw.rows;
  // A value takes two bytes at least, so that a file's length bounds what is reserved.
  if (begin > bytes.size() || (bytes.size() - begin) / 2 + 1 < count)
    refuseCountOfValues(raw, (bytes.size() - std::min(begin, bytes.size())) / 2, name);
  raw.z.reserve(count);
  WordReader words(bytes.substr(begin), line_number + 1);
  std::string_view word;
  while (raw.z.size() < count) {
    if (!words.next(word) || word.front() == '*') refuseCountOfValues(raw, raw.z.size(), name);
    if (word == "BAD") {
      raw.z.push_back(kNotMeasured);
      continue;
    }
    const std::optional<double> value = parseNumber(word);
    if (!value)
      throw FileError(name, words.line(),
                      "has a height that is no number; BAD is one that was "
                      "not measured");
    raw.z.push_back(*value * header.z_scale);
  }
  if (words.next(word) && word.front() != '*')
    throw FileError(name, words.line(),
                    "has more heights than its header's " + formatCount(raw.columns) + " x " +
                        formatCount(raw.rows));
  return raw;
}

} // namespace

RawHeights readSdf(std::string_view bytes, const std::string& name) {
  const std::string_view version = bytes.substr(1, kMagic - 1);
  if (version != "ISO-1.0" && version != "ISO-2.0" && version != "BCR-1.0")
    throw FileError(name, 0,
                    "is an SDF file of a version that is not known; ISO-1.0, ISO-2.0 and "
                    "BCR-1.0 are read");
  return bytes.front() == 'b' ? readBinarySdf(bytes, name) : readTextSdf(bytes, name);
}

} // namespace patina
