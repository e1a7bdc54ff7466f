// X3P, the container of ISO 25178-72:2017 (before: ISO 5436-2): a zip archive with main.xml, which
// describes the axes and holds the points or names the file that does. Its unit is the metre.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <expat.h>
#include <minizip/unzip.h>

#include "acquisition/profilometer/height_readers.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/sha256.h"

namespace patina {
namespace {

// One file out of a zip archive that is in memory.

// Memory that minizip reads in place of a file.
struct ArchiveBytes {
  std::string_view bytes;
  std::uint64_t offset = 0;
};

void* openBytes(void* archive, const void*, int) {
  return archive;
}
uLong readBytes(void*, void* stream, void* to, uLong size) {
  auto& archive = *static_cast<ArchiveBytes*>(stream);
  const std::size_t count = archive.offset < archive.bytes.size()
                                ? archive.bytes.copy(static_cast<char*>(to), size, archive.offset)
                                : 0;
  archive.offset += count;
  return count;
}
ZPOS64_T tellBytes(void*, void* stream) {
  return static_cast<ArchiveBytes*>(stream)->offset;
}
long seekBytes(void*, void* stream, ZPOS64_T offset, int origin) {
  auto& archive = *static_cast<ArchiveBytes*>(stream);
  const std::uint64_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? archive.offset
                             : origin == ZLIB_FILEFUNC_SEEK_END ? archive.bytes.size()
                                                                : 0;
  if (offset > archive.bytes.size() || from + offset > archive.bytes.size()) return -1;
  archive.offset = from + offset;
  return 0;
}
int closeBytes(void*, void*) {
  return 0;
}
int hasError(void*, void*) {
  return 0;
}

// Returns the bytes of `member`, whose name is compared without regard to case, or nullopt if the
// archive has none. Throws FileError(name): no archive, a member that is damaged, encrypted or
// larger than max_bytes; no more than these are ever unpacked.
std::optional<std::string> zipMember(std::string_view archive, const std::string& name,
                                     const std::string& member, std::size_t max_bytes) {
  ArchiveBytes source{archive};
  zlib_filefunc64_def calls{};
  calls.zopen64_file = openBytes;
  calls.zread_file = readBytes;
  calls.ztell64_file = tellBytes;
  calls.zseek64_file = seekBytes;
  calls.zclose_file = closeBytes;
  calls.zerror_file = hasError;
  calls.opaque = &source;
  const std::unique_ptr<void, int (*)(unzFile)> zip(unzOpen2_64("", &calls), unzClose);
  if (!zip) throw FileError(name, 0, "is no whole zip archive: copy or export it again");
  constexpr int kAnyCase = 2;
  if (unzLocateFile(zip.get(), member.c_str(), kAnyCase) != UNZ_OK) return std::nullopt;
  const auto fail = [&](const std::string& cause) { throw FileError(name, 0, member + cause); };
  const std::string damaged = " in the archive is damaged: copy or export the file again";
  unz_file_info64 info{};
  if (unzGetCurrentFileInfo64(zip.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    fail(damaged);
  const std::string too_large = " is larger than the " +
                                formatBytes(static_cast<double>(max_bytes)) +
                                " that it may have here";
  if (info.uncompressed_size > max_bytes) fail(too_large);
  if ((info.flag & 1) != 0) fail(" is encrypted: export it without a password");
  if (unzOpenCurrentFile(zip.get()) != UNZ_OK) fail(damaged);
  std::string bytes;
  std::array<char, 1 << 16> part{};
  int count = 0;
  while ((count = unzReadCurrentFile(zip.get(), part.data(), part.size())) > 0) {
    bytes.append(part.data(), static_cast<std::size_t>(count));
    if (bytes.size() > max_bytes) fail(too_large);
  }
  // The checksum of the archive is compared here.
  if (unzCloseCurrentFile(zip.get()) != UNZ_OK || count < 0) fail(damaged);
  return bytes;
}

constexpr std::size_t kMaxXml = std::size_t{1} << 26, kMaxText = 256, kMaxDepth = 16,
                      kMaxName = 100, kMaxElements = 256;

constexpr std::string_view kBlank = " \t\r\n";

// main.xml as its reader leaves it: texts by their path below the root, "Record1/Axes/CX/AxisType".
struct X3pText {
  std::map<std::string, std::string> texts;
  // Numbers of each Datum in the order of the axes; NaN where the element is empty.
  std::vector<std::array<double, 3>> points;
  std::size_t numbers = 0; // numbers per Datum
  std::string root, problem;
};

struct X3pReading {
  X3pText result;
  std::vector<std::string> path;
  std::string text;
  XML_Parser parser = nullptr;

  void refuse(const std::string& cause) {
    if (result.problem.empty()) result.problem = cause;
    XML_StopParser(parser, XML_FALSE);
  }
};

void takeDatum(X3pReading& reading) {
  std::array<double, 3> point{kNotMeasured, kNotMeasured, kNotMeasured};
  std::string_view rest = reading.text;
  std::size_t numbers = 0;
  while (rest.find_first_not_of(kBlank) != std::string_view::npos) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    WordReader words(rest.substr(0, end));
    std::string_view word;
    const auto value = words.next(word) ? parseNumber(word) : std::nullopt;
    if (!value || numbers == point.size())
      return reading.refuse("a Datum is not one to three numbers between semicolons");
    point[numbers++] = *value;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  X3pText& result = reading.result;
  if (numbers > 0 && result.numbers > 0 && numbers != result.numbers)
    return reading.refuse("one Datum has more numbers than another");
  if (numbers > 0) result.numbers = numbers;
  result.points.push_back(point);
}

void beginElement(void* user, const XML_Char* name, const XML_Char**) {
  X3pReading& reading = *static_cast<X3pReading*>(user);
  const std::string_view whole(name); // may have the prefix of a namespace
  const std::string local(whole.substr(whole.find(':') + 1));
  if (reading.path.empty()) reading.result.root = local;
  if (reading.path.size() >= kMaxDepth || local.size() > kMaxName)
    return reading.refuse("its elements are nested too deep or have too long names");
  reading.path.push_back(local);
  reading.text.clear();
}

void addText(void* user, const XML_Char* text, int length) {
  X3pReading& reading = *static_cast<X3pReading*>(user);
  if (reading.text.size() < kMaxText) reading.text.append(text, static_cast<std::size_t>(length));
}

void endElement(void* user, const XML_Char*) {
  X3pReading& reading = *static_cast<X3pReading*>(user);
  if (!reading.result.problem.empty()) return; // expat ends an empty element that was refused
  if (reading.path.back() == "Datum") {
    takeDatum(reading);
  } else if (const std::size_t first = reading.text.find_first_not_of(kBlank);
             first != std::string::npos && reading.result.texts.size() < kMaxElements) {
    std::string path;
    for (std::size_t i = 1; i < reading.path.size(); ++i)
      path += (i > 1 ? "/" : "") + reading.path[i];
    const std::size_t end = reading.text.find_last_not_of(kBlank) + 1;
    reading.result.texts.try_emplace(path, reading.text, first, end - first);
  }
  reading.path.pop_back();
  reading.text.clear();
}

void refuseDoctype(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  static_cast<X3pReading*>(user)->refuse("it has a document type, which X3P has not");
}

X3pText readMainXml(const std::string& xml, const std::string& name) {
  X3pReading reading;
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  reading.parser = parser.get();
  XML_SetUserData(parser.get(), &reading);
  XML_SetElementHandler(parser.get(), beginElement, endElement);
  XML_SetCharacterDataHandler(parser.get(), addText);
  XML_SetStartDoctypeDeclHandler(parser.get(), refuseDoctype);
  if (XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), XML_TRUE) !=
      XML_STATUS_OK) {
    if (reading.result.problem.empty())
      reading.result.problem = XML_ErrorString(XML_GetErrorCode(parser.get()));
    throw FileError(name, 0,
                    "main.xml, line " + std::to_string(XML_GetCurrentLineNumber(parser.get())) +
                        ": " + reading.result.problem);
  }
  if (reading.result.root != "ISO5436_2")
    throw FileError(name, 0, "main.xml is not that of an X3P file");
  return std::move(reading.result);
}

struct X3pNumber {
  std::size_t bytes = 0;
  double (*read)(std::string_view, std::size_t) = nullptr;
  bool is_whole = false;
};

struct X3pAxis {
  bool incremental = false;
  X3pNumber number; // number format of an absolute axis
  double increment = 1, offset = 0;
};

// Text of main.xml by element path.
class X3pDescription {
 public:
  X3pDescription(const X3pText& xml, const std::string& name) : xml_(xml), name_(name) {}
  std::string text(const std::string& path) const {
    const auto found = xml_.texts.find(path);
    return found == xml_.texts.end() ? "" : found->second;
  }
  [[noreturn]] void refuse(const std::string& cause) const {
    throw FileError(name_, 0, "main.xml: " + cause);
  }
  double number(const std::string& path, std::optional<double> absent = {}) const {
    const std::string value = text(path);
    if (value.empty() && absent) return *absent;
    const std::optional<double> number = parseNumber(value);
    if (!number || !std::isfinite(*number)) refuse(path + " is no number");
    return *number;
  }
  std::uint64_t count(const std::string& path) const {
    const double value = number(path);
    if (!(value >= 1) || value != std::floor(value) || !(value < 1e15))
      refuse(path + " is " + text(path) + ", no whole number above 0");
    return static_cast<std::uint64_t>(value);
  }
  X3pAxis axis(const std::string& axis_name) const {
    const std::string path = "Record1/Axes/" + axis_name;
    const std::string type = text(path + "/AxisType"), stored = text(path + "/DataType");
    X3pAxis axis;
    if (type != "I" && type != "A") refuse(path + "/AxisType is neither I nor A");
    axis.incremental = type == "I";
    if (stored == "I") axis.number = {2, numberAt<std::int16_t>, true};
    if (stored == "L") axis.number = {4, numberAt<std::int32_t>, true};
    if (stored == "F") axis.number = {4, numberAt<float>, false};
    if (stored == "D") axis.number = {8, numberAt<double>, false};
    if (!axis.incremental && axis.number.bytes == 0)
      refuse(path + "/DataType is none of I, L, F and D");
    const bool is_needed = axis.incremental || axis.number.is_whole;
    axis.increment = is_needed ? number(path + "/Increment") : number(path + "/Increment", 1);
    axis.offset = number(path + "/Offset", 0);
    if (axis.increment == 0) refuse(path + "/Increment is 0");
    return axis;
  }
  const std::string& name() const { return name_; }

 private:
  const X3pText& xml_;
  const std::string& name_;
};

std::string lowerHex(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// Reads a file of the archive that main.xml names, PointData or ValidPoints, and compares its
// checksum.
std::string linkedBytes(std::string_view archive, const X3pDescription& xml,
                        const std::string& what, std::size_t max_bytes,
                        std::vector<std::string>& warnings) {
  const std::string element = "Record3/DataLink/" + what + "Link";
  std::string link = xml.text(element);
  std::replace(link.begin(), link.end(), '\\', '/');
  if (link.starts_with("./")) link.erase(0, 2);
  if (link.empty() || link.front() == '/' || link.find("..") != std::string::npos ||
      link.find(':') != std::string::npos)
    xml.refuse(element + " is no path within the archive");
  const std::optional<std::string> bytes = zipMember(archive, xml.name(), link, max_bytes);
  if (!bytes) throw FileError(xml.name(), 0, "has no " + link + ", which main.xml names");
  const std::string checksum = lowerHex(xml.text("Record3/DataLink/MD5Checksum" + what));
  if (checksum.empty())
    warnings.push_back(link + " has no checksum and was not checked");
  else if (checksum != md5(*bytes))
    throw FileError(xml.name(), 0,
                    link + " does not have the checksum that main.xml says: export "
                           "or copy the file again");
  return *bytes;
}

void checkMainXml(std::string_view archive, const std::string& xml, const X3pDescription& described,
                  std::vector<std::string>& warnings) {
  const std::string named = described.text("Record4/ChecksumFile");
  const std::string& name = described.name();
  const auto found = zipMember(archive, name, named.empty() ? "md5checksum.hex" : named, 4096);
  if (!found)
    warnings.push_back("main.xml has no checksum and was not checked");
  else if (lowerHex(found->substr(0, 32)) != md5(xml))
    throw FileError(name, 0,
                    "main.xml does not have the checksum of md5checksum.hex: the file was "
                    "changed or is damaged, export or copy it again");
}

// The numbers of the absolute axes of each point, out of a binary file.
std::vector<std::array<double, 3>> linkedPoints(std::string_view archive, const X3pDescription& xml,
                                                const std::vector<X3pAxis>& stored,
                                                std::size_t count,
                                                std::vector<std::string>& warnings) {
  std::size_t size = 0;
  for (const X3pAxis& axis : stored) size += axis.number.bytes;
  const std::string bytes = linkedBytes(archive, xml, "PointData", count * size, warnings);
  if (bytes.size() != count * size)
    throw FileError(xml.name(), 0,
                    "has " + formatCount(bytes.size()) + " bytes of points where " +
                        formatCount(count) + " of them have " + formatCount(count * size));
  std::vector<std::array<double, 3>> points(count);
  std::size_t offset = 0;
  for (std::array<double, 3>& point : points)
    for (std::size_t k = 0; k < stored.size(); ++k) {
      point[k] = stored[k].number.read(bytes, offset);
      offset += stored[k].number.bytes;
    }
  if (xml.text("Record3/DataLink/ValidPointsLink").empty()) return points;
  // One bit a point, the lowest of a byte first; some programs write a byte a point.
  const std::string valid = linkedBytes(archive, xml, "ValidPoints", count, warnings);
  const bool are_bits = valid.size() == (count + 7) / 8;
  if (!are_bits && valid.size() != count)
    throw FileError(xml.name(), 0,
                    "says of " + formatCount(valid.size() * 8) +
                        " points whether they are valid, and has " + formatCount(count));
  for (std::size_t i = 0; i < count; ++i)
    if (are_bits ? (valid[i / 8] >> (i % 8) & 1) == 0 : valid[i] == 0)
      points[i][stored.size() - 1] = kNotMeasured;
  return points;
}

} // namespace

RawHeights readX3p(std::string_view bytes, const std::string& name) {
  const std::optional<std::string> text = zipMember(bytes, name, "main.xml", kMaxXml);
  if (!text) throw FileError(name, 0, "is a zip archive without main.xml, no X3P file");
  X3pText xml = readMainXml(*text, name);
  const X3pDescription described(xml, name);
  RawHeights raw;
  checkMainXml(bytes, *text, described, raw.warnings);

  const X3pAxis axes[] = {described.axis("CX"), described.axis("CY"), described.axis("CZ")};
  if (axes[2].incremental) described.refuse("Record1/Axes/CZ/AxisType is I; heights are absolute");
  const std::string feature = described.text("Record1/FeatureType");
  if (feature != "PRF" && feature != "SUR" && feature != "PCL")
    described.refuse("Record1/FeatureType is none of PRF, SUR and PCL");
  const bool is_matrix = described.text("Record3/ListDimension").empty();
  if (is_matrix) {
    const std::string size = "Record3/MatrixDimension/Size";
    raw.columns = described.count(size + "X");
    raw.rows = described.count(size + "Y");
    if (described.count(size + "Z") != 1) described.refuse("it has several layers; export one");
    if (feature == "PRF" && raw.rows != 1) described.refuse("a profile has several rows");
  } else {
    raw.columns = described.count("Record3/ListDimension");
    if (feature != "PRF" && (axes[0].incremental || axes[1].incremental))
      described.refuse("a list of points has no absolute x and y");
  }
  const std::size_t count = countOfPoints(raw.columns, raw.rows, name);

  std::vector<X3pAxis> stored;
  std::array<std::size_t, 3> place{}; // position of an axis among the stored ones
  for (std::size_t k = 0; k < 3; ++k) {
    place[k] = stored.size();
    if (!axes[k].incremental) stored.push_back(axes[k]);
  }
  if (xml.points.empty()) {
    xml.points = linkedPoints(bytes, described, stored, count, raw.warnings);
  } else {
    if (xml.numbers > 0 && xml.numbers != stored.size())
      described.refuse("a Datum has " + formatCount(xml.numbers) + " numbers, the axes need " +
                       formatCount(stored.size()));
    if (xml.points.size() != count)
      described.refuse("it has " + formatCount(xml.points.size()) + " points and says " +
                       formatCount(count));
  }

  raw.step_x = axes[0].increment;
  raw.step_y = axes[1].increment;
  const bool is_area = raw.rows > 1 || feature == "PCL" || (!is_matrix && feature == "SUR");
  raw.is_list = is_area && (!axes[0].incremental || !axes[1].incremental);
  const bool has_x = raw.is_list || !axes[0].incremental;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<std::size_t, 3> index{i % raw.columns, i / raw.columns, 0};
    const auto coordinate = [&](std::size_t k) {
      const double value =
          axes[k].incremental ? static_cast<double>(index[k]) : xml.points[i][place[k]];
      return axes[k].offset + value * axes[k].increment;
    };
    if (has_x) raw.x.push_back(coordinate(0));
    if (raw.is_list) raw.y.push_back(coordinate(1));
    raw.z.push_back(coordinate(2));
  }
  return raw;
}

} // namespace patina
